"""Walks that are filmed once for all tests."""

from functools import cache

from esplanade.footage.film import Film, film_walk
from esplanade.footage.walks import walks

FRAMES_A_SECOND = 20.0


@cache
def filmed(name: str, seed: int = 0) -> Film:
    return film_walk(walks()[name], FRAMES_A_SECOND, seed)
