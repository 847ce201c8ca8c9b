"""A chain of hinges: where they are, and one pass of cyclic coordinate descent (CCD) over them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]


class Hinges(NamedTuple):
    """A chain of J hinges from the root outwards."""

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
    axes: Floats
    """(J, 3): of the hinges, in the root's frame."""
    pivots: Floats
    """(J + 1, 3): where each hinge is, and the effector."""


@kernel
def make_scratch(count: int) -> Scratch:
    return Scratch(np.empty((count + 1, 3, 3)), np.empty((count, 3)), np.empty((count + 1, 3)))


@inlined
def _turned(axis: Vector, c: float, s: float, v: Vector) -> Vector:
    """Rodrigues: v turned about a unit axis by the angle of a cosine and a sine."""
    along = (1.0 - c) * (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2])
    return (
        c * v[0] + s * (axis[1] * v[2] - axis[2] * v[1]) + along * axis[0],
        c * v[1] + s * (axis[2] * v[0] - axis[0] * v[2]) + along * axis[1],
        c * v[2] + s * (axis[0] * v[1] - axis[1] * v[0]) + along * axis[2],
    )


@inlined
def _carried(frames: Floats, k: int, v: Floats) -> Vector:
    """A vector given in frame k, in the root's frame."""
    f = frames[k]
    return (
        f[0, 0] * v[0] + f[0, 1] * v[1] + f[0, 2] * v[2],
        f[1, 0] * v[0] + f[1, 1] * v[1] + f[1, 2] * v[2],
        f[2, 0] * v[0] + f[2, 1] * v[1] + f[2, 2] * v[2],
    )


@kernel
def place(hinges: Hinges, angles: Floats, at: Scratch) -> None:
    """Forward kinematics from the root outwards."""
    frames, pivots = at.frames, at.pivots
    for i in range(3):
        pivots[0, i] = 0.0
        for j in range(3):
            frames[0, i, j] = 1.0 if i == j else 0.0
    for k in range(len(angles)):
        axis = _carried(frames, k, hinges.axes[k])
        c, s = math.cos(angles[k]), math.sin(angles[k])
        for j in range(3):
            column = _turned(axis, c, s, (frames[k, 0, j], frames[k, 1, j], frames[k, 2, j]))
            for i in range(3):
                frames[k + 1, i, j] = column[i]
        link = _carried(frames, k + 1, hinges.offsets[k])
        for i in range(3):
            at.axes[k, i] = axis[i]
            pivots[k + 1, i] = pivots[k, i] + link[i]


@kernel
def distance_left(at: Scratch, target: Floats) -> float:
    """From the effector to the target."""
    tip = at.pivots[-1]
    return math.sqrt(
        (target[0] - tip[0]) ** 2 + (target[1] - tip[1]) ** 2 + (target[2] - tip[2]) ** 2
    )


@kernel
def sweep_over(
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
        if distance_left(at, target) <= tolerance:
            break
        p = at.pivots[k]
        a = (at.axes[k, 0], at.axes[k, 1], at.axes[k, 2])
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
        moved = _turned(a, math.cos(change), math.sin(change), v)
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
def place_all(hinges: Hinges, angles: Floats, tips: Floats) -> None:
    """Where the effectors of poses (N, J) are: (N, 3)."""
    at = make_scratch(angles.shape[1])
    for n in range(len(angles)):
        place(hinges, angles[n], at)
        tips[n] = at.pivots[-1]
