"""Where the hips are between any two footprints, and how they get from one such pose to the next.

A pose with both feet down follows from their two footprints alone. So one step ends as the next
begins, whatever way the footprints follow: straight on, round a bend, sideways, backward, on the
spot. Of what lies between the feet the part ahead is walked; the rest only shifts the hips.
Lengths are shares of the leg's; a footprint is (x, y, z, heading).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion._reach_kernels import hip_too_high
from esplanade.actors.locomotion._stairs_kernels import ground_height, heel_height, unevenness
from esplanade.actors.locomotion.skeleton import FOOT, TRACK_HALF_WIDTH, Floats
from esplanade.planning.compiled.jit import inlined, kernel

Footprint = tuple[float, float, float, float]

CROUCH = 0.007
"""Hips are so much lower than the curves have them, or knees would lock."""

_PACE = 1.12
"""Speed of the hips with both feet down, in step lengths a step."""

_MONOTONE = 2.95
"""Below 3 times the way to the next pose a cubic does not turn back."""

_REACH = 0.9935
"""Legs with both feet down leave this much to the swing, which must come to the same pose."""


class Poses(NamedTuple):
    """Final poses of straight steps, a table by length; see `step_length.DoubleSupport`."""

    lengths: Floats
    """(M,), growing."""
    rows: Floats
    """(M, 7): relative velocity; front forward, up, pitch; rear forward, up; rear toe forward."""


class BothDown(NamedTuple):
    """A pose with both feet on the ground."""

    rv: float
    pace: float
    """Relative velocity of a straight step as long as this one, whatever its direction."""
    x: float
    y: float
    speed_x: float
    """Of the hip centre, a step."""
    speed_y: float
    yaw: float
    """Radians; where the pelvis faces."""
    turning: float
    """Radians a step."""
    ground: float
    """Height that stands for level ground."""
    lowered: float
    """How much the hips come down so that both feet are in reach."""
    hip_height: float
    """Of the curves, above the ground, before anything is lowered."""
    heel: float
    """Height of the rear heel above its footprint, the toe on the ground."""
    strike: float
    """Pitch of the front foot, radians, toe up."""


@kernel
def both_down(rear: Footprint, front: Footprint, side: float, poses: Poses) -> BothDown:
    """The pose between two footprints; side is 1 where the front foot is the left one, else -1.

    Headings must not be a turn apart: their middle is where the pelvis faces.
    """
    yaw = 0.5 * (rear[3] + front[3])
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y = front[0] - rear[0], front[1] - rear[1]
    ahead, aside = x * cos + y * sin, y * cos - x * sin
    shifted = aside - 2.0 * side * TRACK_HALF_WIDTH
    longest = poses.lengths[-1]
    k, share = _found(poses, min(max(ahead, 0.0), longest))
    rv = _at(poses, k, share, 0)
    front_forward, front_up = _at(poses, k, share, 1), _at(poses, k, share, 2)
    strike = max(_at(poses, k, share, 3), 0.0)
    raised = max(_at(poses, k, share, 5) - front_up, 0.0)
    planted = front_forward - _at(poses, k, share, 4) + FOOT
    planted -= math.sqrt(FOOT * FOOT - raised * raised)
    k, share = _found(poses, min(math.hypot(ahead, shifted), longest))
    pace = _at(poses, k, share, 0)

    behind = front_forward + 0.5 * (ahead - planted)
    place_x = front[0] - behind * cos + 0.5 * aside * sin
    place_y = front[1] - behind * sin - 0.5 * aside * cos
    speed = math.copysign(min(_PACE * abs(ahead), _MONOTONE * abs(behind)), ahead)
    ground = ground_height(rear[2], front[2])
    heel = heel_height(raised, ground, rear[2])
    hip_height = -front_up - CROUCH
    height = ground + hip_height

    drawn = FOOT - math.sqrt(FOOT * FOOT - heel * heel)
    hip_x, hip_y = -side * TRACK_HALF_WIDTH * sin, side * TRACK_HALF_WIDTH * cos
    lowered = max(
        hip_too_high(
            place_x + hip_x - front[0], place_y + hip_y - front[1], height - front[2], _REACH
        ),
        hip_too_high(
            place_x - hip_x - rear[0] - drawn * math.cos(rear[3]),
            place_y - hip_y - rear[1] - drawn * math.sin(rear[3]),
            height - rear[2] - heel,
            _REACH,
        ),
    )
    return BothDown(
        rv,
        pace,
        place_x,
        place_y,
        speed * cos - _PACE * shifted * sin,
        speed * sin + _PACE * shifted * cos,
        yaw,
        _PACE * (front[3] - rear[3]),
        ground,
        lowered,
        hip_height,
        heel,
        strike * (1.0 - unevenness(front[2] - rear[2])),
    )


@inlined
def _found(poses: Poses, length: float) -> tuple[int, float]:
    """Row of a length in the table, and the share of the way to the next one."""
    after = int(np.searchsorted(poses.lengths, length))
    k = min(max(after, 1), len(poses.lengths) - 1) - 1
    return k, (length - poses.lengths[k]) / (poses.lengths[k + 1] - poses.lengths[k])


@inlined
def _at(poses: Poses, k: int, share: float, column: int) -> float:
    low = poses.rows[k, column]
    value: float = low + share * (poses.rows[k + 1, column] - low)
    return value


@inlined
def hermite(u: float, start: float, slope: float, end: float, end_slope: float) -> float:
    """Cubic from start to end with given slopes at u = 0 and 1."""
    rest = 1.0 - u
    return (
        (1.0 + 2.0 * u) * rest * rest * start
        + u * rest * rest * slope
        + (3.0 - 2.0 * u) * u * u * end
        - u * u * rest * end_slope
    )
