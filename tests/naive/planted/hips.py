"""The hips during a planted step: their path, height, and how the pelvis turns.

Frame and units as in `planted`; arrays (N, K), those of a whole step (N, 1).
"""

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.curves import smooth, support_share
from esplanade.actors.locomotion.reference.body_curves import pelvis_motion
from esplanade.planning.compiled.arrays import Floats
from tests.naive.planted import stairs
from tests.naive.planted.double_support import (
    CROUCH,
    DoubleSupportPose,
    forward_and_left,
    hips_under_way,
)
from tests.naive.planted.flight import running_height

_CREST = 0.35
"""Share of a step from the trough of the hips' wave, as Boulic's pelvis has it."""

_ASIDE = 0.15
"""A shift whose relative velocity is above this is no longer taken for a step ahead."""


class Hips(NamedTuple):
    """Body at K shares of N steps."""

    root: Floats
    """(N, K, 3)."""
    yaw: Floats
    lean: Floats
    roll: Floats
    joint: Floats
    """(N, K, 3): from the root to the joint of the standing (left) leg."""
    unswayed: Floats
    """(N, K, 2): root without its sway; the swing foot passes beside it."""
    heading: Floats
    """(N, K): heading without the pelvis' own twist."""
    height: Floats
    """(N, K): of the root above level ground as the curves have it."""
    rv: Floats
    pace: Floats
    lift: Floats
    """(N, 1): share of the step after which the other foot leaves the ground; 0 after a flight."""
    runs: Floats
    """(N, K): weight of running against walking."""


def mix(before: Floats, after: Floats, share: Floats) -> Floats:
    """From before, at share 0, to after, at share 1."""
    mixed: Floats = before + (after - before) * share
    return mixed


def hips_at(before: DoubleSupportPose, after: DoubleSupportPose, u: Floats) -> Hips:
    """Hips at shares u (N, K) between two poses (N, 1)."""
    s = smooth(u)
    rv = mix(before.rv, after.rv, s)
    unswayed, heading = hips_under_way(before, after, u)
    motion = pelvis_motion(rv, 0.5 * u)
    _, left = forward_and_left(heading)
    level = unswayed + motion.left[..., None] * left
    runs = mix(1.0 * (before.flight > 0.0), 1.0 * (after.flight > 0.0), s)
    height = mix(_height(before, after, u), running_height(u), runs)
    lean = motion.lean + 0.07 * runs
    ground = stairs.ground_during_step(before.ground, after.ground, u)
    lowered = mix(before.lowered, after.lowered, s)
    yaw = heading + motion.yaw
    return Hips(
        root=np.concatenate([level, (ground + height - lowered)[..., None]], axis=-1),
        yaw=yaw,
        lean=lean,
        roll=motion.roll,
        joint=_joint(yaw, lean, motion.roll),
        unswayed=unswayed,
        heading=heading,
        height=height,
        rv=rv,
        pace=mix(before.pace, after.pace, s),
        lift=np.where(
            before.flight > 0.0,
            0.0,
            _lift(0.5 * (before.rv + after.rv), 0.5 * (before.pace + after.pace)),
        ),
        runs=runs,
    )


def _lift(rv: Floats, pace: Floats) -> Floats:
    """Share of the step at toe-off: it is earlier in steps aside or back, without a push-off."""
    aside = smooth((pace - rv) / _ASIDE)
    lift: Floats = (2.0 * support_share(pace) - 1.0) * (1.0 - 0.5 * aside)
    return lift


def _height(before: DoubleSupportPose, after: DoubleSupportPose, u: Floats) -> Floats:
    """Height above the ground, which is largest while the standing leg is upright."""
    turn = 2.0 * np.pi
    wave = np.sin(turn * (u - _CREST)) + np.sin(turn * _CREST)
    low, high = (
        pose.hip_height + 0.425 * (1.0 - CROUCH - pose.hip_height) * wave
        for pose in (before, after)
    )
    return mix(low, high, smooth(u))


def _joint(yaw: Floats, lean: Floats, roll: Floats) -> Floats:
    """From the root to the left hip joint, (..., 3)."""
    forward, left = forward_and_left(yaw)
    up = np.sin(roll)
    level = np.cos(roll)[..., None] * left + (up * np.sin(lean))[..., None] * forward
    height = (up * np.cos(lean))[..., None]
    aside: Floats = TRACK_HALF_WIDTH * np.concatenate([level, height], axis=-1)
    return aside
