"""Rotations: unit length, Euler angles there and back, gimbal lock, slerp."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors.locomotion.reference import rotations

EVERY_DEGREE = np.linspace(-math.pi, math.pi, 25)
X, Y, Z = np.eye(3)


def random_rotations(count: int) -> np.ndarray:
    return rotations.normalise(np.random.default_rng(3).normal(size=(count, 4)))


def test_product_is_the_second_rotation_then_the_first():
    a, b = random_rotations(2000).reshape(2, 1000, 4)
    matrices = rotations.to_matrix(a) @ rotations.to_matrix(b)
    assert np.allclose(rotations.to_matrix(rotations.multiply(a, b)), matrices, atol=1e-14)


def test_rotating_agrees_with_the_matrix():
    q = random_rotations(1000)
    vectors = np.random.default_rng(4).normal(size=(1000, 3))
    expected = np.einsum("nij,nj->ni", rotations.to_matrix(q), vectors)
    assert np.allclose(rotations.rotate(q, vectors), expected, atol=1e-14)


def test_a_quarter_turn_about_each_axis():
    quarter = math.pi / 2
    assert np.allclose(rotations.rotate(rotations.about(X, quarter), Y), Z, atol=1e-15)
    assert np.allclose(rotations.rotate(rotations.about(Y, quarter), Z), X, atol=1e-15)
    assert np.allclose(rotations.rotate(rotations.about(Z, quarter), X), Y, atol=1e-15)


def test_axes_broadcast_over_angles():
    q = rotations.about(X, EVERY_DEGREE)
    assert q.shape == (25, 4)
    assert np.allclose(np.linalg.norm(q, axis=-1), 1.0, atol=1e-15)


def test_inverse_undoes():
    q = random_rotations(100)
    assert np.allclose(rotations.multiply(q, rotations.inverse(q)), rotations.IDENTITY, atol=1e-15)


def test_matrix_there_and_back():
    q = np.concatenate((random_rotations(1000), np.eye(4), rotations.about(np.eye(3), math.pi)))
    again = rotations.from_matrix(rotations.to_matrix(q))
    assert np.max(rotations.angle_between(q, again)) < 1e-7
    assert np.allclose(np.abs(np.sum(q * again, axis=-1)), 1.0, atol=1e-14)


def test_euler_turns_y_then_x_then_z_about_carried_axes():
    y, x, z = 0.3, -0.7, 1.1
    step_by_step = rotations.multiply(
        rotations.multiply(rotations.about(Y, y), rotations.about(X, x)), rotations.about(Z, z)
    )
    assert np.allclose(rotations.from_euler([y, x, z]), step_by_step, atol=1e-15)


def test_euler_there_and_back_off_the_lock():
    random = np.random.default_rng(5)
    angles = random.uniform(-math.pi, math.pi, (5000, 3))
    angles[:, 1] = random.uniform(-1.57, 1.57, 5000)
    again = rotations.to_euler(rotations.from_euler(angles))
    assert np.max(np.abs(again - angles)) < 1e-10


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("off_rad", [0.0, 1e-12, 9e-8, 1.1e-7, 1e-6])
def test_in_gimbal_lock_the_rotation_survives(side: float, off_rad: float):
    y, z = np.meshgrid(EVERY_DEGREE, EVERY_DEGREE)
    x = np.full_like(y, side * (math.pi / 2 - off_rad))
    q = rotations.from_euler(np.stack((y, x, z), axis=-1))
    again = rotations.to_euler(q)
    assert np.all(np.isfinite(again))
    difference = rotations.to_matrix(rotations.from_euler(again)) - rotations.to_matrix(q)
    assert np.max(np.abs(difference)) < 1e-6
    if off_rad < 1e-8:
        assert np.all(again[..., 2] == 0.0)


def test_slerp_keeps_length_ends_and_pace():
    a, b = random_rotations(2000).reshape(2, 1000, 4)
    whole = rotations.angle_between(a, b)
    for share in np.linspace(0.0, 1.0, 11):
        q = rotations.slerp(a, b, np.full(1000, share))
        assert np.max(np.abs(np.linalg.norm(q, axis=-1) - 1.0)) < 1e-12
        assert np.max(np.abs(rotations.angle_between(a, q) - share * whole)) < 1e-7


def test_slerp_of_the_same_rotation_written_twice_stays_there():
    a = random_rotations(100)
    for b in (a, -a, rotations.normalise(-a + 1e-9)):
        q = rotations.slerp(a, b, np.full(100, 0.37))
        assert np.all(np.isfinite(q))
        assert np.max(rotations.angle_between(a, q)) < 1e-7


@given(st.floats(0.0, 1.0), st.floats(-3.1, 3.1))
def test_slerp_about_one_axis_is_the_share_of_the_angle(share: float, angle: float):
    q = rotations.slerp(rotations.IDENTITY, rotations.about(Y, angle), share)
    assert np.allclose(q, rotations.about(Y, share * angle), atol=1e-12)


def test_axes_of_the_gait_become_axes_of_the_world():
    q = random_rotations(10)
    left, up, forward = 0.3, -0.2, 0.9
    turned = rotations.rotate(q, [left, up, forward])
    in_world = rotations.rotate(rotations.to_forward_left_up(q), [forward, left, up])
    assert np.allclose(in_world, turned[:, [2, 0, 1]], atol=1e-14)
