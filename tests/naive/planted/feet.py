"""Both feet during a planted step. Frame and units as in `planted`; arrays (N, K) and (N, 1)."""

from functools import cache
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH, foot_pitch, leg_points
from esplanade.actors.locomotion.gait.curves import joint_angles, smooth
from esplanade.actors.locomotion.gait.step_length import RV_LONGEST, sl_planted
from esplanade.planning.compiled.arrays import Floats
from tests.naive.planted import stairs
from tests.naive.planted.double_support import (
    DoubleSupportPose,
    ankle_over_toe,
    double_support_pose,
    forward_and_left,
)
from tests.naive.planted.flight import LAST_PITCH, flown, pushing_pitch, towed
from tests.naive.planted.hips import Hips, hips_at, mix
from tests.naive.planted.reach import FULL, drawn_to_hip, hip_ceiling, raised_heel

_AT_ENDS = 0.04
"""Share of a step at its ends in which the footprint alone says where a foot is."""

_TABLE_SIDE = 26
_SPARE = 0.004
_LOWEST = 0.03
_MOVES_FROM = 0.1


class Foot(NamedTuple):
    """A foot at K shares of N steps: ankle (N, K, 3), pitch (N, K), heading (N, K)."""

    ankle: Floats
    pitch: Floats
    heading: Floats


def standing_foot(
    before: DoubleSupportPose, after: DoubleSupportPose, hips: Hips, u: Floats
) -> Foot:
    """The standing foot: it rolls from its heel to the flat sole and rises on its toe.

    Where the leg is too short, the heel rises more.
    """
    down = before.strike * (1.0 - smooth(u / 0.2))
    up = np.arcsin(after.heel * smooth((u - 0.55) / 0.45) / FOOT)
    flight = np.broadcast_to(after.flight, u.shape)
    pitch = down - np.where(flight > 0.0, pushing_pitch(u, flight), up)
    footprint = np.zeros((*u.shape, 4))
    way = towed(after.place - before.place, after.flight)
    footprint[..., :3] = flown(u, flight)[..., None] ** 2 * way
    toe = footprint[..., :3].copy()
    toe[..., 0] += FOOT
    raised = raised_heel(hips.root + hips.joint, toe, footprint[..., 3], pitch)
    pitch = np.where(pitch > 0.0, pitch, mix(pitch, raised, smooth(u / _AT_ENDS)))
    return Foot(ankle_over_toe(footprint, np.minimum(pitch, 0.0)), pitch, footprint[..., 3])


def swing_foot(
    before: DoubleSupportPose,
    after: DoubleSupportPose,
    lifted: Floats,
    landing: Floats,
    hips: Hips,
    u: Floats,
    raise_by: Floats,
) -> Foot:
    """The swing foot: on its toe until toe-off, then along the curves, then down on its footprint.

    lifted and landing are footprints (N, 1, 4); raise_by (N, 1) comes from `clearance`.
    """
    swung = _swung(hips, u)
    ground = lifted[..., 2]
    flight = before.flight[..., None]
    way = towed(-lifted[..., :2], before.flight)
    way = np.concatenate([way, np.zeros_like(flight)], axis=-1)
    lifted = np.where(flight > 0.0, lifted + way, lifted)
    pinned, angles = _pinned_foot(before, lifted, hips, u)
    under = mix(ground, landing[..., 2], smooth(swung))
    level = _level_swing(after, pinned, angles, under, landing, hips, u)
    height = level.ankle[..., 2] + raise_by * _bump(swung)
    level.ankle[..., 2] = np.maximum(height, under + _needed(level.pitch))

    top = np.maximum(np.maximum(ground, landing[..., 2]), 0.0)
    bottom = np.minimum(np.minimum(ground, landing[..., 2]), 0.0)
    uneven = stairs.unevenness(top - bottom)
    over = stairs.swing_over(pinned.ankle, landing[..., :3], top, swung)
    ankle = mix(level.ankle, over, uneven[..., None])
    in_reach = drawn_to_hip(hips.root - hips.joint, ankle)
    free = smooth(swung / 0.1) * (1.0 - smooth((u - 1.0 + _AT_ENDS) / _AT_ENDS))
    return Foot(
        mix(ankle, in_reach, free[..., None]),
        mix(level.pitch, mix(pinned.pitch, after.strike, smooth(swung / 0.5)), uneven),
        mix(lifted[..., 3], landing[..., 3], smooth(swung)),
    )


def lowered_to(hips: Hips, standing: Foot, swing: Foot) -> Floats:
    """Root (N, K, 3), lower where the leg of a foot on the ground would still be too short."""
    root = hips.root.copy()
    hip = root + hips.joint
    root[..., 2] -= np.maximum(hip[..., 2] - hip_ceiling(hip, standing.ankle, FULL), 0.0)
    hip = root - hips.joint
    root[..., 2] -= np.maximum(hip[..., 2] - hip_ceiling(hip, swing.ankle, FULL), 0.0)
    return root


def clearance(
    before: DoubleSupportPose, after: DoubleSupportPose, lifted: Floats, landing: Floats
) -> Floats:
    """The height that a foot is lifted beyond the curves to clear the ground, (N, 1).

    Feet that hardly move are hardly raised.
    """
    table = _clearance_table()
    spacing = RV_LONGEST / (_TABLE_SIDE - 1)
    row, column = before.rv / spacing, after.rv / spacing
    i = np.minimum(row.astype(np.intp), _TABLE_SIDE - 2)
    j = np.minimum(column.astype(np.intp), _TABLE_SIDE - 2)
    needed = mix(
        mix(table[i, j], table[i + 1, j], row - i),
        mix(table[i, j + 1], table[i + 1, j + 1], row - i),
        column - j,
    )
    moved = np.hypot(landing[..., 0] - lifted[..., 0], landing[..., 1] - lifted[..., 1])
    moved = moved + FOOT * np.abs(landing[..., 3] - lifted[..., 3])
    return np.maximum(needed, _LOWEST) * smooth(moved / _MOVES_FROM)


def _swung(hips: Hips, u: Floats) -> Floats:
    """Share of the time in the air, (N, K)."""
    share: Floats = np.maximum((u - hips.lift) / (1.0 - hips.lift), 0.0)
    return share


def _needed(pitch: Floats) -> Floats:
    """Height of an ankle above the ground whose toe just touches it."""
    height: Floats = FOOT * np.maximum(-np.sin(pitch), 0.0)
    return height


def _bump(swung: Floats) -> Floats:
    shape: Floats = smooth(swung / 0.3) * (1.0 - smooth((swung - 0.5) / 0.5))
    return shape


def _pinned_foot(
    before: DoubleSupportPose, lifted: Floats, hips: Hips, u: Floats
) -> tuple[Foot, Floats]:
    """The swing foot as if its toe stayed down, and angles (N, K, 3) of its leg by the curves."""
    angles = joint_angles(hips.rv, 0.5 + 0.5 * u)
    to_lift = u / np.where(hips.lift > 0.0, hips.lift, 1.0)
    pitch = mix(-np.arcsin(before.heel / FOOT), foot_pitch(angles), smooth(to_lift))
    footprint = np.broadcast_to(lifted, (*u.shape, 4))
    toe = footprint[..., :3].copy()
    toe[..., :2] += FOOT * forward_and_left(footprint[..., 3])[0]
    pitch = raised_heel(hips.root - hips.joint, toe, footprint[..., 3], pitch)
    pitch = np.where(before.flight > 0.0, -LAST_PITCH, pitch)
    return Foot(ankle_over_toe(footprint, pitch), pitch, footprint[..., 3]), angles


def _level_swing(
    after: DoubleSupportPose,
    pinned: Foot,
    angles: Floats,
    under: Floats,
    landing: Floats,
    hips: Hips,
    u: Floats,
) -> Foot:
    """The swing foot on level ground: from its toe it comes over to the curves, then lands.

    under (N, K) is the height of the ground below the foot.
    """
    _, heel, _ = leg_points(angles)
    forward, left = forward_and_left(hips.heading)
    level = hips.unswayed + heel[..., :1] * forward - TRACK_HALF_WIDTH * left
    height = under + hips.height + heel[..., 1]
    curve = np.concatenate([level, height[..., None]], axis=-1)
    release = smooth((u - hips.lift) / 0.35)
    settle = smooth((u - 0.7) / 0.3)
    ankle = mix(pinned.ankle, curve, release[..., None])
    pitch = mix(pinned.pitch, foot_pitch(angles), release)
    return Foot(
        mix(ankle, landing[..., :3], settle[..., None]),
        mix(pitch, after.strike, settle),
        pinned.heading,
    )


@cache
def _clearance_table() -> Floats:
    """The lifts that straight steps need on level ground, by relative velocities at both ends.

    (_TABLE_SIDE, _TABLE_SIDE), leg lengths: the largest that any moment of a step asks for.
    """
    rv = np.linspace(0.0, RV_LONGEST, _TABLE_SIDE)
    first, last = (axis.reshape(-1, 1) for axis in np.meshgrid(rv, rv, indexing="ij"))
    lifted, landing = np.zeros((2, *first.shape, 4))
    lifted[..., 1] = landing[..., 1] = -2.0 * TRACK_HALF_WIDTH
    lifted[..., 0], landing[..., 0] = -sl_planted(first), sl_planted(last)
    here = np.zeros_like(lifted)
    one = np.ones_like(first)
    before, after = double_support_pose(lifted, here, one), double_support_pose(here, landing, -one)
    u = np.broadcast_to(np.linspace(0.4, 0.99, 60), (len(first), 60))
    hips = hips_at(before, after, u)
    pinned, angles = _pinned_foot(before, lifted, hips, u)
    swing = _level_swing(after, pinned, angles, np.zeros_like(u), landing, hips, u)
    bump = _bump(_swung(hips, u))
    short = _needed(swing.pitch) + _SPARE * bump - swing.ankle[..., 2]
    lift = np.where(bump > 0.02, short / np.maximum(bump, 0.02), 0.0).max(axis=1)
    table: Floats = lift.reshape(_TABLE_SIDE, _TABLE_SIDE)
    return table
