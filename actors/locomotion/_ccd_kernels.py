"""Inverse kinematics of a limb on a trunk, one target after the other: by cyclic coordinate descent
(CCD) alone, or with the limb's two bones bent in closed form."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion._hinge_kernels import (
    Floats,
    Hinges,
    Scratch,
    Vector,
    clamped,
    distance_left,
    dot,
    make_scratch,
    place,
    sweep_over,
)
from esplanade.planning.compiled.jit import kernel

LIMB = 4
"""Hinges of a limb: about Y, Z and X at its root, and about X at the knee or elbow."""
_YAWS = 8
"""So many other turns of the limb about its Y axis are tried when the present one breaks a limit,
from the nearest outwards."""
_PATIENCE = 2
"""After so many sweeps what is left must have shrunk to _SHRUNK, or the limits are in the way."""
_SHRUNK = 0.5


class Effort(NamedTuple):
    """When to stop."""

    tolerance: float
    """Leg lengths between effector and target that count as reached."""
    sweeps: int
    """No more than so many passes over the hinges."""
    limb_sweeps: int
    """So many of them are of the limb alone (CCD)."""


@kernel
def _bent_at(
    hinges: Hinges, yaw: float, local: Vector
) -> tuple[float, tuple[float, float, float, float]]:
    """How far the tip of a limb turned by a yaw stays from a target, and the limb's best pose.

    `local` is the target seen from the limb's root. Chen et al. 2012, eqs. (2)-(4): the law of
    cosines gives the knee, the direction of the target the two angles above it.
    """
    first = len(hinges.lows) - LIMB
    low, high = hinges.lows[first:], hinges.highs[first:]
    upper, lower = -hinges.offsets[first + 2, 1], -hinges.offsets[first + 3, 1]
    bends = hinges.axes[first + 3, 0]
    cosine = (dot(local, local) - upper * upper - lower * lower) / (2.0 * upper * lower)
    knee = clamped(math.acos(clamped(cosine, -1.0, 1.0)), low[3], high[3])
    along, behind = upper + lower * math.cos(knee), bends * lower * math.sin(knee)
    reach = math.hypot(along, behind)
    x = math.cos(yaw) * local[0] - math.sin(yaw) * local[2]
    y = local[1]
    z = math.sin(yaw) * local[0] + math.cos(yaw) * local[2]
    aside = math.atan2(x, -y)
    if abs(aside) > 0.5 * math.pi:  # the same plane, with the limb raised beyond the horizontal
        aside -= math.copysign(math.pi, aside)
    aside = clamped(aside, low[1], high[1])
    # Seen along its own plane, so that flexion is the best one for the clamped angle aside too.
    down = math.sin(aside) * x - math.cos(aside) * y
    lag = math.atan2(behind, along)
    flexion = clamped(math.atan2(z, down) + lag, low[2], high[2])
    out = reach * math.cos(flexion - lag)
    off = (
        out * math.sin(aside) - x,
        -out * math.cos(aside) - y,
        reach * math.sin(flexion - lag) - z,
    )
    return math.sqrt(dot(off, off)), (yaw, aside, flexion, knee)


@kernel
def _within_reach(hinges: Hinges, local: Vector) -> bool:
    """Whether some angle of the knee or elbow puts the tip as far from the limb's root."""
    upper, lower = -hinges.offsets[-2, 1], -hinges.offsets[-1, 1]
    far = upper * upper + lower * lower + 2.0 * upper * lower * math.cos(hinges.lows[-1])
    near = upper * upper + lower * lower + 2.0 * upper * lower * math.cos(hinges.highs[-1])
    return bool(near <= dot(local, local) <= far)


@kernel
def _bend_limb(
    hinges: Hinges, angles: Floats, target: Floats, tolerance: float, search: bool, at: Scratch
) -> int:
    """Bring the limb's tip as near as its limits allow, its root at rest; how many hinges were set.

    One of four angles is free for a target in space: the present yaw if it serves; or else, if
    asked to search and the distance is not what fails, the first that does, or the best.
    """
    first = len(angles) - LIMB
    f, p = at.frames[first], at.pivots[first]
    x, y, z = target[0] - p[0], target[1] - p[1], target[2] - p[2]
    local = (
        f[0, 0] * x + f[1, 0] * y + f[2, 0] * z,
        f[0, 1] * x + f[1, 1] * y + f[2, 1] * z,
        f[0, 2] * x + f[1, 2] * y + f[2, 2] * z,
    )
    now, low, high = angles[first], hinges.lows[first], hinges.highs[first]
    least, best = _bent_at(hinges, now, local)
    tried = 1
    if search and _within_reach(hinges, local):
        while least > tolerance and tried <= _YAWS:
            aside = (high - low) * (2.0 / _YAWS) * ((tried + 1) // 2)
            yaw = clamped(now + (aside if tried % 2 else -aside), low, high)
            left, pose = _bent_at(hinges, yaw, local)
            tried += 1
            if left < least:
                least, best = left, pose
    for k in range(LIMB):
        angles[first + k] = best[k]
    place(hinges, angles, at)
    return LIMB * tried


@kernel
def _solve_ccd(
    hinges: Hinges, angles: Floats, target: Floats, effort: Effort, at: Scratch
) -> tuple[int, int]:
    """CCD of the limb alone for some sweeps, then of the whole chain: sweeps and hinges turned."""
    count = len(angles)
    turned = 0
    place(hinges, angles, at)
    for sweep in range(effort.sweeps):
        if distance_left(at, target) <= effort.tolerance:
            return sweep, turned
        first = count - LIMB if sweep < effort.limb_sweeps else 0
        turned += sweep_over(hinges, angles, target, effort.tolerance, (first, count), at)
        place(hinges, angles, at)
    return effort.sweeps, turned


@kernel
def _solve_two_stage(
    hinges: Hinges, angles: Floats, target: Floats, effort: Effort, starts: Floats, at: Scratch
) -> tuple[int, int]:
    """The limb in closed form; while that does not reach, the trunk turns by CCD, and again.

    Where limits are in the way, it starts anew from the next of the given poses.
    """
    trunk = len(angles) - LIMB
    turned, age, restarts = 0, 0, 0
    marked = math.inf
    place(hinges, angles, at)
    for sweep in range(effort.sweeps):
        turned += _bend_limb(hinges, angles, target, effort.tolerance, age == 0, at)
        left = distance_left(at, target)
        if left <= effort.tolerance:
            return sweep + 1, turned
        age += 1
        if age % _PATIENCE == 0:
            if left > _SHRUNK * marked and restarts < len(starts):
                angles[:] = starts[restarts]
                place(hinges, angles, at)
                restarts += 1
                turned += len(angles)
                age, marked = 0, math.inf
                continue
            marked = left
        turned += sweep_over(hinges, angles, target, effort.tolerance, (0, trunk), at)
        place(hinges, angles, at)
        if distance_left(at, target) <= effort.tolerance:
            return sweep + 1, turned
    return effort.sweeps, turned


@kernel
def solve_all(
    hinges: Hinges,
    angles: Floats,
    targets: Floats,
    effort: Effort,
    starts: Floats,
    two_stage: bool,
    left: Floats,
    work: NDArray[np.int64],
) -> None:
    """Move poses (N, J) towards targets (N, 3); distances left (N,), sweeps and turns (N, 2)."""
    at = make_scratch(angles.shape[1])
    for n in range(len(targets)):
        if two_stage:
            done = _solve_two_stage(hinges, angles[n], targets[n], effort, starts, at)
        else:
            done = _solve_ccd(hinges, angles[n], targets[n], effort, at)
        work[n, 0], work[n, 1] = done
        left[n] = distance_left(at, targets[n])
