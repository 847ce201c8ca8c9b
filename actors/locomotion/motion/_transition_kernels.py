"""Keys of steps that go on from the current pose, one step after the other."""

from __future__ import annotations

import math

import numpy as np

from esplanade.actors.locomotion.gait._curve_kernels import smooth
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
from esplanade.actors.locomotion.planted.footprints import HEADING, StepFootprints
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from esplanade.planning.compiled.jit import inlined, kernel

_TURN = 2.0 * math.pi


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
    ticks: Ints,
    aside: Floats,
) -> None:
    """Bend keys (N, KEYS, WIDTH) so that they begin with the current pose and end aside, (N, 2).

    The current pose is first (N, WIDTH), and speed (N, WIDTH) its change in a tick: its difference
    to key 0 fades over the step. The slope at key 0 is that of the parabola through the first three
    keys. Feet that have just changed parts are left to their paths: one rests on its toe, the other
    one rolls onto its sole. Signs of quaternions in first and speed may be changed.
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
            if re_aimed[i] or not foot:
                slope = speed[i, d] * ticks[i] / (KEYS - 1.0)
                keys[i, 1, d] = 0.25 * (2.0 * slope + 3.0 * keys[i, 0, d] + keys[i, 2, d])
        for k in range(KEYS):
            make_unit(keys[i, k], PELVIS)
            make_unit(keys[i, k], CHEST)
