"""Footholds of swing feet, from where a body is going and where there is ground."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.footsteps._course_kernels import (
    along,
    desired_heading,
    velocity_about,
)
from esplanade.actors.locomotion.footsteps._ground_kernels import (
    Covering,
    GroundArrays,
    settle_foot,
)
from esplanade.actors.locomotion.footsteps._limit_kernels import (
    BEHIND_LANDING,
    clamped_distance,
    clamped_foot,
    distance_and_limit,
    longest_step,
    wrapped,
)
from esplanade.actors.locomotion.gait._curve_kernels import mix, smooth
from esplanade.actors.locomotion.planted._flight_kernels import LANDS_AHEAD, SHORTEST_RUN
from esplanade.actors.locomotion.planted.footprints import HEADING, Z
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined

# Limits of the height up or down to which a foot is put.
_TREAD_M = 0.26
"""Greatest rise or fall ahead of a body that takes one tread at a time."""
_TWO_TREADS_M = 0.42
"""Greatest rise or fall ahead of a body that is too fast for that."""
_HASTY_MPS = 1.6
"""A body faster than this is too fast to take one tread at a time."""
_CLIMB_M = 0.75
"""Greatest rise or fall under a body that is going there."""
_LEFT_M = 0.42
"""A body this far above or below its standing foot has left it, as over the side of a flight."""
_CATCH_UP_M = 1.5
"""Greatest rise or fall under a body that has left its standing foot: one foot is behind then,
where else both would stay and the body had to stand anew."""

_OPENING_RAD = 1.6
"""The greatest angle by which a foot is turned outwards against the other one."""
_CLOSING_RAD = 1.0
"""The greatest angle by which a foot is turned inwards against the other one."""

_SURE_RUN = SHORTEST_RUN + 0.07
"""From this length on heels land as near to the hips as in a run, leg lengths."""

_PLACES = 6
_AHEAD, _HALFWAY, _UNDER, _FAR_UNDER, _PART_UNDER = 0, 1, 2, 3, 4
"""Places that are tried one after the other; the last one is beside the standing foot."""


class HeelTable(NamedTuple):
    """Distances ahead of the hips where heels land, by the lengths of steps; in legs."""

    length: Floats
    """(M,), ascending."""
    ahead: Floats
    """(M,)."""


class Foothold(NamedTuple):
    """The targets of a step besides its footprint."""

    hips_x: float
    """Place of the hips at the end, metres."""
    hips_y: float
    body_x: float
    """Place of the body at the end, metres, which the hips may not get to."""
    body_y: float
    x_mps: float
    """Velocity of the body then."""
    y_mps: float
    heading: float
    """Heading that the body wants then, radians."""


@inlined
def _heel_ahead_of_hips(table: HeelTable, length: float) -> float:
    """Distance ahead of the hips, leg lengths, where the heel of a step of a length lands."""
    last = len(table.length) - 1
    if length >= table.length[last]:
        runs = smooth((length - table.length[last]) / (_SURE_RUN - table.length[last]))
        return mix(table.ahead[last], LANDS_AHEAD, runs)
    k = max(int(np.searchsorted(table.length, length, side="right")) - 1, 0)
    rise = table.ahead[k + 1] - table.ahead[k]
    slope = rise / (table.length[k + 1] - table.length[k])
    return float(slope * (length - table.length[k]) + table.ahead[k])


@inlined
def choose_foothold(
    ahead: Floats,
    facing: float,
    on_right: bool,
    standing: Floats,
    leg_m: float,
    step_s: float,
    left_s: float,
    table: HeelTable,
    ground: GroundArrays,
    covering: Covering,
    landing: Floats,
) -> Foothold:
    """Choose where a swing foot lands while the other foot (4,) stands; landing (4,) is written.

    The body is on the course `ahead` (AHEAD, 3), `facing` somewhere; the whole step takes `step_s`
    seconds, of which `left_s` are left. A foot lands half a step ahead of where the body will be,
    on its own side. If there is no ground it lands halfway to the place under the body, or under
    it, or on the way there from the standing foot, or beside that. So feet follow a body that runs
    up stairs faster than they can climb.
    """
    x, y = along(ahead, left_s, 0), along(ahead, left_s, 1)
    z = along(ahead, left_s, 2)
    x_mps, y_mps = velocity_about(ahead, left_s)
    desired = desired_heading(facing, x_mps, y_mps)
    side = 1.0 if on_right else -1.0
    turn = side * wrapped(desired - standing[HEADING])
    heading = standing[HEADING] + side * min(max(turn, -_CLOSING_RAD), _OPENING_RAD)

    legs_a_second = math.hypot(x_mps, y_mps) / leg_m
    longest = longest_step(legs_a_second)
    _, limit = distance_and_limit(x, y, standing, legs_a_second)
    hips_x, hips_y = clamped_distance(x, y, standing[0], standing[1], 1.1 * limit * leg_m)
    cos, sin = math.cos(heading), math.sin(heading)
    ahead_mps = x_mps * cos + y_mps * sin
    aside_mps = x_mps * -sin + y_mps * cos
    forward = 0.5 * ahead_mps * step_s
    if ahead_mps > 0.0:
        forward = leg_m * _heel_ahead_of_hips(table, ahead_mps * step_s / leg_m)
    track = side * TRACK_HALF_WIDTH * leg_m
    aside = track + 0.5 * aside_mps * step_s
    middle = standing[HEADING] + 0.5 * (heading - standing[HEADING])
    hasty = math.hypot(x_mps, y_mps) > _HASTY_MPS
    climb_m = _TWO_TREADS_M if hasty else _TREAD_M
    has_left = abs(ahead[0, 2] - standing[Z]) > _LEFT_M
    under_m = _CATCH_UP_M if has_left else _CLIMB_M

    landing[HEADING] = heading
    under_x, under_y = hips_x + track * -sin, hips_y + track * cos
    for place in range(_PLACES):
        to_x, to_y, to_z = standing[0], standing[1], standing[Z]
        if place == _AHEAD:
            to_x = hips_x + forward * cos + aside * -sin
            to_y = hips_y + forward * sin + aside * cos
            to_z = z
        elif place == _HALFWAY:
            to_x, to_y = 0.5 * (landing[0] + under_x), 0.5 * (landing[1] + under_y)
            to_z = 0.5 * (landing[Z] + z)
        elif place <= _FAR_UNDER:
            to_x, to_y, to_z = under_x, under_y, z
        elif place == _PART_UNDER:
            to_x, to_y = 0.5 * (standing[0] + under_x), 0.5 * (standing[1] + under_y)
            to_z = 0.5 * (standing[Z] + z)
        landing[0], landing[1] = clamped_foot(to_x, to_y, standing, middle, side, longest, leg_m)
        landing[Z] = to_z
        found = settle_foot(ground, covering, landing, FOOT * leg_m)
        limit_m = climb_m if place < _FAR_UNDER else under_m
        if found and abs(landing[Z] - standing[Z]) <= limit_m:
            break
    # Footprints are sent in tenths of a millimetre; feet would land beside finer ones.
    for d in range(3):
        landing[d] = np.rint(landing[d] * 1e4) / 1e4
    hips_x, hips_y = clamped_distance(
        hips_x, hips_y, landing[0], landing[1], BEHIND_LANDING * leg_m
    )
    return Foothold(hips_x, hips_y, x, y, x_mps, y_mps, desired)
