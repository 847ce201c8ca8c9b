"""The places of bodies on their courses, worked out one body after the other."""

from __future__ import annotations

import math

import numpy as np

from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.compiled.jit import inlined, kernel

AHEAD_S = 0.2
AHEAD = 7
WALKING_MPS = 0.3
PUSHED_S = 0.6
"""A body that is pushed off its plan is expected to go on so for this time: about a step."""
PUSHED_MPS = 0.05
"""A body whose velocity differs by less is on its plan."""
BACKWARD_MPS = 0.3
"""A body that goes backward along its plan by this speed goes on so; one that is only slower, as
while it starts to walk, does not."""


@inlined
def along(ahead: Floats, seconds: float, axis: int) -> float:
    """A coordinate of a course (AHEAD, 3) after a time, linear between its places."""
    place = min(max(seconds / AHEAD_S, 0.0), AHEAD - 1.0)
    k = min(int(place), AHEAD - 2)
    return float(ahead[k, axis] + (place - k) * (ahead[k + 1, axis] - ahead[k, axis]))


@inlined
def velocity_about(ahead: Floats, seconds: float) -> tuple[float, float]:
    """Velocity on a course (AHEAD, 3) about a time, metres a second; over AHEAD_S at most."""
    half = 0.5 * AHEAD_S
    before = min(half, max(seconds, 0.0))
    x = along(ahead, seconds + half, 0) - along(ahead, seconds - before, 0)
    y = along(ahead, seconds + half, 1) - along(ahead, seconds - before, 1)
    return x / (half + before), y / (half + before)


@inlined
def desired_heading(heading: float, x_mps: float, y_mps: float) -> float:
    """Heading that a body wants: the direction in which it walks, else as its course says."""
    if math.hypot(x_mps, y_mps) > WALKING_MPS:
        return math.atan2(y_mps, x_mps)
    return heading


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


@kernel
def go_on_pushed(planned: Floats, slice_s: float, now_s: float, moved: Floats, out: Floats) -> Ints:
    """Let courses (N, AHEAD, 3) of bodies that are pushed off their plans begin as they go.

    The plans are those of `follow_plans`, and (N, 2) `moved` is how far each body has come since
    they began. Heights stay. Returns the rows (L,) of these bodies.
    """
    rows = np.empty(len(planned), np.int64)
    count = 0
    share = min(now_s / slice_s, 1.0) / now_s
    after = min(1, planned.shape[1] - 1)
    for n in range(len(planned)):
        x_mps, y_mps = moved[n, 0] / now_s, moved[n, 1] / now_s
        plan_x_mps = share * (planned[n, after, 0] - planned[n, 0, 0])
        plan_y_mps = share * (planned[n, after, 1] - planned[n, 0, 1])
        speed_mps = math.hypot(plan_x_mps, plan_y_mps)
        if speed_mps > PUSHED_MPS:
            ux, uy = plan_x_mps / speed_mps, plan_y_mps / speed_mps
            along_mps = x_mps * ux + y_mps * uy
            backward = min(max(-along_mps / BACKWARD_MPS, 0.0), 1.0)
            kept_mps = along_mps - backward * (along_mps - speed_mps)
            x_mps, y_mps = x_mps - kept_mps * ux, y_mps - kept_mps * uy
        if math.hypot(x_mps, y_mps) <= PUSHED_MPS:
            continue
        for k in range(AHEAD):
            seconds = min(k * AHEAD_S, PUSHED_S)
            out[n, k, 0] += seconds * x_mps
            out[n, k, 1] += seconds * y_mps
        rows[count] = n
        count += 1
    return rows[:count]
