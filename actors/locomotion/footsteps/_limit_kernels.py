"""Limits of the distances of feet and bodies, so that legs reach and do not cross."""

from __future__ import annotations

import math

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait._curve_kernels import mix
from esplanade.actors.locomotion.planted.footprints import HEADING
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined

# Lengths in legs.
PAST_STANDING = 0.5
"""A step takes the body no further from its standing foot."""
PAST_TOE = 0.1
"""It may get further by this where the toe points, because the foot can rise on its toe."""
BEHIND_LANDING = 0.54
"""A step leaves the body no further from the landing foot."""

LONGEST_WALK = 0.68
"""Longest step that is walked: a body that is faster takes it in less time, until it runs."""
_LONGEST_RUN = 1.15
"""Longest step of a run."""
# Leg lengths a second.
_RUNS_FROM = 2.2
"""From this speed on steps grow beyond the longest of a walk."""
_RUNS_WHOLLY = 2.9
"""At this speed they may be as long as a run's longest."""

_FURTHEST_AHEAD = 0.86
"""A walker's feet land no further apart: beyond it a step has a flight."""
_FURTHEST_BACK = 0.55
_FURTHEST_ASIDE = 0.55
_NEAREST_ASIDE = 1.1 * TRACK_HALF_WIDTH
"""A swing foot keeps this far to its own side of the standing foot as it passes."""

_TURN = 2.0 * math.pi


@inlined
def wrapped(angle: float) -> float:
    """The same angle in [-pi, pi), radians."""
    return float((angle + math.pi) % _TURN - math.pi)


@inlined
def longest_step(legs_a_second: float) -> float:
    """Longest step at a speed, in legs: from that of a walk to that of a run."""
    faster = (legs_a_second - _RUNS_FROM) / (_RUNS_WHOLLY - _RUNS_FROM)
    return mix(LONGEST_WALK, _LONGEST_RUN, min(max(faster, 0.0), 1.0))


@inlined
def distance_and_limit(
    x: float, y: float, standing: Floats, legs_a_second: float
) -> tuple[float, float]:
    """Distance of a body from its standing foot (4,), metres, and how large it may be, in legs.

    Where the toe points it may be larger, by as much as steps at its speed are longer than those of
    a walk, too.
    """
    aside_x, aside_y = x - standing[0], y - standing[1]
    distance = math.hypot(aside_x, aside_y)
    ahead = aside_x * math.cos(standing[HEADING]) + aside_y * math.sin(standing[HEADING])
    more = PAST_TOE + longest_step(legs_a_second) - LONGEST_WALK
    return distance, PAST_STANDING + more * max(ahead / max(distance, 1e-9), 0.0)


@inlined
def clamped_foot(
    x: float,
    y: float,
    standing: Floats,
    middle: float,
    side: float,
    longest: float,
    leg_m: float,
) -> tuple[float, float]:
    """The nearest place for a swing foot that is on its own side and within reach; metres.

    `standing` (4,) is the other footprint, `middle` the heading midway between both feet, and
    `side` is 1 where the swing foot is the left one, else -1; `longest` is the longest step, in
    legs.
    """
    furthest = _FURTHEST_AHEAD + longest - LONGEST_WALK
    cos, sin = math.cos(middle), math.sin(middle)
    apart_x, apart_y = x - standing[0], y - standing[1]
    ahead = apart_x * cos + apart_y * sin
    ahead = min(max(ahead, -_FURTHEST_BACK * leg_m), furthest * leg_m)
    aside = side * (apart_x * -sin + apart_y * cos)
    aside = side * min(max(aside, _NEAREST_ASIDE * leg_m), _FURTHEST_ASIDE * leg_m)
    return standing[0] + ahead * cos + aside * -sin, standing[1] + ahead * sin + aside * cos


@inlined
def clamped_distance(
    x: float, y: float, from_x: float, from_y: float, limit_m: float
) -> tuple[float, float]:
    """A point moved towards another one until it is within a limit of it; metres."""
    apart_x, apart_y = x - from_x, y - from_y
    distance = max(math.hypot(apart_x, apart_y), 1e-9)
    share = min(distance, limit_m) / distance
    return from_x + apart_x * share, from_y + apart_y * share
