"""Rotations in few bytes. Quaternions are w, x, y, z in the last axis, of length 1.

q and -q are the same rotation: what is unpacked may have the other sign.
"""

from typing import Final

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

SMALLEST_THREE: Final = np.sqrt(0.5) / 16383.0
"""Quantum of components that are at most the root of 1/2, in 15 bits with a sign."""

NEAR_IDENTITY: Final = 0.5 / 127.0
"""Quantum of x, y, z of a small rotation in 8 bits with a sign."""

_EXACT: Final = 1e-6
"""A component is a multiple of its quantum if it is no more of them away from one."""
_LARGE: Final = 0.49
"""A component that is left out is larger than this."""
_ZERO: Final = 0x4000
_VALUE_BITS: Final = 0x7FFF
_OTHERS: Final = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
"""The three other components, by the place of the largest one."""


def pack_smallest_three(quaternions: Floats) -> npt.NDArray[np.uint16]:
    """Pack any rotations, float64 (..., 4), into three words each, uint16 (..., 3).

    They are at most 0.01 degrees off. The largest of the four components is left out. The low 15
    bits of each word are one of the others, in their order, plus 0x4000. The top bits of the first
    and the second word are the low and the high bit of the place of the one left out. A
    rotation that was unpacked is packed alike again: the component that was left out of it is known
    by the others, which are multiples of their quantum, even if rounding made another one larger.
    """
    return _pack_once(unpack_smallest_three(_pack_once(quaternions)))


def _left_out(quaternions: Floats) -> npt.NDArray[np.int64]:
    """The place of the component that is left out of each, int64 (...)."""
    multiples = quaternions / SMALLEST_THREE
    exact = np.abs(multiples - np.rint(multiples)) < _EXACT
    exact &= np.abs(multiples) < _ZERO - 0.5
    without = np.stack([exact[..., others].all(axis=-1) for others in _OTHERS], axis=-1)
    without &= np.abs(quaternions) > _LARGE
    largest = np.abs(quaternions).argmax(axis=-1)
    places: npt.NDArray[np.int64] = np.where(without.any(axis=-1), without.argmax(axis=-1), largest)
    return places


def _pack_once(quaternions: Floats) -> npt.NDArray[np.uint16]:
    place = _left_out(quaternions)[..., None]
    largest = np.take_along_axis(quaternions, place, axis=-1)
    others = np.take_along_axis(quaternions, _OTHERS[place[..., 0]], axis=-1)
    words = np.rint(np.copysign(others, others * largest) / SMALLEST_THREE).astype(np.int64)
    words = np.clip(words, -_ZERO + 1, _ZERO - 1) + _ZERO
    words[..., :2] |= np.concatenate([place & 1, place >> 1], axis=-1) << 15
    packed: npt.NDArray[np.uint16] = words.astype(np.uint16)
    return packed


def unpack_smallest_three(words: npt.NDArray[np.uint16]) -> Floats:
    """Unpack what `pack_smallest_three` made: rotations, float64 (..., 4)."""
    place = ((words[..., 0] >> 15) | (words[..., 1] >> 15 << 1)).astype(np.int64)
    others = ((words & _VALUE_BITS).astype(np.int64) - _ZERO) * SMALLEST_THREE
    quaternions = np.empty((*words.shape[:-1], 4))
    np.put_along_axis(quaternions, place[..., None], _missing(others), axis=-1)
    np.put_along_axis(quaternions, _OTHERS[place], others, axis=-1)
    return _unit(quaternions)


def pack_near_identity(quaternions: Floats) -> npt.NDArray[np.int8]:
    """Pack small rotations, float64 (..., 4), into their x, y, z with w >= 0, int8 (..., 3).

    Each of x, y, z is clamped to 0.5, which is a turn by 60 degrees about one axis. Within that
    rotations are at most 0.7 degrees off, and below 0.5 degrees if they are up to 60 degrees.
    """
    upward = quaternions[..., 1:] * np.where(quaternions[..., :1] < 0.0, -1.0, 1.0)
    packed: npt.NDArray[np.int8] = np.rint(upward / NEAR_IDENTITY).clip(-0x7F, 0x7F).astype(np.int8)
    return packed


def unpack_near_identity(vectors: npt.NDArray[np.int8]) -> Floats:
    """Unpack what `pack_near_identity` made: rotations, float64 (..., 4)."""
    others: Floats = vectors.astype(np.float64) * NEAR_IDENTITY
    return _unit(np.concatenate([_missing(others), others], axis=-1))


def _missing(others: Floats) -> Floats:
    """The component, never negative, that makes the length 1."""
    rest: Floats = 1.0 - np.square(others).sum(axis=-1, keepdims=True)
    return np.sqrt(np.maximum(rest, 0.0))


def _unit(quaternions: Floats) -> Floats:
    unit: Floats = quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True)
    return unit
