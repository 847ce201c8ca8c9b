"""Rotations as unit quaternions w x y z: products, Euler angles about Y, X, Z, slerp.

All functions take any leading shape and broadcast. A quaternion turns a vector v into q v q*, so
`multiply(a, b)` is first b, then a.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

IDENTITY: Final[Floats] = np.array([1.0, 0.0, 0.0, 0.0])
IDENTITY.setflags(write=False)

_LOCKED_COSINE: Final = 1e-7
"""Below this cosine of the middle angle, Y and Z turn about the same axis."""
_STRAIGHT_RAD: Final = 1e-6
"""Between quaternions closer than this an arc and its chord are one."""


def normalise(q: ArrayLike) -> Floats:
    """The unit quaternions of float64 (..., 4) along the same directions."""
    values = np.asarray(q, dtype=np.float64)
    unit: Floats = values / np.linalg.norm(values, axis=-1, keepdims=True)
    return unit


def multiply(a: ArrayLike, b: ArrayLike) -> Floats:
    """Products a b, float64 (..., 4): the rotation b followed by a."""
    aw, ax, ay, az = np.moveaxis(np.asarray(a, dtype=np.float64), -1, 0)
    bw, bx, by, bz = np.moveaxis(np.asarray(b, dtype=np.float64), -1, 0)
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=-1,
    )


def inverse(q: ArrayLike) -> Floats:
    """Inverses of unit quaternions, float64 (..., 4)."""
    conjugate: Floats = np.asarray(q, dtype=np.float64) * np.array([1.0, -1.0, -1.0, -1.0])
    return conjugate


def rotate(q: ArrayLike, vectors: ArrayLike) -> Floats:
    """Vectors (..., 3) turned by unit quaternions (..., 4)."""
    turned = np.asarray(q, dtype=np.float64)
    given = np.asarray(vectors, dtype=np.float64)
    axis = turned[..., 1:]
    twice = 2.0 * np.cross(axis, given)
    moved: Floats = given + turned[..., :1] * twice + np.cross(axis, twice)
    return moved


def about(axis: ArrayLike, angle_rad: ArrayLike) -> Floats:
    """Rotations by angles (...) about unit axes (..., 3): float64 (..., 4)."""
    half = 0.5 * np.asarray(angle_rad, dtype=np.float64)[..., None]
    direction = np.asarray(axis, dtype=np.float64)
    parts = np.broadcast_arrays(np.cos(half), np.sin(half) * direction)
    return np.concatenate((parts[0][..., :1], parts[1]), axis=-1)


def angle_between(a: ArrayLike, b: ArrayLike) -> Floats:
    """Angles (...) of the shortest rotations from a to b, in [0, pi] radians."""
    relative = multiply(inverse(a), b)
    sine = np.linalg.norm(relative[..., 1:], axis=-1)
    angle: Floats = 2.0 * np.arctan2(sine, np.abs(relative[..., 0]))
    return angle


def slerp(a: ArrayLike, b: ArrayLike, share: ArrayLike) -> Floats:
    """Quaternions on the shorter great arc from a (share 0) to b (share 1).

    Parameters
    ----------
    a, b : float64 (..., 4), unit quaternions
    share : float64 (...), in [0, 1]

    Returns
    -------
    float64 (..., 4), unit quaternions

    Notes
    -----
    Chen et al. 2012, eq. (5). The angle comes from the chord, which stays exact where the cosine
    of a small angle is 1; of a and b half a turn of the sphere apart (the same rotation) one is
    negated first, so that nothing is ever divided by zero.
    """
    start = np.asarray(a, dtype=np.float64)
    end = np.asarray(b, dtype=np.float64)
    t = np.asarray(share, dtype=np.float64)[..., None]
    same_side = np.sum(start * end, axis=-1, keepdims=True) >= 0.0
    end = np.where(same_side, end, -end)
    chord = np.linalg.norm(end - start, axis=-1, keepdims=True)
    angle = 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
    bent = angle > _STRAIGHT_RAD
    safe = np.where(bent, angle, 1.0)
    weight_a = np.where(bent, np.sin((1.0 - t) * safe) / np.sin(safe), 1.0 - t)
    weight_b = np.where(bent, np.sin(t * safe) / np.sin(safe), t)
    return normalise(weight_a * start + weight_b * end)


def from_euler(angles_rad: ArrayLike) -> Floats:
    """Quaternions of M = R_y R_x R_z, from angles (..., 3) about Y, X, Z in this order.

    Chen et al. 2012, sec. 3. Each axis is the one carried along by the turns before it.
    """
    halves = 0.5 * np.asarray(angles_rad, dtype=np.float64)
    cy, cx, cz = np.moveaxis(np.cos(halves), -1, 0)
    sy, sx, sz = np.moveaxis(np.sin(halves), -1, 0)
    return np.stack(
        (
            cy * cx * cz + sy * sx * sz,
            cy * sx * cz + sy * cx * sz,
            sy * cx * cz - cy * sx * sz,
            cy * cx * sz - sy * sx * cz,
        ),
        axis=-1,
    )


def to_euler(q: ArrayLike) -> Floats:
    """Angles (..., 3) about Y, X, Z, radians: M = R_y R_x R_z; X lies in [-pi/2, pi/2].

    Where X is a quarter turn, Y and Z turn about the same axis (gimbal lock) and only their sum
    or difference is known: all of it goes into Y, and Z is 0.
    """
    matrix = to_matrix(q)
    sine_x = -matrix[..., 1, 2]
    cosine_x = np.hypot(matrix[..., 0, 2], matrix[..., 2, 2])
    locked = cosine_x < _LOCKED_COSINE
    y = np.where(
        locked,
        np.arctan2(-matrix[..., 2, 0], matrix[..., 0, 0]),
        np.arctan2(matrix[..., 0, 2], matrix[..., 2, 2]),
    )
    z = np.where(locked, 0.0, np.arctan2(matrix[..., 1, 0], matrix[..., 1, 1]))
    return np.stack((y, np.arctan2(sine_x, cosine_x), z), axis=-1)


def to_matrix(q: ArrayLike) -> Floats:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def from_matrix(matrix: ArrayLike) -> Floats:
    """Unit quaternions (..., 4) of rotation matrices (..., 3, 3), w >= 0.

    Of the four ways to read a quaternion from a matrix, the one with the largest divisor.
    """
    m = np.asarray(matrix, dtype=np.float64)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    wx, wy, wz = (
        m[..., 2, 1] - m[..., 1, 2],
        m[..., 0, 2] - m[..., 2, 0],
        m[..., 1, 0] - m[..., 0, 1],
    )
    xy, xz, yz = (
        m[..., 1, 0] + m[..., 0, 1],
        m[..., 0, 2] + m[..., 2, 0],
        m[..., 2, 1] + m[..., 1, 2],
    )
    ways = np.stack(
        (
            np.stack((1.0 + xx + yy + zz, wx, wy, wz), axis=-1),
            np.stack((wx, 1.0 + xx - yy - zz, xy, xz), axis=-1),
            np.stack((wy, xy, 1.0 - xx + yy - zz, yz), axis=-1),
            np.stack((wz, xz, yz, 1.0 - xx - yy + zz), axis=-1),
        ),
        axis=-2,
    )
    divisors = np.diagonal(ways, axis1=-2, axis2=-1)
    best = np.argmax(divisors, axis=-1)[..., None, None]
    q = normalise(np.take_along_axis(ways, best, axis=-2)[..., 0, :])
    return np.where(q[..., :1] < 0.0, -q, q)


def to_forward_left_up(q: ArrayLike) -> Floats:
    """Quaternions given in the axes left, up, forward (X, Y, Z of the gait's maths), in the
    world's axes forward, left, up of a body whose heading is 0. Rotations of (..., 4)."""
    return np.asarray(q, dtype=np.float64)[..., [0, 3, 1, 2]]
