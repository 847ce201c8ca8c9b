"""Recorded paths of people, tick by tick, as one array."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.pedestrians.compiled.records import Paths

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
WALL_NUMBERS: Final = 4


def joined_paths(trajectories: Sequence[ArrayLike], first_ticks: Sequence[int]) -> Paths:
    """Put the trajectories of N people one after the other.

    Parameters
    ----------
    trajectories : each (n, 2), metres
        Where a person is at every tick; n is 0 for somebody who was never there at one.
    first_ticks : (N,)
        The tick of each person's first place.

    Raises
    ------
    ValueError
        A shape is wrong, a number is not finite, or the lengths differ.
    """
    if len(trajectories) != len(first_ticks):
        raise ValueError(f"{len(trajectories)} trajectories, but {len(first_ticks)} first ticks")
    parts = [np.asarray(t, dtype=np.float64).reshape(-1, 2) for t in trajectories]
    places = np.concatenate([np.zeros((0, 2)), *parts])
    if not np.isfinite(places).all():
        raise ValueError("a place is not finite")
    begins = np.concatenate([[0], np.cumsum([len(part) for part in parts], dtype=np.int64)])
    return Paths(places, begins.astype(np.int64), np.array(first_ticks, dtype=np.int64))


def checked_walls(walls: ArrayLike) -> Floats:
    """Walls from (x1, y1) to (x2, y2) as float64 (M, 4), metres; given as (M, 2, 2) or (M, 4)."""
    found = np.asarray(walls, dtype=np.float64)
    if found.size % WALL_NUMBERS or not np.isfinite(found).all():
        raise ValueError("walls are rows of two ends, each x and y in metres")
    return np.ascontiguousarray(found.reshape(-1, WALL_NUMBERS))


def walls_passed(paths: Paths, walls: Floats) -> Bools:
    """A table (N, M) of whether each of N paths leads through each of M walls.

    Walls of recordings are drawn by hand, so some people walk through one. These walls cannot
    hold up these people.
    """
    people = len(paths.first)
    passed = np.zeros((people, len(walls)), dtype=np.bool_)
    if not len(walls):
        return passed
    ends_a, ends_b = walls[None, :, :2], walls[None, :, 2:]
    for person in range(people):
        places = paths.places[paths.begins[person] : paths.begins[person + 1], None]
        if len(places) < 2:
            continue
        here, there = places[:-1], places[1:]
        steps_part = _side(ends_a, ends_b, here) * _side(ends_a, ends_b, there) <= 0.0
        walls_part = _side(here, there, ends_a) * _side(here, there, ends_b) <= 0.0
        moves = (here != there).any(axis=2)
        passed[person] = (steps_part & walls_part & moves).any(axis=0)
    return passed


def _side(a: Floats, b: Floats, c: Floats) -> Floats:
    """Positive where c is to the left of the line from a to b."""
    along, to = b - a, c - a
    return np.asarray(along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0])
