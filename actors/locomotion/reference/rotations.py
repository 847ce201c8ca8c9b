"""Rotations as unit quaternions w x y z: products, Euler angles about Y, X, Z, slerp.

All functions take any leading shape and broadcast. A quaternion turns a vector v into q v q*, so
`multiply(a, b)` is first b, then a. Conversions are scipy's. Products, turned vectors and slerp
stay plain arithmetic on arrays: scipy's product of (4000, 16) rotations takes 20 times as long, and
its Slerp goes through the keys of one curve, not through pairs.
"""

from __future__ import annotations

import warnings
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

Floats = NDArray[np.float64]

IDENTITY: Final[Floats] = np.array([1.0, 0.0, 0.0, 0.0])
IDENTITY.setflags(write=False)

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
    angles = np.asarray(angles_rad, dtype=np.float64)
    turned = Rotation.from_euler("YXZ", angles.reshape(-1, 3))
    return _shaped(turned.as_quat(scalar_first=True), angles, 4)


def to_euler(q: ArrayLike) -> Floats:
    """Angles (..., 3) about Y, X, Z, radians: M = R_y R_x R_z; X lies in [-pi/2, pi/2].

    Where X is a quarter turn, Y and Z turn about the same axis (gimbal lock) and only their sum
    or difference is known: all of it goes into Y, and Z is 0.
    """
    values = np.asarray(q, dtype=np.float64)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock", category=UserWarning)
        angles = _rotation(values).as_euler("YXZ")
    return _shaped(angles, values, 3)


def to_matrix(q: ArrayLike) -> Floats:
    """Rotation matrices (..., 3, 3) of unit quaternions (..., 4)."""
    values = np.asarray(q, dtype=np.float64)
    return _shaped(_rotation(values).as_matrix(), values, 3, 3)


def from_matrix(matrix: ArrayLike) -> Floats:
    """Unit quaternions (..., 4) of rotation matrices (..., 3, 3), w >= 0."""
    values = np.asarray(matrix, dtype=np.float64)
    turned = Rotation.from_matrix(values.reshape(-1, 3, 3))
    return _shaped(turned.as_quat(canonical=True, scalar_first=True), values[..., 0], 4)


def _rotation(q: Floats) -> Rotation:
    return Rotation.from_quat(q.reshape(-1, 4), scalar_first=True)


def _shaped(rows: Floats, like: Floats, *shape: int) -> Floats:
    """One row for each of the quaternions, angles or matrices, in the shape that they had."""
    return rows.reshape(*like.shape[:-1], *shape)


def to_forward_left_up(q: ArrayLike) -> Floats:
    """Quaternions given in the axes left, up, forward (X, Y, Z of the gait's maths), in the
    world's axes forward, left, up of a body whose heading is 0. Rotations of (..., 4)."""
    return np.asarray(q, dtype=np.float64)[..., [0, 3, 1, 2]]
