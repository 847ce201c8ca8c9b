"""Both feet during a planted step, one moment at a time; frame and units as in `_hips_kernels`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, SHIN, THIGH, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait._curve_kernels import mix, smooth, swing_leg
from esplanade.actors.locomotion.gait.step_length import RV_LONGEST, PoseTable
from esplanade.actors.locomotion.planted._double_support_kernels import (
    DoubleSupportPose,
    double_support_pose,
)
from esplanade.actors.locomotion.planted._flight_kernels import (
    LAST_PITCH,
    flown,
    pushing_pitch,
    towed,
)
from esplanade.actors.locomotion.planted._hips_kernels import Hips, hips_at, lift_of
from esplanade.actors.locomotion.planted._reach_kernels import (
    FULL,
    excess_height,
    raised_heel,
    soft_reach,
)
from esplanade.actors.locomotion.planted._stairs_kernels import swing_over, unevenness
from esplanade.actors.locomotion.planted.footprints import Footprint
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined, kernel

_AT_ENDS = 0.04
"""Share of a step at its ends in which the footprint alone says where a foot is."""

_SPARE = 0.004
"""Clearance of a swing foot where it comes nearest to the ground."""

_LOWEST = 0.03
"""Feet that move are raised by at least this beyond the curves."""

_MOVES_FROM = 0.1
"""Feet that move less than this are raised less."""


class Foot(NamedTuple):
    """A foot at one moment."""

    x: float
    """Place of the ankle."""
    y: float
    z: float
    pitch: float
    """Positive with the toe up."""


@inlined
def _ankle_over_toe(footprint: Footprint, pitch: float) -> tuple[float, float, float]:
    """Ankle of a foot that is pitched about its toe, which keeps to the footprint."""
    heel_forward = FOOT * (1.0 - math.cos(pitch))
    return (
        footprint.x + heel_forward * math.cos(footprint.heading),
        footprint.y + heel_forward * math.sin(footprint.heading),
        footprint.z - FOOT * math.sin(pitch),
    )


@inlined
def _reaching_pitch(hips: Hips, side: float, footprint: Footprint, pitch: float) -> float:
    """Pitch of a foot on its toe at which its leg reaches the ankle.

    `side` is 1 for the standing leg, else -1.
    """
    cos, sin = math.cos(footprint.heading), math.sin(footprint.heading)
    x = hips.x + side * hips.joint[0] - footprint.x - FOOT * cos
    y = hips.y + side * hips.joint[1] - footprint.y - FOOT * sin
    up = hips.z + side * hips.joint[2] - footprint.z
    return raised_heel(x * cos + y * sin, y * cos - x * sin, up, pitch)


@kernel
def standing_foot(
    before: DoubleSupportPose, after: DoubleSupportPose, hips: Hips, u: float
) -> Foot:
    """The standing foot: it rolls from its heel to the flat sole and rises on its toe.

    Where the leg is too short, the heel rises more. At the end of a step with a flight the toe
    pushes off and comes along.
    """
    down = before.strike * (1.0 - smooth(u / 0.2))
    pitch = down - math.asin(after.heel * smooth((u - 0.55) / 0.45) / FOOT)
    here = Footprint(0.0, 0.0, 0.0, 0.0)
    if after.flight > 0.0:
        pitch = down - pushing_pitch(u, after.flight)
        x, y, z = towed(after.x - before.x, after.y - before.y, after.flight)
        over = flown(u, after.flight) ** 2
        here = Footprint(over * x, over * y, over * z, 0.0)
    if pitch <= 0.0:
        pitch = mix(pitch, _reaching_pitch(hips, 1.0, here, pitch), smooth(u / _AT_ENDS))
    x, y, z = _ankle_over_toe(here, min(pitch, 0.0))
    return Foot(x, y, z, pitch)


@inlined
def _pinned_pitch(
    before: DoubleSupportPose,
    lifted: Footprint,
    hips: Hips,
    u: float,
    lift: float,
    by_curves: float,
) -> float:
    """Pitch of the swing foot as if its toe stayed where it was."""
    if before.flight > 0.0:
        return -LAST_PITCH
    pitch = mix(-math.asin(before.heel / FOOT), by_curves, smooth(u / lift))
    return _reaching_pitch(hips, -1.0, lifted, pitch)


@inlined
def _bump(swung: float) -> float:
    """Weight of the clearance, 0 to 1, at a share of the swing."""
    return smooth(swung / 0.3) * (1.0 - smooth((swung - 0.5) / 0.5))


@inlined
def _level_swing(
    pinned: Foot,
    under: float,
    landing: Footprint,
    strike: float,
    hips: Hips,
    u: float,
    lift: float,
) -> Foot:
    """The swing foot on level ground: from its toe it comes over to the curves, then lands.

    `pinned` is the foot as if its toe stayed down, `under` the height of the ground below it, and
    `strike` its pitch at the landing.
    """
    hip, knee, ankle = swing_leg(hips.rv, u)
    ahead = THIGH * math.sin(hip) + SHIN * math.sin(hip - knee)
    below = THIGH * math.cos(hip) + SHIN * math.cos(hip - knee)
    cos, sin = math.cos(hips.heading), math.sin(hips.heading)
    release, settle = smooth((u - lift) / 0.35), smooth((u - 0.7) / 0.3)
    x = mix(pinned.x, hips.unswayed[0] + ahead * cos + TRACK_HALF_WIDTH * sin, release)
    y = mix(pinned.y, hips.unswayed[1] + ahead * sin - TRACK_HALF_WIDTH * cos, release)
    z = mix(pinned.z, under + hips.height - below, release)
    pitch = mix(pinned.pitch, hip - knee + ankle, release)
    return Foot(
        mix(x, landing.x, settle),
        mix(y, landing.y, settle),
        mix(z, landing.z, settle),
        mix(pitch, strike, settle),
    )


@kernel
def swing_foot(
    before: DoubleSupportPose,
    after: DoubleSupportPose,
    lifted: Footprint,
    landing: Footprint,
    hips: Hips,
    u: float,
    lift: float,
    raise_by: float,
) -> Foot:
    """The swing foot: on its toe until toe-off, then along the curves, then down on its footprint.

    `lift` is the share of toe-off, `raise_by` the height added to the curves. After a flight the
    foot comes from where it was in the air.
    """
    ground = lifted.z
    if before.flight > 0.0:
        x, y, z = towed(-lifted.x, -lifted.y, before.flight)
        lifted = Footprint(lifted.x + x, lifted.y + y, lifted.z + z, lifted.heading)
    hip, knee, ankle = swing_leg(hips.rv, u)
    pitch = _pinned_pitch(before, lifted, hips, u, lift, hip - knee + ankle)
    pinned_at = _ankle_over_toe(lifted, pitch)
    pinned = Foot(pinned_at[0], pinned_at[1], pinned_at[2], pitch)
    swung = max((u - lift) / (1.0 - lift), 0.0)
    if swung <= 0.0:
        return pinned
    under = mix(ground, landing.z, smooth(swung))
    level = _level_swing(pinned, under, landing, after.strike, hips, u, lift)
    floor = under + FOOT * max(-math.sin(level.pitch), 0.0)
    height = max(level.z + raise_by * _bump(swung), floor)

    top = max(ground, landing.z, 0.0)
    uneven = unevenness(top - min(ground, landing.z, 0.0))
    over = swing_over(pinned_at, landing, top, swung)
    x, y = mix(level.x, over[0], uneven), mix(level.y, over[1], uneven)
    z = mix(height, over[2], uneven)
    flat = mix(pitch, after.strike, smooth(swung / 0.5))

    hip_x, hip_y = hips.x - hips.joint[0], hips.y - hips.joint[1]
    hip_z = hips.z - hips.joint[2]
    distance = math.sqrt((x - hip_x) ** 2 + (y - hip_y) ** 2 + (z - hip_z) ** 2)
    free = smooth(swung / 0.1) * (1.0 - smooth((u - 1.0 + _AT_ENDS) / _AT_ENDS))
    shrunk = mix(1.0, soft_reach(distance) / max(distance, 1e-9), free)
    return Foot(
        mix(hip_x, x, shrunk),
        mix(hip_y, y, shrunk),
        mix(hip_z, z, shrunk),
        mix(level.pitch, flat, uneven),
    )


@inlined
def hip_drop(hips: Hips, standing: Foot, swing: Foot) -> float:
    """The depth by which the hips must come down for both legs to reach their feet."""
    x, y, z = hips.joint
    down = excess_height(
        hips.x + x - standing.x, hips.y + y - standing.y, hips.z + z - standing.z, FULL
    )
    return down + excess_height(
        hips.x - x - swing.x, hips.y - y - swing.y, hips.z - down - z - swing.z, FULL
    )


@kernel
def clearance(
    before: DoubleSupportPose,
    after: DoubleSupportPose,
    lifted: Footprint,
    landing: Footprint,
    table: Floats,
) -> float:
    """The height by which a swing foot is raised beyond the curves so that it clears the ground.

    `table` was written by `fill_clearances`. Feet that hardly move are hardly raised.
    """
    last = len(table) - 1
    row, column = before.rv / RV_LONGEST * last, after.rv / RV_LONGEST * last
    i, j = min(int(row), last - 1), min(int(column), last - 1)
    needed = mix(
        mix(table[i, j], table[i + 1, j], row - i),
        mix(table[i, j + 1], table[i + 1, j + 1], row - i),
        column - j,
    )
    moved = math.hypot(landing.x - lifted.x, landing.y - lifted.y)
    moved += FOOT * abs(landing.heading - lifted.heading)
    return max(needed, _LOWEST) * smooth(moved / _MOVES_FROM)


@kernel
def fill_clearances(lengths: Floats, poses: PoseTable, table: Floats) -> None:
    """Write the heights to raise straight steps on level ground by, by their lengths at both ends.

    `lengths` is (M,), `table` (M, M), in leg lengths. Each value is the largest that any of 60
    moments of a step asks for.
    """
    aside = -2.0 * TRACK_HALF_WIDTH
    here = Footprint(0.0, 0.0, 0.0, 0.0)
    for i in range(len(lengths)):
        for j in range(len(lengths)):
            lifted = Footprint(-lengths[i], aside, 0.0, 0.0)
            landing = Footprint(lengths[j], aside, 0.0, 0.0)
            before = double_support_pose(lifted, here, 1.0, poses)
            after = double_support_pose(here, landing, -1.0, poses)
            lift = lift_of(before, after)
            table[i, j] = 0.0
            for u in np.linspace(0.4, 0.99, 60):
                bump = _bump((u - lift) / (1.0 - lift))
                if bump <= 0.02:
                    continue
                hips = hips_at(before, after, u)
                hip, knee, ankle = swing_leg(hips.rv, u)
                pitch = _pinned_pitch(before, lifted, hips, u, lift, hip - knee + ankle)
                x, y, z = _ankle_over_toe(lifted, pitch)
                foot = _level_swing(Foot(x, y, z, pitch), 0.0, landing, after.strike, hips, u, lift)
                short = FOOT * max(-math.sin(foot.pitch), 0.0) - foot.z
                table[i, j] = max(table[i, j], short / bump + _SPARE)
