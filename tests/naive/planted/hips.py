"""The hips during a planted step: their path, height, and how the pelvis turns.

Frame and units as in `planted`; arrays (N, K), those of a whole step (N, 1).
"""

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.curves import pelvis_motion, smooth, support_share
from esplanade.actors.locomotion.skeleton import TRACK_HALF_WIDTH, Floats
from tests.naive.planted import stairs
from tests.naive.planted.turning import CROUCH, BothDown, forward_and_left, hips_under_way

_CREST = 0.35
"""The wave of the hips starts so far after its trough, as that of Boulic's pelvis does."""

_ASIDE = 0.15
"""Relative velocity of shifts that are no longer taken for a step ahead."""


class Hips(NamedTuple):
    """Body at K shares of N steps."""

    root: Floats
    """(N, K, 3)."""
    yaw: Floats
    lean: Floats
    roll: Floats
    aside: Floats
    """(N, K, 3): from the root to the joint of the standing (left) leg."""
    place: Floats
    """(N, K, 2): root without its sway; feet swing beside this."""
    way: Floats
    """(N, K): heading without the pelvis' own twist."""
    height: Floats
    """(N, K): of the root above level ground as the curves have it."""
    rv: Floats
    pace: Floats
    lift: Floats
    """(N, 1): share of the step after which the other foot leaves the ground."""


def mix(before: Floats, after: Floats, share: Floats) -> Floats:
    """From before, at share 0, to after, at share 1."""
    mixed: Floats = before + (after - before) * share
    return mixed


def hips_at(before: BothDown, after: BothDown, u: Floats) -> Hips:
    """Hips at shares u (N, K) between two poses (N, 1)."""
    s = smooth(u)
    rv = mix(before.rv, after.rv, s)
    place, way = hips_under_way(before, after, u)
    motion = pelvis_motion(rv, 0.5 * u)
    _, left = forward_and_left(way)
    level = place + motion.left[..., None] * left
    height = _height(before, after, u)
    ground = stairs.ground_under_way(before.ground, after.ground, u)
    lowered = mix(before.lowered, after.lowered, s)
    yaw = way + motion.yaw
    return Hips(
        root=np.concatenate([level, (ground + height - lowered)[..., None]], axis=-1),
        yaw=yaw,
        lean=motion.lean,
        roll=motion.roll,
        aside=_aside(yaw, motion.lean, motion.roll),
        place=place,
        way=way,
        height=height,
        rv=rv,
        pace=mix(before.pace, after.pace, s),
        lift=_lift(0.5 * (before.rv + after.rv), 0.5 * (before.pace + after.pace)),
    )


def _lift(rv: Floats, pace: Floats) -> Floats:
    """When the toe leaves the ground: earlier when going aside or back, where no toe pushes off."""
    aside = smooth((pace - rv) / _ASIDE)
    lift: Floats = (2.0 * support_share(pace) - 1.0) * (1.0 - 0.5 * aside)
    return lift


def _height(before: BothDown, after: BothDown, u: Floats) -> Floats:
    """Above the ground: highest when the standing leg is upright, the same at both ends."""
    turn = 2.0 * np.pi
    wave = np.sin(turn * (u - _CREST)) + np.sin(turn * _CREST)
    low, high = (
        pose.hip_height + 0.425 * (1.0 - CROUCH - pose.hip_height) * wave
        for pose in (before, after)
    )
    return mix(low, high, smooth(u))


def _aside(yaw: Floats, lean: Floats, roll: Floats) -> Floats:
    """From the root to the left hip joint, (..., 3)."""
    forward, left = forward_and_left(yaw)
    up = np.sin(roll)
    level = np.cos(roll)[..., None] * left + (up * np.sin(lean))[..., None] * forward
    height = (up * np.cos(lean))[..., None]
    aside: Floats = TRACK_HALF_WIDTH * np.concatenate([level, height], axis=-1)
    return aside
