"""Plans the steps of a known distance: how many there are, and how long each of them is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import Final

import numpy as np

from esplanade.planning.compiled.arrays import Floats

LONGEST_STEP: Final = 0.65
"""Longest step that is planned, leg lengths: beyond it, poses in bends leave their limits."""
PREFERRED_STEP: Final = 0.55
"""Length of a step in the middle of a long path, leg lengths."""
RAMP: Final = (0.60, 0.85)
"""Lengths of the first and second step, and of the last and last but one, as shares of those
between."""
FURTHEST: Final = 1e5
"""Longest distance that is planned at once, leg lengths."""

_SOLVABLE: Final = 0.749
"""Longest step of any gait up to a relative velocity of 0.5, leg lengths."""


def plan_steps(
    distance: float,
    *,
    longest: float = LONGEST_STEP,
    preferred: float = PREFERRED_STEP,
    ramp: Sequence[float] = RAMP,
    jitter: float = 0.0,
    random: np.random.Generator | None = None,
) -> Floats:
    """Plan steps that lead exactly a distance, from standing to standing.

    Parameters
    ----------
    distance : leg lengths, in [0, FURTHEST]
    longest, preferred : leg lengths
        No step is longer than `longest`. There are as many steps as bring the longest of them
        closest to `preferred`.
    ramp : shares of the full length, each in (0, 1]
        Lengths of the first steps, and from the end backwards of the last ones.
    jitter : share of a step's length, in [0, 0.5]
        Steps differ by up to this at random, and still sum to the distance.
    random : the generator that the jitter is drawn from

    Returns
    -------
    float64 (N + 1,), leg lengths
        Lengths of the steps. The last one is 0: the foot behind is drawn up to the other. The
        result is empty if the distance is 0.

    Raises
    ------
    ValueError
        A measure is out of its range, or there is jitter but no generator.

    Notes
    -----
    Jing et al. 2015 plan a known distance as steps of given lengths. How many there are, and the
    ramps at both ends, are our choice.
    """
    _check(distance, longest, preferred, ramp, jitter)
    if distance == 0.0:
        return np.zeros(0)
    lengths = _ramped(distance, longest, preferred, ramp)
    if jitter > 0.0:
        if random is None:
            raise ValueError("jitter needs a generator of random numbers: pass random=")
        lengths = _jittered(lengths, longest, jitter, random)
    return np.append(lengths, 0.0)


def _ramped(distance: float, longest: float, preferred: float, ramp: Sequence[float]) -> Floats:
    """Lengths of as many steps as bring the longest of them closest to the preferred length."""
    # Without ramps this many steps have the preferred length or more; more steps are shorter.
    count = max(1, math.floor(distance / preferred))
    lengths = _shared_out(distance, count, ramp)
    while True:
        count += 1
        shorter = _shared_out(distance, count, ramp)
        off, next_off = abs(lengths.max() - preferred), abs(shorter.max() - preferred)
        if lengths.max() <= longest and off <= next_off:
            return lengths
        lengths = shorter


def _shared_out(distance: float, count: int, ramp: Sequence[float]) -> Floats:
    """Lengths of `count` steps that sum to the distance, in the proportions of the ramps."""
    shares = np.ones(count)
    for k, share in enumerate(ramp[: (count + 1) // 2]):
        shares[[k, -1 - k]] = share
    lengths: Floats = distance * shares / shares.sum()
    return lengths


def _jittered(
    lengths: Floats, longest: float, jitter: float, random: np.random.Generator
) -> Floats:
    """Lengths changed at random: none gets too long or negative, and their sum stays."""
    change = jitter * lengths * random.uniform(-1.0, 1.0, len(lengths))
    change -= lengths * (change.sum() / lengths.sum())
    room = np.divide(longest - lengths, change, out=np.ones_like(change), where=change > 0.0)
    return lengths + min(1.0, float(room.min())) * change


def _check(
    distance: float, longest: float, preferred: float, ramp: Sequence[float], jitter: float
) -> None:
    """Raise a ValueError that names the first measure out of its range."""
    if not (isinstance(distance, Real) and 0.0 <= distance <= FURTHEST):
        raise ValueError(
            f"distance must lie between 0 and {FURTHEST:g} leg lengths, got {distance}"
        )
    if not 0.0 < longest <= _SOLVABLE:
        raise ValueError(f"longest must lie between 0 and {_SOLVABLE} leg lengths, got {longest}")
    if not 0.01 <= preferred <= longest:
        raise ValueError(
            f"preferred must lie between 0.01 and longest ({longest}), got {preferred}"
        )
    if any(not 0.0 < share <= 1.0 for share in ramp):
        raise ValueError(f"every share of ramp must lie between 0 and 1, got {tuple(ramp)}")
    if not 0.0 <= jitter <= 0.5:
        raise ValueError(f"jitter must lie between 0 and 0.5, got {jitter}")
