"""Keeping right at narrow places that many want through from both sides, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._crowd import Crowd
from planning._grid_kernels import GridArrays, length
from planning._jit import inlined, kernel
from planning._passage_kernels import BEFORE_M, PASSAGE, find_passage
from planning._potential_kernels import Guide

OPPOSED = 8
"""So many who want through a passage against me make me keep right there."""
SAME_M = 1.0
"""Two found a passage no further apart than that, along x, along y and in height: it is one."""
LOOK_S = 1.0
"""Passages are looked for every so often, or half as often: not by all in the same tick."""
AFTER_M = 4.0
"""Who has come through a passage keeps right for so far,"""
PASSED_M = 8.0
"""and goes before those who still have to come there for so far."""
SHIFT_M = 0.3
"""The lane begins so far to the right of the middle, or half-way to the side of the passage."""
STEEPNESS = 0.8
"""What a metre nearer weighs wholly on the left, in metres; below 1, or who is there would rather
go away than come nearer."""
LEFT_RAD = 1.0
"""Seen from the middle, who is so far to the left of the lane is wholly on the left."""


class Lane(NamedTuple):
    """The right-hand side of a passage: the middle of the passage, the unit vector through it, how
    far to the right of the middle the lane begins, and whether it is to be kept to."""

    x: float
    y: float
    along_x: float
    along_y: float
    shift_m: float
    kept: bool


@inlined
def lane_of(passage: NDArray[np.float64], kept: bool) -> Lane:
    """The lane through a passage (PASSAGE,)."""
    shift_m = min(SHIFT_M, 0.5 * passage[4])
    return Lane(passage[0], passage[1], passage[2], passage[3], shift_m, kept)


@kernel
def astray(lane: Lane, x: float, y: float) -> float:
    """Metres of way that being left of a lane is like; none where there is no lane to keep to.

    It grows with the angle, so that it leads around those who come out rather than through them,
    and from far away on, so that who comes near is on the right already.
    """
    if not lane.kept:
        return 0.0
    dx = x - lane.x
    dy = y - lane.y
    along = dx * lane.along_x + dy * lane.along_y
    left = lane.shift_m - (dx * lane.along_y - dy * lane.along_x)
    near = (AFTER_M if along > 0.0 else BEFORE_M) - length(dx, dy)
    if near <= 0.0 or left <= 0.0:
        return 0.0
    angle = np.arctan2(left, abs(along))
    return float(STEEPNESS * near * min(1.0, angle / LEFT_RAD))


@inlined
def _beyond(crowd: Crowd, a: int) -> tuple[bool, float]:
    """Whether an actor has come through its passage, and how far it is from the middle of it."""
    p = crowd.passages[a]
    dx = crowd.positions[a, 0] - p[0]
    dy = crowd.positions[a, 1] - p[1]
    return bool(p[2] * dx + p[3] * dy > 0.0), length(dx, dy)


@inlined
def _has_passage(crowd: Crowd, a: int) -> bool:
    return bool(crowd.passages[a, 2] != 0.0 or crowd.passages[a, 3] != 0.0)


@kernel
def see_passage(
    grid: GridArrays, guide: Guide, crowd: Crowd, a: int, going: bool, tick_s: float
) -> None:
    """Renew an actor's passage; who has come through keeps the last one for a while."""
    p = crowd.passages[a]
    if not going:
        p[:] = 0.0
        return
    p[6] -= tick_s
    beyond, away = _beyond(crowd, a)
    if beyond and away > PASSED_M:
        p[:] = 0.0
    elif not beyond and p[6] <= 0.0:
        x, y = crowd.positions[a]
        radius = crowd.parameters[a]["radius_m"]
        if not find_passage(grid, guide, crowd.bodies[a], radius, crowd.cells[a], x, y, p):
            p[:] = 0.0
        p[6] = LOOK_S * (1.0 + crowd.ranks[a] / len(crowd.ranks))


@kernel
def find_contested(crowd: Crowd, out: NDArray[np.bool_]) -> None:
    """Fill (A,): whose passage enough others have still to come through from the other side."""
    out[:] = False
    coming = np.empty((len(out), PASSAGE))
    count = 0
    for a in range(len(out)):
        if _has_passage(crowd, a) and not _beyond(crowd, a)[0]:
            coming[count] = crowd.passages[a]
            count += 1
    if count < OPPOSED:
        return
    for a in range(len(out)):
        p = crowd.passages[a]
        against = 0
        if _has_passage(crowd, a):
            for n in range(count):
                if (
                    abs(p[0] - coming[n, 0]) < SAME_M
                    and abs(p[1] - coming[n, 1]) < SAME_M
                    and abs(p[5] - coming[n, 5]) < SAME_M
                    and p[2] * coming[n, 2] + p[3] * coming[n, 3] < 0.0
                ):
                    against += 1
                    if against == OPPOSED:
                        break
        out[a] = against == OPPOSED


@kernel
def order_at_passages(
    crowd: Crowd, contested: NDArray[np.bool_], left_m: NDArray[np.float64]
) -> None:
    """Put into `left_m` (A,) what decides who goes first where a passage is contested.

    Who has come through goes first, the furthest before all, since nobody else can come in before
    the way out is free; then who has still to come there, the nearest first; then everyone else.
    """
    if not contested.any():
        return
    for a in range(len(left_m)):
        if contested[a]:
            beyond, away = _beyond(crowd, a)
            left_m[a] = -away if beyond else away
        else:
            left_m[a] += BEFORE_M
