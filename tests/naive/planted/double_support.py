"""Double support: where the hips are between any two footprints.

A pose with both feet on the ground follows from their two footprints alone. Of the distance between
the feet the part ahead is walked; the part to the side only shifts the hips.
Lengths are shares of the leg's; a footprint is (x, y, z, heading).
"""

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.step_length import (
    StraightDoubleSupport,
    longest_step,
    planted_length,
    pose_table,
)
from esplanade.planning.compiled.arrays import Floats
from tests.naive.planted import flight, stairs
from tests.naive.planted.reach import hip_ceiling

CROUCH = 0.007
"""Hips are lower by this than the curves have them, because knees would lock otherwise."""

_PACE = 1.12
"""Speed of the hips in double support, in step lengths a step."""

_MONOTONE = 2.95
"""Below 3 times the distance to the next pose, the speed of a cubic makes it never turn back."""

_REACH = 0.9935
"""Legs in double support are stretched to this at most."""


class DoubleSupportPose(NamedTuple):
    """A pose with both feet on the ground; everything (...,) or (..., 2)."""

    rv: Floats
    pace: Floats
    """Relative velocity of a straight step as long as this one, whatever its direction."""
    place: Floats
    """(..., 2): hip centre."""
    speed: Floats
    """(..., 2): of the hip centre, a step."""
    yaw: Floats
    """Radians; where the pelvis faces."""
    turning: Floats
    """Radians a step."""
    ground: Floats
    """Height that stands for level ground."""
    lowered: Floats
    """The distance that the hips come down so that both feet are in reach."""
    hip_height: Floats
    """Height of the hips above the ground by the curves, before they are lowered."""
    heel: Floats
    """Height of the rear heel above its footprint, the toe on the ground."""
    strike: Floats
    """Pitch of the front foot at its heel strike, radians, positive with the toe up."""
    flight: Floats
    """Share of the step to this pose that is flown; above 0 the rear foot is in the air."""


def pose_of_length(length: Floats) -> tuple[Floats, StraightDoubleSupport]:
    """Relative velocity and final pose of planted steps, from the table."""
    lengths, *columns = pose_table()
    rv, *pose = (np.interp(length, lengths, column) for column in columns)
    return rv, StraightDoubleSupport(*pose)


def ankle_over_toe(footprint: Floats, pitch: Floats) -> Floats:
    """Ankles (..., 3) of feet on footprints (..., 4) that are pitched about their toes."""
    heading = footprint[..., 3]
    heel_forward = FOOT * (1.0 - np.cos(pitch))
    return np.stack(
        [
            footprint[..., 0] + heel_forward * np.cos(heading),
            footprint[..., 1] + heel_forward * np.sin(heading),
            footprint[..., 2] - FOOT * np.sin(pitch),
        ],
        axis=-1,
    )


def forward_and_left(yaw: Floats) -> tuple[Floats, Floats]:
    """Unit vectors (..., 2) of a heading."""
    forward = np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)
    return forward, np.stack([-forward[..., 1], forward[..., 0]], axis=-1)


def double_support_pose(rear: Floats, front: Floats, side: Floats) -> DoubleSupportPose:
    """The pose between two footprints (..., 4); side is 1 where the front foot is the left one.

    Headings must not be a turn apart: their middle is where the pelvis faces.
    """
    yaw = 0.5 * (rear[..., 3] + front[..., 3])
    forward, left = forward_and_left(yaw)
    apart = front[..., :2] - rear[..., :2]
    ahead = np.sum(apart * forward, axis=-1)
    aside = np.sum(apart * left, axis=-1)
    shifted = aside - 2.0 * side * TRACK_HALF_WIDTH
    walked = np.stack([np.maximum(ahead, 0.0), np.hypot(ahead, shifted)])
    both, poses = pose_of_length(np.minimum(walked, longest_step()))
    pose = StraightDoubleSupport._make(part[0] for part in poses)
    behind = pose.front_forward + 0.5 * (ahead - planted_length(pose))
    place = front[..., :2] - behind[..., None] * forward - 0.5 * aside[..., None] * left
    speed = np.sign(ahead) * np.minimum(_PACE * np.abs(ahead), _MONOTONE * np.abs(behind))
    ground = stairs.ground_height(rear[..., 2], front[..., 2])
    heel = stairs.heel_height(pose.heel_raised, ground, rear[..., 2])
    hip_height = -pose.front_up - CROUCH
    lowered = _lowered(
        np.concatenate([place, (ground + hip_height)[..., None]], axis=-1), rear, front, heel, side
    )
    even = 1.0 - stairs.unevenness(front[..., 2] - rear[..., 2])
    flown = flight.flight_share(ahead, front[..., 2] - rear[..., 2])
    runs = flown > 0.0
    landing = front[..., :2] - flight.LANDS_AHEAD * forward - 0.5 * aside[..., None] * left
    return DoubleSupportPose(
        both[0],
        both[1],
        np.where(runs[..., None], landing, place),
        np.where(runs, ahead, speed)[..., None] * forward + (_PACE * shifted)[..., None] * left,
        yaw,
        _PACE * (front[..., 3] - rear[..., 3]),
        np.where(runs, front[..., 2], ground),
        np.where(runs, 0.0, lowered),
        np.where(runs, flight.LANDING_HEIGHT, hip_height),
        np.where(runs, 0.0, heel),
        np.where(runs, flight.STRIKE, np.maximum(pose.front_pitch, 0.0) * even),
        flown,
    )


def _lowered(root: Floats, rear: Floats, front: Floats, heel: Floats, side: Floats) -> Floats:
    """The distance that hips (..., 3) must come down for both ankles to be in reach."""
    yaw = 0.5 * (rear[..., 3] + front[..., 3])
    aside = np.zeros_like(root)
    aside[..., :2] = (side * TRACK_HALF_WIDTH)[..., None] * forward_and_left(yaw)[1]
    ceiling = np.minimum(
        hip_ceiling(root + aside, front[..., :3], _REACH),
        hip_ceiling(root - aside, ankle_over_toe(rear, -np.arcsin(heel / FOOT)), _REACH),
    )
    return np.maximum(root[..., 2] - ceiling, 0.0)


def hermite(u: Floats, start: Floats, slope: Floats, end: Floats, end_slope: Floats) -> Floats:
    """Cubic from start to end with given slopes at u = 0 and 1."""
    rest = 1.0 - u
    curve: Floats = (
        (1.0 + 2.0 * u) * rest * rest * start
        + u * rest * rest * slope
        + (3.0 - 2.0 * u) * u * u * end
        - u * u * rest * end_slope
    )
    return curve


def hips_under_way(
    before: DoubleSupportPose, after: DoubleSupportPose, u: Floats
) -> tuple[Floats, Floats]:
    """Hip centre (..., 2) and yaw (...,) between two poses, joining others with equal speeds."""
    share = u[..., None]
    place = hermite(share, before.place, before.speed, after.place, after.speed)
    return place, hermite(u, before.yaw, before.turning, after.yaw, after.turning)
