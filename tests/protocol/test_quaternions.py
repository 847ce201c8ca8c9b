"""Rotations in few bytes: what comes back is near, whichever component is the largest."""

import numpy as np
import pytest

from esplanade.protocol.quaternions import (
    Floats,
    pack_near_identity,
    pack_smallest_three,
    unpack_near_identity,
    unpack_smallest_three,
)


def worst_degrees(one: Floats, other: Floats) -> float:
    apart = np.minimum(np.linalg.norm(one - other, axis=-1), np.linalg.norm(one + other, axis=-1))
    return float(np.degrees(4.0 * np.arcsin(apart / 2.0)).max())


def rotations(count: int) -> Floats:
    quaternions = np.random.default_rng(1).normal(size=(count, 4))
    unit: Floats = quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True)
    return unit


def test_any_rotation_within_a_hundredth_of_a_degree() -> None:
    known = rotations(100_000)
    assert worst_degrees(unpack_smallest_three(pack_smallest_three(known)), known) < 0.01


@pytest.mark.parametrize("place", range(4))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_turns_about_the_axes_come_back_exactly(place: int, sign: float) -> None:
    known = np.zeros(4)
    known[place] = sign
    read = unpack_smallest_three(pack_smallest_three(known))
    np.testing.assert_array_equal(np.abs(read), np.abs(known))


@pytest.mark.parametrize("known", [(0.5, 0.5, -0.5, 0.5), (0.5**0.5, 0.0, 0.0, -(0.5**0.5))])
def test_ties_for_the_largest(known: tuple[float, ...]) -> None:
    quaternion = np.array(known)
    read = unpack_smallest_three(pack_smallest_three(quaternion))
    assert worst_degrees(read, quaternion) < 0.01


def test_what_is_read_is_packed_alike() -> None:
    """Even where rounding changes which component is the largest."""
    near = np.random.default_rng(2).normal(0.0, 2e-5, (20_000, 4))
    tied = np.concatenate([near + known for known in ((1, 0, 0, 1), (1, 1, 1, -1), (0, 1, -1, 0))])
    known = np.concatenate([rotations(20_000), tied])
    words = pack_smallest_three(known / np.linalg.norm(known, axis=-1, keepdims=True))
    np.testing.assert_array_equal(pack_smallest_three(unpack_smallest_three(words)), words)


def test_small_rotations_in_three_bytes() -> None:
    known = rotations(100_000)
    known = known[np.abs(known[:, 1:]).max(axis=1) <= 0.5]
    read = unpack_near_identity(pack_near_identity(known))
    assert worst_degrees(read, known) < 0.7
    small = np.abs(known[:, 0]) > np.cos(np.radians(30.0))
    assert worst_degrees(read[small], known[small]) < 0.5


def test_no_rotation_is_exact() -> None:
    nothing = np.array([1.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(unpack_near_identity(pack_near_identity(nothing)), nothing)
    np.testing.assert_array_equal(unpack_near_identity(pack_near_identity(-nothing)), nothing)


def test_rotations_that_are_too_large_for_three_bytes_are_held_back() -> None:
    read = unpack_near_identity(pack_near_identity(np.array([0.0, 1.0, 0.0, 0.0])))
    np.testing.assert_allclose(read, [np.sqrt(0.75), 0.5, 0.0, 0.0])
