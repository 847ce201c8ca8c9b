"""Rotations of a body as angles, and back."""

import numpy as np
from scipy.spatial.transform import Rotation

from esplanade.protocol.quaternions import Floats, from_angles, from_twist, to_angles, to_twist


def angles(count: int) -> Floats:
    random = np.random.default_rng(1)
    high = np.array([np.pi, 1.5, np.pi])
    return np.asarray(random.uniform(-high, high, (count, 3)))


def test_angles_come_back() -> None:
    known = angles(10_000)
    np.testing.assert_allclose(to_angles(from_angles(known)), known, atol=1e-12)
    np.testing.assert_allclose(to_angles(-from_angles(known)), known, atol=1e-12)


def test_a_body_rolls_then_leans_then_turns() -> None:
    known = angles(100)
    turned = Rotation.from_euler("ZYX", known).as_quat()[:, [3, 0, 1, 2]]
    same = np.sign(np.einsum("nd,nd->n", turned, from_angles(known)))[:, None]
    np.testing.assert_allclose(from_angles(known) * same, turned, atol=1e-12)


def test_upside_down_the_angles_are_numbers_still() -> None:
    upright = from_angles(np.array([[0.3, np.pi / 2, 0.1], [0.3, -np.pi / 2, 0.1]]))
    assert np.isfinite(to_angles(upright * (1.0 + 1e-12))).all()


def test_a_chest_stays_level_and_twists() -> None:
    roll, twist = np.random.default_rng(2).uniform(-0.4, 0.4, (2, 1000))
    chests = from_twist(twist, roll)
    np.testing.assert_allclose(to_twist(chests, roll), twist, atol=1e-12)
    np.testing.assert_allclose(to_twist(-chests, roll), twist, atol=1e-12)
    zero = np.zeros(1000)
    pelvises = Rotation.from_quat(
        from_angles(np.stack([zero, zero, roll], axis=1))[:, [1, 2, 3, 0]]
    )
    up = (pelvises * Rotation.from_quat(chests[:, [1, 2, 3, 0]])).apply([0.0, 0.0, 1.0])
    np.testing.assert_allclose(up, np.broadcast_to([0.0, 0.0, 1.0], up.shape), atol=1e-12)
