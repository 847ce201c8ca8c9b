"""The hips during a planted step: their path, height, and how the pelvis turns.

The standing foot is the left one, its heel the origin, and it points along x; leg lengths.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from esplanade.actors.locomotion._gait_kernels import mix, pelvis, smooth, support_share
from esplanade.actors.locomotion._stairs_kernels import ground_under_way
from esplanade.actors.locomotion._turning_kernels import CROUCH, BothDown, hermite
from esplanade.actors.locomotion.skeleton import TRACK_HALF_WIDTH
from esplanade.planning.compiled.jit import inlined, kernel

_TURN = 2.0 * math.pi
_CREST = 0.35
"""The wave of the hips starts so far after its trough, as that of Boulic's pelvis does."""

_ASIDE = 0.15
"""Relative velocity of shifts that are no longer taken for a step ahead."""


class Hips(NamedTuple):
    """The body at one moment."""

    x: float
    """Of the root, with its sway."""
    y: float
    z: float
    yaw: float
    lean: float
    roll: float
    aside: tuple[float, float, float]
    """From the root to the joint of the standing (left) leg."""
    place: tuple[float, float]
    """Root without its sway; feet swing beside this."""
    way: float
    """Heading without the pelvis' own twist."""
    height: float
    """Of the root above level ground as the curves have it."""
    rv: float


@inlined
def lift_of(before: BothDown, after: BothDown) -> float:
    """When the toe leaves the ground: earlier when going aside or back, where no toe pushes off."""
    rv, pace = 0.5 * (before.rv + after.rv), 0.5 * (before.pace + after.pace)
    return (2.0 * support_share(pace) - 1.0) * (1.0 - 0.5 * smooth((pace - rv) / _ASIDE))


@kernel
def hips_at(before: BothDown, after: BothDown, u: float) -> Hips:
    s = smooth(u)
    rv = mix(before.rv, after.rv, s)
    x = hermite(u, before.x, before.speed_x, after.x, after.speed_x)
    y = hermite(u, before.y, before.speed_y, after.y, after.speed_y)
    way = hermite(u, before.yaw, before.turning, after.yaw, after.turning)
    sway, twist, lean, roll = pelvis(rv, u)
    wave = math.sin(_TURN * (u - _CREST)) + math.sin(_TURN * _CREST)
    height = mix(
        before.hip_height + 0.425 * (1.0 - CROUCH - before.hip_height) * wave,
        after.hip_height + 0.425 * (1.0 - CROUCH - after.hip_height) * wave,
        s,
    )
    ground = ground_under_way(before.ground, after.ground, u)
    yaw = way + twist
    cos, sin = math.cos(yaw), math.sin(yaw)
    left, up = TRACK_HALF_WIDTH * math.cos(roll), TRACK_HALF_WIDTH * math.sin(roll)
    ahead = up * math.sin(lean)
    return Hips(
        x - sway * math.sin(way),
        y + sway * math.cos(way),
        ground + height - mix(before.lowered, after.lowered, s),
        yaw,
        lean,
        roll,
        (ahead * cos - left * sin, ahead * sin + left * cos, up * math.cos(lean)),
        (x, y),
        way,
        height,
        rv,
    )
