"""Walks recorded once for all tests."""

from functools import cache

from esplanade.footage.recording import Recording, record
from esplanade.footage.walks import walks

FRAMES_A_SECOND = 20.0


@cache
def filmed(name: str, seed: int = 0) -> Recording:
    return record(walks()[name], FRAMES_A_SECOND, seed)
