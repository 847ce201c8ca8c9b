"""Targets of many planted steps at many moments."""

from __future__ import annotations

import math
from typing import NamedTuple

from esplanade.actors.locomotion.gait._curve_kernels import arm, chest_torsion, mix, smooth
from esplanade.actors.locomotion.gait.step_length import PoseTable
from esplanade.actors.locomotion.planted._double_support_kernels import double_support_pose
from esplanade.actors.locomotion.planted._feet_kernels import (
    clearance,
    hip_drop,
    standing_foot,
    swing_foot,
)
from esplanade.actors.locomotion.planted._hips_kernels import hips_at, lift_of, running
from esplanade.actors.locomotion.planted.footprints import HEADING, Footprint, StepFootprints
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined, kernel

_TURN = 2.0 * math.pi

# Arms of runners beside those of walkers, radians.
_BENT = 1.05
"""Their elbows are bent by this more."""
_SWUNG = 0.35
"""Their shoulders swing by this more, to and fro."""


class GaitTables(NamedTuple):
    """The tables of planted steps."""

    poses: PoseTable
    clearances: Floats
    """(M, M), leg lengths: written by `fill_clearances`."""


@kernel
def fill_targets(
    footprints: StepFootprints, u: Floats, table: PoseTable, clearances: Floats, out: Targets
) -> None:
    """Write the targets of N steps at shares u (N, K); `clearances` is from `fill_clearances`."""
    for i in range(u.shape[0]):
        mirror = -1.0 if footprints.on_right[i] else 1.0
        origin, leg_m = footprints.standing[i], footprints.leg_m[i]
        lifted = _from_standing_foot(footprints.lifted[i], origin, leg_m, mirror)
        landing = _from_standing_foot(footprints.landing[i], origin, leg_m, mirror)
        here = Footprint(0.0, 0.0, 0.0, 0.0)
        before = double_support_pose(lifted, here, 1.0, table)
        after = double_support_pose(here, landing, -1.0, table)
        lift = lift_of(before, after)
        raise_by = clearance(before, after, lifted, landing, clearances)
        out.lift[i], out.flight[i] = lift, after.flight
        for k in range(u.shape[1]):
            hips = hips_at(before, after, u[i, k])
            standing = standing_foot(before, after, hips, u[i, k])
            swing = swing_foot(before, after, lifted, landing, hips, u[i, k], lift, raise_by)
            height = hips.z - hip_drop(hips, standing, swing)
            pace = mix(before.pace, after.pace, smooth(u[i, k]))
            turned = mix(lifted.heading, landing.heading, smooth((u[i, k] - lift) / (1.0 - lift)))
            _write_in_world(out.root[i, k], hips.x, hips.y, height, origin, leg_m, mirror)
            _write_in_world(out.swing_ankle[i, k], swing.x, swing.y, swing.z, origin, leg_m, mirror)
            out.yaw[i, k] = origin[HEADING] + mirror * hips.yaw
            out.lean[i, k], out.roll[i, k] = hips.lean, mirror * hips.roll
            out.swing_pitch[i, k], out.standing_pitch[i, k] = swing.pitch, standing.pitch
            out.swing_heading[i, k] = origin[HEADING] + mirror * turned
            out.torsion[i, k] = mirror * chest_torsion(pace, u[i, k])
            near, far = (1, 0) if footprints.on_right[i] else (0, 1)
            runs = running(before, after, u[i, k])
            for side, phase in ((near, 0.5 * u[i, k]), (far, 0.5 + 0.5 * u[i, k])):
                shoulder, elbow = arm(pace, phase)
                out.shoulders[i, k, side] = shoulder - _SWUNG * runs * math.cos(_TURN * phase)
                out.elbows[i, k, side] = elbow + _BENT * runs


@inlined
def _from_standing_foot(
    footprint: Floats, standing: Floats, leg_m: float, mirror: float
) -> Footprint:
    """A footprint (4,) in the frame of the standing foot, mirrored if that is the right one."""
    cos, sin = math.cos(standing[HEADING]), math.sin(standing[HEADING])
    x, y = (footprint[0] - standing[0]) / leg_m, (footprint[1] - standing[1]) / leg_m
    turned = (footprint[HEADING] - standing[HEADING] + math.pi) % _TURN - math.pi
    return Footprint(
        x * cos + y * sin,
        mirror * (y * cos - x * sin),
        (footprint[2] - standing[2]) / leg_m,
        mirror * turned,
    )


@inlined
def _write_in_world(
    out: Floats, x: float, y: float, z: float, standing: Floats, leg_m: float, mirror: float
) -> None:
    """Write a place in the frame of the standing foot as a place (3,) in the world, metres."""
    cos, sin = math.cos(standing[HEADING]), math.sin(standing[HEADING])
    out[0] = standing[0] + leg_m * (x * cos - mirror * y * sin)
    out[1] = standing[1] + leg_m * (x * sin + mirror * y * cos)
    out[2] = standing[2] + leg_m * z
