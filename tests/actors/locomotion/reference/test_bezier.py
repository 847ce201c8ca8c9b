"""Bezier weights: they sum to 1 and keep the ends."""

import numpy as np
import pytest

from esplanade.actors.locomotion.reference.bezier import bernstein, blend, blend_level

SHARES = np.linspace(0.0, 1.0, 1001)


@pytest.mark.parametrize("count", range(1, 9))
def test_weights_sum_to_one_and_are_never_negative(count: int):
    weights = bernstein(count, SHARES)
    assert np.max(np.abs(weights.sum(axis=-1) - 1.0)) < 1e-15
    assert weights.min() >= 0.0


def test_the_ends_are_exactly_the_first_and_the_last_pose():
    poses = np.random.default_rng(1).normal(size=(6, 3, 2))
    assert np.array_equal(blend(poses, np.zeros(3)), poses[0])
    assert np.array_equal(blend(poses, np.ones(3)), poses[-1])


def test_poses_between_bend_the_way_but_not_its_ends():
    poses = np.array([0.0, 5.0, 1.0]).reshape(3, 1, 1)
    assert blend(poses, np.array([0.5]))[0, 0] == pytest.approx(2.75)


def test_level_blending_is_a_smooth_step():
    count = len(SHARES)
    mixed = blend_level(np.zeros((count, 1)), np.ones((count, 1)), SHARES)[:, 0]
    assert np.allclose(mixed, 3 * SHARES**2 - 2 * SHARES**3, atol=1e-15)


@pytest.mark.parametrize(("count", "u"), [(0, 0.5), (3, -0.1), (3, 1.1), (3, float("nan"))])
def test_what_makes_no_sense_is_refused(count: int, u: float):
    with pytest.raises(ValueError, match=r"count|u must"):
        bernstein(count, u)
