"""Keys of steps that go on from the current pose, one step after the other."""

from __future__ import annotations

import math

import numpy as np

from esplanade.actors.locomotion.gait._curve_kernels import smooth
from esplanade.actors.locomotion.motion._current_pose_kernels import CurrentPose
from esplanade.actors.locomotion.motion._key_pose_kernels import (
    ANKLE,
    ARMS,
    CHEST,
    KEYS,
    PELVIS,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    make_unit,
)
from esplanade.actors.locomotion.planted._step_kernels import GaitTables, fill_targets
from esplanade.actors.locomotion.planted.footprints import HEADING, StepFootprints, Z
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from esplanade.planning.compiled.jit import inlined, kernel

MOST_FLOWN = 63.0 / 128.0
"""A record says at most that this share of its step is flown."""

_TURN = 2.0 * math.pi
_SHARES = np.linspace(0.0, 1.0, KEYS)

# A foot that stands lower than the other one leaves the ground earlier: lengths in legs.
_LEVEL = 0.15
"""Up to this rise the lower foot leaves as on level ground."""
_STEEP = 0.35
"""From this rise on the lower foot leaves earliest."""
_EARLIER = 0.7
"""Share of the usual time to toe-off that is then left out."""


@inlined
def _write_rotation(out: Floats, first: int, yaw: float, lean: float, roll: float) -> None:
    """Write the quaternion of Rz(yaw) Ry(lean) Rx(roll) to four numbers from the first on."""
    cz, cy, cx = math.cos(0.5 * yaw), math.cos(0.5 * lean), math.cos(0.5 * roll)
    sz, sy, sx = math.sin(0.5 * yaw), math.sin(0.5 * lean), math.sin(0.5 * roll)
    out[first] = cz * cy * cx + sz * sy * sx
    out[first + 1] = cz * cy * sx - sz * sy * cx
    out[first + 2] = cz * sy * cx + sz * cy * sx
    out[first + 3] = sz * cy * cx - cz * sy * sx


@kernel
def fill_keys(targets: Targets, footprints: StepFootprints, keys: Floats) -> None:
    """Write the keys (N, K, WIDTH) of targets at K shares of N steps."""
    last = keys.shape[1] - 1
    for i in range(len(keys)):
        heading = footprints.landing[i, HEADING]
        heading += _TURN * round((targets.swing_heading[i, last] - heading) / _TURN)
        for k in range(keys.shape[1]):
            key = keys[i, k]
            for d in range(3):
                key[d] = targets.root[i, k, d] - footprints.standing[i, d]
                key[ANKLE + d] = targets.swing_ankle[i, k, d] - footprints.landing[i, d]
            _write_rotation(key, PELVIS, targets.yaw[i, k], targets.lean[i, k], targets.roll[i, k])
            key[SWING_PITCH] = targets.swing_pitch[i, k]
            key[STANDING_PITCH] = targets.standing_pitch[i, k]
            key[SWING_HEADING] = targets.swing_heading[i, k] - heading
            # The back makes up for the pelvis' roll: shoulders and head stay level.
            c, s = math.cos(0.5 * targets.roll[i, k]), -math.sin(0.5 * targets.roll[i, k])
            ct, st = math.cos(0.5 * targets.torsion[i, k]), math.sin(0.5 * targets.torsion[i, k])
            key[CHEST], key[CHEST + 1] = c * ct, s * ct
            key[CHEST + 2], key[CHEST + 3] = -s * st, c * st
            for side in range(2):
                key[ARMS + side] = targets.shoulders[i, k, side]
                key[ARMS + 2 + side] = targets.elbows[i, k, side]


@kernel
def inertialise(
    keys: Floats,
    first: Floats,
    speed: Floats,
    re_aimed: Bools,
    from_air: Bools,
    ticks: Ints,
    aside: Floats,
) -> None:
    """Bend keys (N, KEYS, WIDTH) so that they begin with the current pose and end aside, (N, 2).

    The current pose is first (N, WIDTH), and speed (N, WIDTH) its change in a tick: its difference
    to key 0 fades over the step. The slope at key 0 is that of the parabola through the first three
    keys. Feet that have just changed parts are left to their paths: one rests on its toe, the other
    one rolls onto its sole; after a flight (`from_air`, (N,)) the one goes on as it is moving.
    Signs of quaternions in first and speed may be changed.
    """
    missing = np.empty(WIDTH)
    for i in range(len(keys)):
        for part in (PELVIS, CHEST):
            dot = 0.0
            for d in range(part, part + 4):
                dot += first[i, d] * keys[i, 0, d]
            if dot < 0.0:
                for d in range(part, part + 4):
                    first[i, d] *= -1.0
                    speed[i, d] *= -1.0
        for d in range(WIDTH):
            missing[d] = first[i, d] - keys[i, 0, d]
        missing[SWING_HEADING] -= _TURN * round(missing[SWING_HEADING] / _TURN)
        for k in range(KEYS):
            share = smooth(k / (KEYS - 1.0))
            for d in range(WIDTH):
                keys[i, k, d] += (1.0 - share) * missing[d]
            keys[i, k, 0] += share * aside[i, 0]
            keys[i, k, 1] += share * aside[i, 1]
        for d in range(WIDTH):
            foot = ANKLE <= d <= SWING_HEADING
            flies = from_air[i] and d <= SWING_PITCH
            if re_aimed[i] or flies or not foot:
                slope = speed[i, d] * ticks[i] / (KEYS - 1.0)
                keys[i, 1, d] = 0.25 * (2.0 * slope + 3.0 * keys[i, 0, d] + keys[i, 2, d])
        for k in range(KEYS):
            make_unit(keys[i, k], PELVIS)
            make_unit(keys[i, k], CHEST)


@kernel
def _new_targets(count: int) -> Targets:
    """Targets at the keys of N = `count` steps that are yet to be written."""
    return Targets(
        np.empty((count, KEYS, 3)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS, 3)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS)),
        np.empty((count, KEYS, 2)),
        np.empty((count, KEYS, 2)),
        np.empty(count),
        np.empty(count),
    )


@kernel
def _lift_early(
    footprints: StepFootprints, share: Floats, tables: GaitTables, targets: Targets
) -> None:
    """Let swing feet leave a lower tread early, in targets at shares (N, KEYS); in place.

    Otherwise such a foot would hold the hips down, which then had to jump.
    """
    early = _new_targets(1)
    warped = np.empty((1, KEYS))
    for i in range(len(share)):
        climbed = (footprints.standing[i, Z] - footprints.lifted[i, Z]) / footprints.leg_m[i]
        if climbed <= _LEVEL:
            continue
        usual = targets.lift[i]
        lift = usual * (1.0 - _EARLIER * smooth((climbed - _LEVEL) / (_STEEP - _LEVEL)))
        for k in range(KEYS):
            swung = usual + (share[i, k] - lift) * (1.0 - usual) / (1.0 - lift)
            warped[0, k] = share[i, k] * usual / lift if share[i, k] < lift else swung
        one = StepFootprints(
            footprints.on_right[i : i + 1],
            footprints.lifted[i : i + 1],
            footprints.standing[i : i + 1],
            footprints.landing[i : i + 1],
            footprints.leg_m[i : i + 1],
        )
        fill_targets(one, warped, tables.poses, tables.clearances, early)
        targets.swing_ankle[i] = early.swing_ankle[0]
        targets.swing_pitch[i] = early.swing_pitch[0]
        targets.swing_heading[i] = early.swing_heading[0]
        targets.lift[i] = lift


@kernel
def fill_step_keys(
    footprints: StepFootprints,
    elapsed: Floats,
    now: CurrentPose,
    ticks: Ints,
    hips: Floats,
    room_m: Floats,
    tables: GaitTables,
    keys: Floats,
    lift: Floats,
    flight: Floats,
) -> None:
    """Write the keys (N, KEYS, WIDTH), toe-offs and flights (N,) of the rest of N steps.

    They begin with the current pose in value and speed. `elapsed` (N,), in [0, 1), is the share of
    each step that is over already, 0 for steps that begin; the steps take `ticks` (N,) from now on.
    The hips should be at places `hips` (N, 2) at the end, metres, and may be for that as far as
    `room_m` (N,) from where the footprints have them.
    """
    count = len(elapsed)
    share = np.empty((count, KEYS))
    for i in range(count):
        for k in range(KEYS):
            share[i, k] = elapsed[i] + (1.0 - elapsed[i]) * _SHARES[k]
    targets = _new_targets(count)
    fill_targets(footprints, share, tables.poses, tables.clearances, targets)
    _lift_early(footprints, share, tables, targets)
    fill_keys(targets, footprints, keys)
    aside = np.empty((count, 2))
    re_aimed, from_air = np.empty(count, np.bool_), np.empty(count, np.bool_)
    for i in range(count):
        x = hips[i, 0] - footprints.standing[i, 0] - keys[i, KEYS - 1, 0]
        y = hips[i, 1] - footprints.standing[i, 1] - keys[i, KEYS - 1, 1]
        distance = max(math.hypot(x, y), 1e-9)
        within = min(distance, room_m[i]) / distance
        aside[i, 0], aside[i, 1] = x * within, y * within
        re_aimed[i], from_air[i] = elapsed[i] > 0.0, targets.lift[i] <= 0.0
        flight[i] = min(targets.flight[i] / (1.0 - elapsed[i]), MOST_FLOWN)
        left = (targets.lift[i] - elapsed[i]) / (1.0 - elapsed[i])
        lift[i] = min(max(left, 0.0), 1.0)
    inertialise(keys, now.key, now.speed, re_aimed, from_air, ticks, aside)


@kernel
def fill_shift_keys(
    now: CurrentPose, footprints: StepFootprints, places: Floats, keys: Floats
) -> None:
    """Write the keys (N, KEYS, WIDTH) of bodies on both feet whose hips go to places (N, 2)."""
    for i in range(len(keys)):
        for k in range(KEYS):
            share = smooth(_SHARES[k])
            for d in range(WIDTH):
                keys[i, k, d] = now.key[i, d]
            for d in range(2):
                shift = places[i, d] - footprints.standing[i, d] - now.key[i, d]
                keys[i, k, d] += share * shift
            for d in range(3):
                keys[i, k, ANKLE + d] = 0.0
