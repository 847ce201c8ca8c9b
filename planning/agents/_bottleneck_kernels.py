"""Keeping right at narrow places that many want through from both sides, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._passage_kernels import (
    BEFORE_M,
    FEET_M,
    FOUND,
    HALF_M,
    LOOK_IN_S,
    MIDDLE_X,
    MIDDLE_Y,
    NEAREST_M,
    THROUGH_X,
    THROUGH_Y,
    WAITED_S,
    find_passage,
)
from esplanade.planning.agents.agents import Agents
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, length
from esplanade.planning.routes._potential_kernels import Guide

OPPOSED = 8
"""So many who want through a passage against me make me keep right there."""
SAME_M = 1.0
"""Two found passages no further apart than that across and in height,"""
LONG_M = 6.0
"""and along the way through: they are the two ends of one."""
LOOK_S = 1.0
"""Passages are looked for every so often, or half as often: after the first look not by all in the
same tick."""
AFTER_M = 4.0
"""Who has come through a passage keeps right for so far,"""
PASSED_M = 8.0
"""and goes before those who still have to come there for so far."""
SHIFT_M = 0.2
"""The lane begins so far to the right of the middle, or half-way to the side of the passage."""
NEARER_M = 0.5
"""Who comes nearer to a passage by so much has got on."""
WAITING_MPS = 0.2
"""A second without getting on is worth so many metres less to a passage."""
LEFT_RAD = 1.0
"""Seen from where the lane begins, who is so far to the left of it is wholly on the left."""


class Lane(NamedTuple):
    """The right-hand side of a passage: the middle of the passage, the unit vector through it, how
    far to the right of the middle the lane begins, and what a metre nearer weighs wholly on the
    left, in metres: 0 where the lane is not to be kept to."""

    x: float
    y: float
    along_x: float
    along_y: float
    shift_m: float
    weight: float


@inlined
def lane_of(passage: NDArray[np.float64], weight: float) -> Lane:
    """The lane through a passage (PASSAGE,)."""
    shift_m = min(SHIFT_M, 0.5 * passage[HALF_M])
    return Lane(
        passage[MIDDLE_X],
        passage[MIDDLE_Y],
        passage[THROUGH_X],
        passage[THROUGH_Y],
        shift_m,
        weight,
    )


@kernel
def astray(lane: Lane, x: float, y: float) -> float:
    """Metres of way that being left of a lane is like; none where there is no lane to keep to.

    It grows with the angle, so that it leads around those who come out rather than through them,
    and from far away on, so that who comes near is on the right already.
    """
    if lane.weight == 0.0:
        return 0.0
    dx = x - lane.x
    dy = y - lane.y
    along = dx * lane.along_x + dy * lane.along_y
    left = lane.shift_m - (dx * lane.along_y - dy * lane.along_x)
    near = (AFTER_M if along > 0.0 else BEFORE_M) - length(dx, dy)
    if near <= 0.0 or left <= 0.0:
        return 0.0
    angle = np.arctan2(left, abs(along))
    return float(lane.weight * near * min(1.0, angle / LEFT_RAD))


@inlined
def _beyond(crowd: Agents, a: int) -> tuple[bool, float]:
    """Whether an actor has come through its passage, and how far it is from the middle of it."""
    p = crowd.passages[a]
    dx = crowd.positions[a, 0] - p[MIDDLE_X]
    dy = crowd.positions[a, 1] - p[MIDDLE_Y]
    return bool(p[THROUGH_X] * dx + p[THROUGH_Y] * dy > 0.0), length(dx, dy)


@inlined
def _has_passage(crowd: Agents, a: int) -> bool:
    p = crowd.passages[a]
    return bool(p[THROUGH_X] != 0.0 or p[THROUGH_Y] != 0.0)


@inlined
def _alike(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Cosine between the ways through two passages (FOUND,) if they are the same one, else 0."""
    ux = one[THROUGH_X]
    uy = one[THROUGH_Y]
    dx = other[MIDDLE_X] - one[MIDDLE_X]
    dy = other[MIDDLE_Y] - one[MIDDLE_Y]
    if (
        abs(dx * uy - dy * ux) < SAME_M
        and abs(dx * ux + dy * uy) < LONG_M
        and abs(other[FEET_M] - one[FEET_M]) < SAME_M
    ):
        return float(ux * other[THROUGH_X] + uy * other[THROUGH_Y])
    return 0.0


@kernel
def see_passage(
    grid: GridArrays, potential: Guide, crowd: Agents, a: int, going: bool, tick_s: float
) -> None:
    """Renew an actor's passage, and how near it has come; who has come through keeps the last one
    for a while."""
    p = crowd.passages[a]
    if not going:
        p[:] = 0.0
        return
    p[LOOK_IN_S] -= tick_s
    p[WAITED_S] += tick_s
    beyond, away = _beyond(crowd, a)
    if beyond and away > PASSED_M:
        p[:] = 0.0
    elif not beyond and p[LOOK_IN_S] <= 0.0:
        x, y = crowd.positions[a]
        radius = crowd.parameters[a]["radius_m"]
        before = p[:FOUND].copy()
        if not find_passage(
            grid, potential, crowd.bodies[a], radius, crowd.cells[a], x, y, p[:FOUND]
        ):
            p[:] = 0.0
        elif _alike(before, p) <= 0.0:
            p[NEAREST_M] = np.inf
        p[LOOK_IN_S] = LOOK_S * (1.0 + crowd.ranks[a] / len(crowd.ranks))
        away = _beyond(crowd, a)[1]
    if away < p[NEAREST_M] - NEARER_M:
        p[NEAREST_M] = away
        p[WAITED_S] = 0.0


@kernel
def find_contested(crowd: Agents, out: NDArray[np.bool_]) -> None:
    """Fill (A,): whose passage enough others have still to come through from the other side."""
    out[:] = False
    coming = np.empty((len(out), FOUND))
    count = 0
    for a in range(len(out)):
        if _has_passage(crowd, a) and not _beyond(crowd, a)[0]:
            coming[count] = crowd.passages[a, :FOUND]
            count += 1
    if count < OPPOSED:
        return
    for a in range(len(out)):
        p = crowd.passages[a]
        against = 0
        if _has_passage(crowd, a):
            for n in range(count):
                if _alike(p, coming[n]) < 0.0:
                    against += 1
                    if against == OPPOSED:
                        break
        out[a] = against == OPPOSED


@kernel
def order_at_passages(
    crowd: Agents, contested: NDArray[np.bool_], left_m: NDArray[np.float64]
) -> None:
    """Put into `left_m` (A,) what decides who goes first where a passage is contested.

    Who has come through goes first, the furthest before all, since nobody else can come in before
    the way out is free, up to the goal, since it may lie among those who wait. Then who has still
    to come there: who has come the nearest first, and who waits without getting on ever sooner, or
    those who were crowded out to the side would stay there until all others are through. Then
    everyone else. Who is about to arrive on this side goes last, as everywhere.
    """
    if not contested.any():
        return
    for a in range(len(left_m)):
        if not contested[a]:
            left_m[a] += 2.0 * BEFORE_M  # further than anybody contested is, even in a jam
            continue
        p = crowd.passages[a]
        beyond, away = _beyond(crowd, a)
        if beyond:
            left_m[a] = -away
        elif left_m[a] < np.inf:
            left_m[a] = max(0.0, p[NEAREST_M] - WAITING_MPS * p[WAITED_S])
