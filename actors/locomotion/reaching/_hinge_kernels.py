"""A chain of hinges: its forward kinematics, and one sweep of cyclic coordinate descent (CCD)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined, kernel

Vector = tuple[float, float, float]


class Hinges(NamedTuple):
    """A chain of J hinges from the root outwards."""

    axes: Floats
    """(J, 3): unit vectors, each in the frame that the hinges before it have turned."""
    offsets: Floats
    """(J, 3), leg lengths: from a hinge to the next one; the last leads to the effector."""
    lows: Floats
    """(J,), radians: the lower limits of the angles."""
    highs: Floats
    """(J,), radians: the upper limits."""


class ChainState(NamedTuple):
    """The places of the hinges, written by `place_hinges` and by all that moves them."""

    frames: Floats
    """(J + 1, 3, 3): orientation before each hinge turns; the last is the effector's."""
    axes: Floats
    """(J, 3): axes of the hinges in the root's frame."""
    pivots: Floats
    """(J + 1, 3), leg lengths: places of the hinges, and of the effector."""


@kernel
def new_state(count: int) -> ChainState:
    """The state of a chain of `count` hinges, yet to be written."""
    return ChainState(np.empty((count + 1, 3, 3)), np.empty((count, 3)), np.empty((count + 1, 3)))


@inlined
def _rotated(axis: Vector, c: float, s: float, v: Vector) -> Vector:
    """The vector v turned about a unit axis by the angle of cosine c and sine s (Rodrigues)."""
    along = (1.0 - c) * (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2])
    return (
        c * v[0] + s * (axis[1] * v[2] - axis[2] * v[1]) + along * axis[0],
        c * v[1] + s * (axis[2] * v[0] - axis[0] * v[2]) + along * axis[1],
        c * v[2] + s * (axis[0] * v[1] - axis[1] * v[0]) + along * axis[2],
    )


@inlined
def _in_root_frame(frames: Floats, k: int, v: Floats) -> Vector:
    """A vector of frame k in the root's frame."""
    f = frames[k]
    return (
        f[0, 0] * v[0] + f[0, 1] * v[1] + f[0, 2] * v[2],
        f[1, 0] * v[0] + f[1, 1] * v[1] + f[1, 2] * v[2],
        f[2, 0] * v[0] + f[2, 1] * v[1] + f[2, 2] * v[2],
    )


@kernel
def place_hinges(hinges: Hinges, angles: Floats, state: ChainState) -> None:
    """Forward kinematics from the root outwards, for angles (J,)."""
    frames, pivots = state.frames, state.pivots
    for i in range(3):
        pivots[0, i] = 0.0
        for j in range(3):
            frames[0, i, j] = 1.0 if i == j else 0.0
    for k in range(len(angles)):
        axis = _in_root_frame(frames, k, hinges.axes[k])
        c, s = math.cos(angles[k]), math.sin(angles[k])
        for j in range(3):
            column = _rotated(axis, c, s, (frames[k, 0, j], frames[k, 1, j], frames[k, 2, j]))
            for i in range(3):
                frames[k + 1, i, j] = column[i]
        link = _in_root_frame(frames, k + 1, hinges.offsets[k])
        for i in range(3):
            state.axes[k, i] = axis[i]
            pivots[k + 1, i] = pivots[k, i] + link[i]


@kernel
def distance_left(state: ChainState, target: Floats) -> float:
    """Distance from the effector to the target, leg lengths."""
    tip = state.pivots[-1]
    return math.sqrt(
        (target[0] - tip[0]) ** 2 + (target[1] - tip[1]) ** 2 + (target[2] - tip[2]) ** 2
    )


@kernel
def ccd_sweep(
    hinges: Hinges,
    angles: Floats,
    target: Floats,
    tolerance: float,
    span: tuple[int, int],
    state: ChainState,
) -> int:
    """Turn the hinges of a span once each, outermost first, until the effector is at the target.

    The result is the number of hinges turned. Each turn brings the effector as near to the target
    as that hinge alone can, within its limits. Inner hinges stand still meanwhile, so only the
    effector is kept up to date; call `place_hinges` before the next sweep.
    """
    turned = 0
    tip = state.pivots[-1]
    for k in range(span[1] - 1, span[0] - 1, -1):
        if distance_left(state, target) <= tolerance:
            break
        p = state.pivots[k]
        a = (state.axes[k, 0], state.axes[k, 1], state.axes[k, 2])
        v = (tip[0] - p[0], tip[1] - p[1], tip[2] - p[2])
        t = (target[0] - p[0], target[1] - p[1], target[2] - p[2])
        sine = (
            a[0] * (v[1] * t[2] - v[2] * t[1])
            + a[1] * (v[2] * t[0] - v[0] * t[2])
            + a[2] * (v[0] * t[1] - v[1] * t[0])
        )
        cosine = dot(v, t) - dot(a, v) * dot(a, t)
        allowed = clamped(angles[k] + math.atan2(sine, cosine), hinges.lows[k], hinges.highs[k])
        change = allowed - angles[k]
        moved = _rotated(a, math.cos(change), math.sin(change), v)
        for i in range(3):
            tip[i] = p[i] + moved[i]
        angles[k] = allowed
        turned += 1
    return turned


@inlined
def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def clamped(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


@kernel
def fill_effectors(hinges: Hinges, angles: Floats, tips: Floats) -> None:
    """Write the places (N, 3) of the effectors of poses (N, J)."""
    state = new_state(angles.shape[1])
    for n in range(len(angles)):
        place_hinges(hinges, angles[n], state)
        tips[n] = state.pivots[-1]
