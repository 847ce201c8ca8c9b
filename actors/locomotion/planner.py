"""From a distance to steps: how many, and how long each of them is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LONGEST_STEP: Final = 0.65
"""Longest step that is planned, leg lengths: further apart, poses on curves leave their limits."""
PREFERRED_STEP: Final = 0.55
"""Length of a step amid a long way, leg lengths."""
RAMP: Final = (0.60, 0.85)
"""First and second step, and last and last but one, as shares of those between."""
FURTHEST: Final = 1e5
"""Longest way that is planned at once, leg lengths."""

_SOLVABLE: Final = 0.749
"""No gait below a relative velocity of 0.5 takes longer steps, leg lengths."""


def plan_steps(
    distance: float,
    *,
    longest: float = LONGEST_STEP,
    preferred: float = PREFERRED_STEP,
    ramp: Sequence[float] = RAMP,
    jitter: float = 0.0,
    random: np.random.Generator | None = None,
) -> Floats:
    """Lengths of the steps that lead exactly so far, from standing to standing.

    Parameters
    ----------
    distance : leg lengths, in [0, FURTHEST]
    longest, preferred : leg lengths
        No step is longer than `longest`; as many are taken as bring the longest of them closest
        to `preferred`.
    ramp : shares of the full length, each in (0, 1]
        Of the first steps, and from the end backwards of the last.
    jitter : share of a step's length, in [0, 0.5]
        Steps differ by so much at random, and still sum to the distance.
    random : source of the jitter

    Returns
    -------
    float64 (N + 1,), leg lengths
        The last is 0: the foot behind closes up. Empty if there is nothing to walk.

    Raises
    ------
    ValueError
        A measure is out of its range, or there is jitter without a source of it.

    Notes
    -----
    Jing et al. 2015 plan a known distance as steps of their choice; number and ramps are ours.
    """
    _check(distance, longest, preferred, ramp, jitter)
    if distance == 0.0:
        return np.zeros(0)
    lengths = _ramped(distance, longest, preferred, ramp)
    if jitter > 0.0:
        if random is None:
            raise ValueError("jitter needs a random generator: pass random=")
        lengths = _jittered(lengths, longest, jitter, random)
    return np.append(lengths, 0.0)


def _ramped(distance: float, longest: float, preferred: float, ramp: Sequence[float]) -> Floats:
    """As many steps as bring the longest of them closest to the preferred length."""
    # Without ramps this many would be preferred or longer, and more steps are shorter ones.
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
    """So many steps in the proportions of the ramps that sum to the distance."""
    shares = np.ones(count)
    for k, share in enumerate(ramp[: (count + 1) // 2]):
        shares[[k, -1 - k]] = share
    lengths: Floats = distance * shares / shares.sum()
    return lengths


def _jittered(
    lengths: Floats, longest: float, jitter: float, random: np.random.Generator
) -> Floats:
    """Steps that differ at random, none too long or backwards; their sum stays."""
    change = jitter * lengths * random.uniform(-1.0, 1.0, len(lengths))
    change -= lengths * (change.sum() / lengths.sum())
    room = np.divide(longest - lengths, change, out=np.ones_like(change), where=change > 0.0)
    return lengths + min(1.0, float(room.min())) * change


def _check(
    distance: float, longest: float, preferred: float, ramp: Sequence[float], jitter: float
) -> None:
    """Raise ValueError naming the first measure that is out of its range."""
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
        raise ValueError(f"shares of ramp must lie between 0 and 1, got {tuple(ramp)}")
    if not 0.0 <= jitter <= 0.5:
        raise ValueError(f"jitter must lie between 0 and 0.5, got {jitter}")
