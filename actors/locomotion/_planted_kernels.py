"""The planted step: targets of many steps at many moments."""

from __future__ import annotations

import math

from esplanade.actors.locomotion._feet_kernels import (
    clearance,
    standing_foot,
    swinging_foot,
    too_high,
)
from esplanade.actors.locomotion._gait_kernels import arm, chest_torsion, mix, smooth
from esplanade.actors.locomotion._hips_kernels import hips_at, lift_of
from esplanade.actors.locomotion._turning_kernels import Footprint, Poses, both_down
from esplanade.actors.locomotion.footfalls import Footfalls, Targets
from esplanade.actors.locomotion.skeleton import Floats
from esplanade.planning.compiled.jit import inlined, kernel

_TURN = 2.0 * math.pi


@kernel
def fill_targets(
    falls: Footfalls, u: Floats, poses: Poses, clearances: Floats, out: Targets
) -> None:
    """Targets of N steps at shares u (N, K). clearances is what `fill_clearances` made."""
    for i in range(u.shape[0]):
        mirror = -1.0 if falls.right[i] else 1.0
        lifted = _seen(falls.lifted[i], falls.standing[i], falls.leg_m[i], mirror)
        landing = _seen(falls.landing[i], falls.standing[i], falls.leg_m[i], mirror)
        here = (0.0, 0.0, 0.0, 0.0)
        before, after = both_down(lifted, here, 1.0, poses), both_down(here, landing, -1.0, poses)
        lift = lift_of(before, after)
        lift_by = clearance(before, after, lifted, landing, clearances)
        out.lift[i] = lift
        for k in range(u.shape[1]):
            hips = hips_at(before, after, u[i, k])
            standing = standing_foot(before, after, hips, u[i, k])
            swinging = swinging_foot(before, after, lifted, landing, hips, u[i, k], lift, lift_by)
            height = hips.z - too_high(hips, standing, swinging)
            pace = mix(before.pace, after.pace, smooth(u[i, k]))
            turned = mix(lifted[3], landing[3], smooth((u[i, k] - lift) / (1.0 - lift)))
            _put(out.root[i, k], hips.x, hips.y, height, falls.standing[i], falls.leg_m[i], mirror)
            _put(
                out.swing_ankle[i, k],
                swinging.x,
                swinging.y,
                swinging.z,
                falls.standing[i],
                falls.leg_m[i],
                mirror,
            )
            out.yaw[i, k] = falls.standing[i, 3] + mirror * hips.yaw
            out.lean[i, k], out.roll[i, k] = hips.lean, mirror * hips.roll
            out.swing_pitch[i, k], out.standing_pitch[i, k] = swinging.pitch, standing.pitch
            out.swing_heading[i, k] = falls.standing[i, 3] + mirror * turned
            out.torsion[i, k] = mirror * chest_torsion(pace, u[i, k])
            near, far = (1, 0) if falls.right[i] else (0, 1)
            out.shoulders[i, k, near], out.elbows[i, k, near] = arm(pace, 0.5 * u[i, k])
            out.shoulders[i, k, far], out.elbows[i, k, far] = arm(pace, 0.5 + 0.5 * u[i, k])


@inlined
def _seen(footprint: Floats, standing: Floats, leg_m: float, mirror: float) -> Footprint:
    """A footprint from the standing foot, as if that were the left one."""
    cos, sin = math.cos(standing[3]), math.sin(standing[3])
    x, y = (footprint[0] - standing[0]) / leg_m, (footprint[1] - standing[1]) / leg_m
    turned = (footprint[3] - standing[3] + math.pi) % _TURN - math.pi
    return (
        x * cos + y * sin,
        mirror * (y * cos - x * sin),
        (footprint[2] - standing[2]) / leg_m,
        mirror * turned,
    )


@inlined
def _put(
    out: Floats, x: float, y: float, z: float, standing: Floats, leg_m: float, mirror: float
) -> None:
    """Write a place as it is in the world."""
    cos, sin = math.cos(standing[3]), math.sin(standing[3])
    out[0] = standing[0] + leg_m * (x * cos - mirror * y * sin)
    out[1] = standing[1] + leg_m * (x * sin + mirror * y * cos)
    out[2] = standing[2] + leg_m * z
