"""Double support: where the hips are between any two footprints.

A pose with both feet on the ground follows from their two footprints alone. So one step ends as
the next one begins, wherever the footprints lead: straight on, round a bend, sideways, backward,
on the spot. Of the distance between the feet the part ahead is walked; the part to the side only
shifts the hips. Where feet are too far apart to be both on the ground, the rear one is in the air:
the body runs. Lengths are shares of the leg's.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.step_length import PoseTable
from esplanade.actors.locomotion.planted._flight_kernels import (
    LANDING_HEIGHT,
    LANDS_AHEAD,
    STRIKE,
    flight_share,
)
from esplanade.actors.locomotion.planted._reach_kernels import excess_height
from esplanade.actors.locomotion.planted._stairs_kernels import (
    ground_height,
    heel_height,
    unevenness,
)
from esplanade.actors.locomotion.planted.footprints import Footprint
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined, kernel

CROUCH = 0.007
"""Hips are lower by this than the curves have them, because knees would lock otherwise."""

_PACE = 1.12
"""Speed of the hips in double support, in step lengths a step."""

_MONOTONE = 2.95
"""Below 3 times the distance to the next pose, the speed of a cubic makes it never turn back."""

_REACH = 0.9935
"""Legs in double support are stretched to this at most: the swing must end in the same pose."""


class DoubleSupportPose(NamedTuple):
    """A pose with both feet on the ground; leg lengths, radians, and those a step."""

    rv: float
    """Relative velocity of the part of the step that leads ahead."""
    pace: float
    """Relative velocity of a straight step as long as this one, whatever its direction."""
    x: float
    """Place of the hip centre."""
    y: float
    speed_x: float
    """Speed of the hip centre, a step."""
    speed_y: float
    yaw: float
    """Heading of the pelvis."""
    turning: float
    """Change of the yaw, a step."""
    ground: float
    """Height that stands for level ground."""
    lowered: float
    """The depth by which the hips come down for both feet to be in reach."""
    hip_height: float
    """Height of the hips above the ground by the curves, before they are lowered."""
    heel: float
    """Height of the rear heel above its footprint, the toe on the ground."""
    strike: float
    """Pitch of the front foot at its heel strike, positive with the toe up."""
    flight: float
    """Share of the step to this pose that is flown; above 0 the rear foot is in the air."""


@kernel
def double_support_pose(
    rear: Footprint, front: Footprint, side: float, table: PoseTable
) -> DoubleSupportPose:
    """The pose between two footprints; `side` is 1 where the front foot is the left one, else -1.

    The headings must be less than a turn apart: the pelvis faces midway between them.
    """
    yaw = 0.5 * (rear.heading + front.heading)
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y = front.x - rear.x, front.y - rear.y
    ahead, aside = x * cos + y * sin, y * cos - x * sin
    shifted = aside - 2.0 * side * TRACK_HALF_WIDTH
    longest = table.length[-1]
    k, share = _interval(table.length, min(max(ahead, 0.0), longest))
    rv = _value(table.rv, k, share)
    front_forward = _value(table.front_forward, k, share)
    front_up = _value(table.front_up, k, share)
    strike = max(_value(table.front_pitch, k, share), 0.0)
    raised = max(_value(table.rear_up, k, share) - front_up, 0.0)
    planted = front_forward - _value(table.rear_forward, k, share) + FOOT
    planted -= math.sqrt(FOOT * FOOT - raised * raised)
    k, share = _interval(table.length, min(math.hypot(ahead, shifted), longest))
    pace = _value(table.rv, k, share)

    behind = front_forward + 0.5 * (ahead - planted)
    place_x = front.x - behind * cos + 0.5 * aside * sin
    place_y = front.y - behind * sin - 0.5 * aside * cos
    speed = math.copysign(min(_PACE * abs(ahead), _MONOTONE * abs(behind)), ahead)
    ground = ground_height(rear.z, front.z)
    heel = heel_height(raised, ground, rear.z)
    hip_height = -front_up - CROUCH
    height = ground + hip_height

    flight = flight_share(ahead, front.z - rear.z)
    if flight > 0.0:
        shift = 0.5 * aside
        return DoubleSupportPose(
            rv,
            pace,
            front.x - LANDS_AHEAD * cos + shift * sin,
            front.y - LANDS_AHEAD * sin - shift * cos,
            ahead * cos - _PACE * shifted * sin,
            ahead * sin + _PACE * shifted * cos,
            yaw,
            _PACE * (front.heading - rear.heading),
            front.z,
            0.0,
            LANDING_HEIGHT,
            0.0,
            STRIKE,
            flight,
        )

    heel_forward = FOOT - math.sqrt(FOOT * FOOT - heel * heel)
    hip_x, hip_y = -side * TRACK_HALF_WIDTH * sin, side * TRACK_HALF_WIDTH * cos
    lowered = max(
        excess_height(
            place_x + hip_x - front.x, place_y + hip_y - front.y, height - front.z, _REACH
        ),
        excess_height(
            place_x - hip_x - rear.x - heel_forward * math.cos(rear.heading),
            place_y - hip_y - rear.y - heel_forward * math.sin(rear.heading),
            height - rear.z - heel,
            _REACH,
        ),
    )
    return DoubleSupportPose(
        rv,
        pace,
        place_x,
        place_y,
        speed * cos - _PACE * shifted * sin,
        speed * sin + _PACE * shifted * cos,
        yaw,
        _PACE * (front.heading - rear.heading),
        ground,
        lowered,
        hip_height,
        heel,
        strike * (1.0 - unevenness(front.z - rear.z)),
        0.0,
    )


@inlined
def _interval(lengths: Floats, length: float) -> tuple[int, float]:
    """Interval k of a growing table (M,) that holds a length, and the share of it at the length."""
    after = int(np.searchsorted(lengths, length))
    k = min(max(after, 1), len(lengths) - 1) - 1
    return k, (length - lengths[k]) / (lengths[k + 1] - lengths[k])


@inlined
def _value(column: Floats, k: int, share: float) -> float:
    """Value of a column (M,) at a share of interval k."""
    low = column[k]
    value: float = low + share * (column[k + 1] - low)
    return value


@inlined
def hermite(u: float, start: float, slope: float, end: float, end_slope: float) -> float:
    """Value at u of the cubic from start to end that has the given slopes at u = 0 and 1."""
    rest = 1.0 - u
    return (
        (1.0 + 2.0 * u) * rest * rest * start
        + u * rest * rest * slope
        + (3.0 - 2.0 * u) * u * u * end
        - u * u * rest * end_slope
    )
