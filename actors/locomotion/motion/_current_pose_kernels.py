"""The drawn poses of bodies as keys of the steps that they begin, one body after the other."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.motion._key_pose_kernels import (
    ANKLE,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    fill_samples,
)
from esplanade.actors.locomotion.motion._leg_pose_kernels import (
    REACH,
    Placement,
    fill_leg_poses,
    new_leg_poses,
)
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.planted.footprints import HEADING, StepFootprints
from esplanade.planning.compiled.arrays import Bools, Floats
from esplanade.planning.compiled.jit import inlined, kernel

_BACK = 0.02
"""Share of a step over which the speed of the current pose is taken."""
_TURN = 2.0 * math.pi


class CurrentPose(NamedTuple):
    """The drawn poses of N bodies at one moment, as keys of the steps that they begin."""

    key: Floats
    """(N, WIDTH)."""
    speed: Floats
    """(N, WIDTH): its change in a tick."""


@inlined
def share_at(start: int, ticks: int, tick: int) -> float:
    """Share of a step that has elapsed at a tick, in [0, 1]; 1 of one that takes no time."""
    if ticks <= 0:
        return 1.0
    return min(max((tick - start) / ticks, 0.0), 1.0)


@kernel
def current_pose(old: Steps, tick: int, footprints: StepFootprints, swapped: Bools) -> CurrentPose:
    """The pose of N bodies at a tick, as keys of their next steps.

    `old` are the steps that are under way or were the last ones, `footprints` those of the next
    steps, and `swapped` (N,) says whether the feet change parts: the swing foot has landed and is
    the next standing foot.
    """
    count = len(swapped)
    share, before, foot_m = np.empty(count), np.empty(count), np.empty(count)
    for i in range(count):
        share[i] = share_at(old.start[i], old.ticks[i], tick)
        before[i] = max(share[i] - _BACK, 0.0)
        foot_m[i] = footprints.leg_m[i] * FOOT
    now, speed = np.empty((count, WIDTH)), np.empty((count, WIDTH))
    fill_samples(old.keys, old.landing, old.lift, share, foot_m, now)
    fill_samples(old.keys, old.landing, old.lift, before, foot_m, speed)
    legs = new_leg_poses(count)
    placement = Placement(
        old.on_right,
        old.standing,
        old.landing,
        old.lift,
        old.flight,
        old.keys,
        footprints.leg_m,
    )
    earlier = new_leg_poses(count)
    if np.any(old.flight > 0.0):
        fill_leg_poses(placement, before, speed, REACH, earlier)
    fill_leg_poses(placement, share, now, REACH, legs)
    for i in range(count):
        passed = (share[i] - before[i]) * old.ticks[i]
        # A body that stands, or has stood since its step ended, does not move.
        moving = passed > 0.0 and tick <= old.start[i] + old.ticks[i]
        for d in range(WIDTH):
            speed[i, d] = (now[i, d] - speed[i, d]) / passed if moving else 0.0
        # Feet as they are, which may be raised further than their curves say, and hips lower.
        swing = 0 if footprints.on_right[i] else 1
        for d in range(3):
            now[i, d] = legs.root[i, d] - footprints.standing[i, d]
            now[i, ANKLE + d] = legs.ankles[i, swing, d] - footprints.landing[i, d]
        now[i, SWING_PITCH] = legs.pitches[i, swing]
        now[i, STANDING_PITCH] = legs.pitches[i, 1 - swing]
        turned = legs.headings[i, swing] - footprints.landing[i, HEADING]
        now[i, SWING_HEADING] = (turned + math.pi) % _TURN - math.pi
        if swapped[i]:
            in_air = old.flight[i] > 0.0 and moving
            for d in range(3):
                moved = legs.ankles[i, swing, d] - earlier.ankles[i, swing, d]
                speed[i, ANKLE + d] = moved / passed if in_air else 0.0
            speed[i, SWING_HEADING] = 0.0
            swung = speed[i, SWING_PITCH]
            speed[i, SWING_PITCH] = speed[i, STANDING_PITCH]
            speed[i, STANDING_PITCH] = swung
    return CurrentPose(now, speed)
