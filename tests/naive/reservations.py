"""Meetings with certain obstacles, by looking at every other actor and at many moments."""

from __future__ import annotations

import math

import numpy as np

from esplanade.planning.agents._reservation_kernels import Reservations
from esplanade.planning.agents.priorities import Priorities, Turn
from tests.naive.geometry import Point, closest_approach

BODIES_OVERLAP_M = 1.8
SOFT = 0.25
EVADING_SLICES = 2
EVADING_M = 0.005
MEETING_ROOM_M = 0.8
MEETING_ROOM = 0.2
QUEUE_ROOM_M = 0.5
QUEUE_ROOM = 0.2
AGAINST = -0.2
JAM_M = 8.0
JAM_ACTORS = 8


def conflict(
    r: Reservations, margin_m: float, me: int, feet_m: float, k: int, a: Point, b: Point
) -> tuple[bool, float]:
    """Whether a move has a forbidden meeting, and what the others on that floor weigh together."""
    blocked = False
    soft = 0.0
    for other in range(len(r.paths)):
        if other == me or abs(r.heights[other, k + 1] - feet_m) >= BODIES_OVERLAP_M:
            continue
        if k % 2:
            soft += crowding(r, margin_m, me, other, k + 1, b)
        from_there, to_there = r.paths[other, k], r.paths[other, k + 1]
        nearest = _nearest(a, b, from_there, to_there)
        before = math.dist(a, from_there)
        apart = nearest >= before - 1e-9 and math.dist(b, to_there) > before
        if nearest >= r.radii[me] + r.radii[other] + margin_m or apart:
            continue
        gained = nearest - _nearest(a, a, from_there, to_there)
        evades = k < EVADING_SLICES and gained > EVADING_M
        if r.ranks[other] < r.ranks[me] and not evades:
            blocked = True
        else:
            soft += SOFT
    return blocked, soft


def crowding(r: Reservations, margin_m: float, me: int, other: int, k: int, at: Point) -> float:
    """The cost of lacking room between two agents of which at least one is held up."""
    away = np.subtract(r.paths[other, k], at)
    room_m = math.hypot(*away) - r.radii[me] - r.radii[other] - margin_m
    mine, others = r.courses[me], r.courses[other]
    if not r.held_up[me] and not r.held_up[other]:
        return 0.0
    if mine @ others < AGAINST:
        lacking = min(1.0, max(0.0, 1.0 - room_m / MEETING_ROOM_M))
        bearing = math.atan2(away[1], away[0]) - math.atan2(mine[1], mine[0])
        return MEETING_ROOM * lacking * max(0.0, 0.5 - math.sin(bearing))
    if r.held_up[me] and r.held_up[other]:
        return QUEUE_ROOM * min(1.0, max(0.0, 1.0 - room_m / QUEUE_ROOM_M))
    return 0.0


def _nearest(a: Point, b: Point, c: Point, d: Point) -> float:
    """Smallest distance of two who go evenly from a to b, and from c to d."""
    before, after = np.subtract(a, c), np.subtract(b, d)
    return closest_approach(tuple(before), tuple(after - before))


def jam_order(r: Reservations, who: Priorities) -> list[tuple[int, float]]:
    """Turns and keys of all agents, by listing everyone held up."""
    held_up = [o for o in range(len(who.turns)) if r.held_up[o]]
    walking = list(zip(who.turns.tolist(), who.keys_m.tolist(), strict=True))
    if len(held_up) < JAM_ACTORS:
        return walking
    return [_in_jam(r, a, each, held_up) for a, each in enumerate(walking)]


def _in_jam(
    r: Reservations, me: int, walking: tuple[int, float], held_up: list[int]
) -> tuple[int, float]:
    here, course = r.paths[me, 0], r.courses[me]
    near = [
        o
        for o in held_up
        if o != me
        and math.dist(r.paths[o, 0], here) <= JAM_M
        and abs(r.heights[o, 0] - r.heights[me, 0]) < BODIES_OVERLAP_M
    ]
    against = [r.paths[o, 0] for o in near if course @ r.courses[o] < AGAINST]
    if walking[0] == Turn.SETTLED or len(against) < JAM_ACTORS:
        return walking
    alike = [r.paths[o, 0] for o in near if course @ r.courses[o] > -AGAINST]
    middle = (np.mean([here, *alike], axis=0) + np.mean(against, axis=0)) / 2.0 - here
    if middle @ course < 0.0:
        return Turn.LEAVES_JAM, -math.hypot(*middle)
    return Turn.ENTERS_JAM, math.hypot(*middle)
