"""The places of bodies on their courses, worked out one body after the other."""

from __future__ import annotations

from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined, kernel

AHEAD_S = 0.2
AHEAD = 7


@inlined
def _along(ahead: Floats, seconds: float, axis: int) -> float:
    """A coordinate of a course (AHEAD, 3) after a time, linear between its places."""
    place = min(max(seconds / AHEAD_S, 0.0), AHEAD - 1.0)
    k = min(int(place), AHEAD - 2)
    return float(ahead[k, axis] + (place - k) * (ahead[k + 1, axis] - ahead[k, axis]))


@kernel
def fill_places(ahead: Floats, seconds: Floats, out: Floats) -> None:
    """Write the places (N, 3) on courses (N, AHEAD, 3) after times (N,)."""
    for i in range(len(seconds)):
        for axis in range(3):
            out[i, axis] = _along(ahead[i], seconds[i], axis)


@kernel
def fill_velocities(ahead: Floats, seconds: Floats, out: Floats) -> None:
    """Write the velocities (N, 2) on courses about times (N,), taken over AHEAD_S at most."""
    half = 0.5 * AHEAD_S
    for i in range(len(seconds)):
        before = min(half, max(seconds[i], 0.0))
        for axis in range(2):
            moved = _along(ahead[i], seconds[i] + half, axis)
            moved -= _along(ahead[i], seconds[i] - before, axis)
            out[i, axis] = moved / (half + before)


@kernel
def follow_plans(
    planned: Floats, slice_s: float, now_s: float, places: Floats, out: Floats
) -> None:
    """Write courses (N, AHEAD, 3) of bodies at `places` (N, 3) whose plans (N, K, 3) are older.

    The plans have a place every `slice_s` seconds and began `now_s` seconds ago. A body that is
    not where its plan has it gets back to the plan within a second.
    """
    last = planned.shape[1] - 1
    for k in range(AHEAD):
        at = min((now_s + k * AHEAD_S) / slice_s, float(last))
        before = min(int(at), max(last - 1, 0))
        after = min(before + 1, last)
        share = at - before
        for n in range(len(planned)):
            for axis in range(3):
                out[n, k, axis] = (1.0 - share) * planned[n, before, axis] + share * planned[
                    n, after, axis
                ]
    for n in range(len(planned)):
        for axis in range(3):
            off = places[n, axis] - out[n, 0, axis]
            for k in range(AHEAD):
                out[n, k, axis] += max(1.0 - k * AHEAD_S, 0.0) * off
