"""Inverse kinematics of hinges, one target after the other: cyclic coordinate descent (CCD), and a
limb of two bones bent in closed form."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._jit import kernel

Floats = NDArray[np.float64]

LIMB = 4
"""Hinges of a limb: about Y, Z and X at its root, and about X at the knee or elbow."""
_YAWS = 8
"""So many other turns of the limb about its Y axis are tried when the present one breaks a limit,
from the nearest outwards."""
_PATIENCE = 2
"""After so many sweeps what is left must have shrunk to _SHRUNK, or the limits are in the way."""
_SHRUNK = 0.5


class Hinges(NamedTuple):
    """A chain of J hinges from the root outwards; the last LIMB of them are the limb's."""

    axes: Floats
    """(J, 3), unit, each in the frame that the hinges before it have turned."""
    offsets: Floats
    """(J, 3), leg lengths: from a hinge to the next one; the last leads to the effector."""
    lows: Floats
    """(J,), radians"""
    highs: Floats
    """(J,), radians"""


class Scratch(NamedTuple):
    """Where the hinges are: filled by `place`, kept up by what moves them."""

    frames: Floats
    """(J + 1, 3, 3): orientation before each hinge turns; the last is the effector's."""
    pivots: Floats
    """(J + 1, 3): where each hinge is, and the effector."""


class Effort(NamedTuple):
    """When to stop."""

    tolerance: float
    """Leg lengths between effector and target that count as reached."""
    sweeps: int
    """No more than so many passes over the hinges."""
    limb_sweeps: int
    """So many of them are of the limb alone (CCD)."""


@kernel
def _make_scratch(count: int) -> Scratch:
    return Scratch(np.empty((count + 1, 3, 3)), np.empty((count + 1, 3)))


@kernel
def _turn(axis: Floats, angle: float, v: Floats, out: Floats) -> None:
    """Rodrigues: v turned about a unit axis."""
    c, s = math.cos(angle), math.sin(angle)
    along = (1.0 - c) * (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2])
    x = c * v[0] + s * (axis[1] * v[2] - axis[2] * v[1]) + along * axis[0]
    y = c * v[1] + s * (axis[2] * v[0] - axis[0] * v[2]) + along * axis[1]
    z = c * v[2] + s * (axis[0] * v[1] - axis[1] * v[0]) + along * axis[2]
    out[0], out[1], out[2] = x, y, z


@kernel
def place(hinges: Hinges, angles: Floats, at: Scratch) -> None:
    """Forward kinematics from the root outwards."""
    at.frames[0] = np.eye(3)
    at.pivots[0] = 0.0
    for k in range(len(angles)):
        before, after = at.frames[k], at.frames[k + 1]
        axis = before @ hinges.axes[k]
        for column in range(3):
            _turn(axis, angles[k], before[:, column], after[:, column])
        at.pivots[k + 1] = at.pivots[k] + after @ hinges.offsets[k]


@kernel
def _left(at: Scratch, target: Floats) -> float:
    tip = at.pivots[-1]
    return math.sqrt(
        (target[0] - tip[0]) ** 2 + (target[1] - tip[1]) ** 2 + (target[2] - tip[2]) ** 2
    )


@kernel
def _sweep(
    hinges: Hinges,
    angles: Floats,
    target: Floats,
    tolerance: float,
    span: tuple[int, int],
    at: Scratch,
) -> int:
    """Turn hinges of a span once each, outermost first, until the target is met; how many turned.

    Inner hinges stand still meanwhile, so that only the effector must be kept up. What lies
    outside the span moves with it: `place` before the next sweep.
    """
    turned = 0
    tip = at.pivots[-1]
    for k in range(span[1] - 1, span[0] - 1, -1):
        if _left(at, target) <= tolerance:
            break
        a = at.frames[k] @ hinges.axes[k]
        v = tip - at.pivots[k]
        t = target - at.pivots[k]
        sine = (
            a[0] * (v[1] * t[2] - v[2] * t[1])
            + a[1] * (v[2] * t[0] - v[0] * t[2])
            + a[2] * (v[0] * t[1] - v[1] * t[0])
        )
        cosine = np.sum(v * t) - np.sum(a * v) * np.sum(a * t)
        wished = angles[k] + math.atan2(sine, cosine)
        allowed = min(max(wished, hinges.lows[k]), hinges.highs[k])
        _turn(a, allowed - angles[k], v, v)
        tip[:] = at.pivots[k] + v
        angles[k] = allowed
        turned += 1
    return turned


@kernel
def _clamped(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


@kernel
def _bent_at(hinges: Hinges, yaw: float, local: Floats, pose: Floats) -> float:
    """Pose (4,) of a limb turned by a yaw that brings its tip nearest; the distance left.

    `local` is the target seen from the limb's root. Chen et al. 2012, eqs. (2)-(4): the law of
    cosines gives the knee, the direction of the target the two angles above it.
    """
    first = len(hinges.lows) - LIMB
    low, high = hinges.lows[first:], hinges.highs[first:]
    upper, lower = -hinges.offsets[first + 2, 1], -hinges.offsets[first + 3, 1]
    bends = hinges.axes[first + 3, 0]
    square = np.sum(local * local)
    cosine = (square - upper * upper - lower * lower) / (2.0 * upper * lower)
    knee = _clamped(math.acos(_clamped(cosine, -1.0, 1.0)), low[3], high[3])
    along, behind = upper + lower * math.cos(knee), bends * lower * math.sin(knee)
    reach = math.hypot(along, behind)
    x = math.cos(yaw) * local[0] - math.sin(yaw) * local[2]
    z = math.sin(yaw) * local[0] + math.cos(yaw) * local[2]
    aside = math.atan2(x, -local[1])
    if abs(aside) > 0.5 * math.pi:  # the same plane, with the limb raised beyond the horizontal
        aside -= math.copysign(math.pi, aside)
    aside = _clamped(aside, low[1], high[1])
    # Seen along its own plane, so that flexion is the best one for the clamped angle aside too.
    down = math.sin(aside) * x - math.cos(aside) * local[1]
    lag = math.atan2(behind, along)
    flexion = _clamped(math.atan2(z, down) + lag, low[2], high[2])
    pose[0], pose[1], pose[2], pose[3] = yaw, aside, flexion, knee
    tip_x = reach * math.cos(flexion - lag) * math.sin(aside) - x
    tip_y = -reach * math.cos(flexion - lag) * math.cos(aside) - local[1]
    tip_z = reach * math.sin(flexion - lag) - z
    return math.sqrt(tip_x * tip_x + tip_y * tip_y + tip_z * tip_z)


@kernel
def _within_reach(hinges: Hinges, local: Floats) -> bool:
    """Whether some angle of the knee or elbow puts the tip as far from the limb's root."""
    upper, lower = -hinges.offsets[-2, 1], -hinges.offsets[-1, 1]
    far = upper * upper + lower * lower + 2.0 * upper * lower * math.cos(hinges.lows[-1])
    near = upper * upper + lower * lower + 2.0 * upper * lower * math.cos(hinges.highs[-1])
    square = local[0] ** 2 + local[1] ** 2 + local[2] ** 2
    return bool(near <= square <= far)


@kernel
def _bend_limb(
    hinges: Hinges, angles: Floats, target: Floats, tolerance: float, search: bool, at: Scratch
) -> int:
    """Bring the limb's tip as near as its limits allow, its root at rest; how many hinges were set.

    One of four angles is free for a target in space: the present yaw if it serves; or else, if
    asked to search and the distance is not what fails, the first that does, or the best.
    """
    first = len(angles) - LIMB
    local = at.frames[first].T @ (target - at.pivots[first])
    pose, best = np.empty(LIMB), np.empty(LIMB)
    now, low, high = angles[first], hinges.lows[first], hinges.highs[first]
    least = _bent_at(hinges, now, local, best)
    tried = 1
    if search and _within_reach(hinges, local):
        while least > tolerance and tried <= _YAWS:
            aside = (high - low) * (2.0 / _YAWS) * ((tried + 1) // 2)
            yaw = _clamped(now + (aside if tried % 2 else -aside), low, high)
            left = _bent_at(hinges, yaw, local, pose)
            tried += 1
            if left < least:
                least = left
                best[:] = pose
    angles[first:] = best
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
        if _left(at, target) <= effort.tolerance:
            return sweep, turned
        first = count - LIMB if sweep < effort.limb_sweeps else 0
        turned += _sweep(hinges, angles, target, effort.tolerance, (first, count), at)
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
        left = _left(at, target)
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
        turned += _sweep(hinges, angles, target, effort.tolerance, (0, trunk), at)
        place(hinges, angles, at)
        if _left(at, target) <= effort.tolerance:
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
    at = _make_scratch(angles.shape[1])
    for n in range(len(targets)):
        if two_stage:
            done = _solve_two_stage(hinges, angles[n], targets[n], effort, starts, at)
        else:
            done = _solve_ccd(hinges, angles[n], targets[n], effort, at)
        work[n, 0], work[n, 1] = done
        left[n] = _left(at, targets[n])


@kernel
def place_all(hinges: Hinges, angles: Floats, tips: Floats) -> None:
    """Where the effectors of poses (N, J) are: (N, 3)."""
    at = _make_scratch(angles.shape[1])
    for n in range(len(angles)):
        place(hinges, angles[n], at)
        tips[n] = at.pivots[-1]
