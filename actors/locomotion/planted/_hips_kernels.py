"""The hips during a planted step: their path, their height, and how the pelvis turns.

Everything is in the frame of the standing foot, which is taken for the left one: its heel is the
origin, and it points along x. Lengths are shares of the leg's.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait._curve_kernels import mix, pelvis, smooth, support_share
from esplanade.actors.locomotion.planted._double_support_kernels import (
    CROUCH,
    DoubleSupportPose,
    hermite,
)
from esplanade.actors.locomotion.planted._flight_kernels import running_height
from esplanade.actors.locomotion.planted._stairs_kernels import ground_during_step
from esplanade.planning.compiled.jit import inlined, kernel

_TURN = 2.0 * math.pi
_CREST = 0.35
"""Share of a step from the trough of the hips' wave, as Boulic's pelvis has it."""

_FORWARD = 0.07
"""A runner leans forward by this more than a walker, radians."""

_ASIDE = 0.15
"""A shift whose relative velocity is above this is no longer taken for a step ahead."""


class Hips(NamedTuple):
    """Hips and pelvis at one moment; leg lengths and radians."""

    x: float
    """Place of the root, with its sway."""
    y: float
    z: float
    yaw: float
    lean: float
    roll: float
    joint: tuple[float, float, float]
    """Vector from the root to the hip joint of the standing (left) leg; the other lies opposite."""
    unswayed: tuple[float, float]
    """Place of the root on the map without its sway; the swing foot passes beside it."""
    heading: float
    """Heading of the pelvis without its own twist."""
    height: float
    """Height of the root above level ground by the curves."""
    rv: float
    """Relative velocity at this moment."""


@inlined
def lift_of(before: DoubleSupportPose, after: DoubleSupportPose) -> float:
    """Share of the step at toe-off: it is earlier in steps aside or back, without a push-off.

    After a flight the foot is in the air from the beginning.
    """
    if before.flight > 0.0:
        return 0.0
    rv, pace = 0.5 * (before.rv + after.rv), 0.5 * (before.pace + after.pace)
    return (2.0 * support_share(pace) - 1.0) * (1.0 - 0.5 * smooth((pace - rv) / _ASIDE))


@inlined
def running(before: DoubleSupportPose, after: DoubleSupportPose, u: float) -> float:
    """Weight of running against walking, 0 to 1, at a share of the step between two poses."""
    return mix(1.0 if before.flight > 0.0 else 0.0, 1.0 if after.flight > 0.0 else 0.0, smooth(u))


@kernel
def hips_at(before: DoubleSupportPose, after: DoubleSupportPose, u: float) -> Hips:
    """Hips at a share of the step from one pose to the next."""
    s = smooth(u)
    rv = mix(before.rv, after.rv, s)
    x = hermite(u, before.x, before.speed_x, after.x, after.speed_x)
    y = hermite(u, before.y, before.speed_y, after.y, after.speed_y)
    heading = hermite(u, before.yaw, before.turning, after.yaw, after.turning)
    sway, twist, lean, roll = pelvis(rv, u)
    wave = math.sin(_TURN * (u - _CREST)) + math.sin(_TURN * _CREST)
    height = mix(
        before.hip_height + 0.425 * (1.0 - CROUCH - before.hip_height) * wave,
        after.hip_height + 0.425 * (1.0 - CROUCH - after.hip_height) * wave,
        s,
    )
    runs = running(before, after, u)
    height = mix(height, running_height(u), runs)
    lean += _FORWARD * runs
    ground = ground_during_step(before.ground, after.ground, u)
    yaw = heading + twist
    cos, sin = math.cos(yaw), math.sin(yaw)
    left, up = TRACK_HALF_WIDTH * math.cos(roll), TRACK_HALF_WIDTH * math.sin(roll)
    ahead = up * math.sin(lean)
    return Hips(
        x - sway * math.sin(heading),
        y + sway * math.cos(heading),
        ground + height - mix(before.lowered, after.lowered, s),
        yaw,
        lean,
        roll,
        (ahead * cos - left * sin, ahead * sin + left * cos, up * math.cos(lean)),
        (x, y),
        heading,
        height,
        rv,
    )
