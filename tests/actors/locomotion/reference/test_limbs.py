import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import SHIN, THIGH, leg_points
from esplanade.actors.locomotion.reference import limbs


def drawn_angles(count, seed=2):
    rng = np.random.default_rng(seed)
    return limbs.LegAngles(
        rng.uniform(-0.9, 0.9, count),
        rng.uniform(-0.6, 0.6, count),
        rng.uniform(-0.7, 1.2, count),
        rng.uniform(0.05, 2.4, count),
    )


def test_angles_come_back():
    wanted = drawn_angles(2000)
    down = wanted.flexion - wanted.knee > -np.pi / 2  # else the ankle may be above the hip
    wanted = limbs.LegAngles(*(angle[down] for angle in wanted))
    _, ankle = limbs.leg_ends(wanted)
    found, missed = limbs.leg_ik(ankle, wanted.yaw)
    assert down.sum() > 1000
    for got, expected in zip(found, wanted, strict=True):
        assert got == pytest.approx(expected, abs=1e-11)
    assert missed == pytest.approx(np.zeros(len(missed)), abs=1e-12)


def test_points_come_back():
    rng = np.random.default_rng(4)
    direction = rng.normal(size=(2000, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    ankle = direction * rng.uniform(0.07, 0.999, 2000)[:, None]
    found, missed = limbs.leg_ik(ankle, rng.uniform(-3.0, 3.0, 2000))
    assert missed.max() < 1e-12
    knee, reached = limbs.leg_ends(found)
    assert reached == pytest.approx(ankle, abs=1e-9)
    assert np.linalg.norm(knee, axis=1) == pytest.approx(np.full(2000, THIGH))
    assert np.linalg.norm(reached - knee, axis=1) == pytest.approx(np.full(2000, SHIN))


def test_a_leg_of_the_curves_is_a_special_case():
    flexion, knee = np.radians([20.0, -12.0]), np.radians([3.0, 40.0])
    straight = limbs.LegAngles(np.zeros(2), np.zeros(2), flexion, knee)
    knee_at, ankle_at = limbs.leg_ends(straight)
    sagittal = leg_points(np.column_stack([flexion, knee, np.zeros(2)]))
    assert knee_at[:, [0, 2]] == pytest.approx(sagittal[0])
    assert ankle_at[:, [0, 2]] == pytest.approx(sagittal[1])
    assert ankle_at[:, 1] == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize(
    ("ankle", "missed"),
    [
        ((0.0, 0.0, 0.0), SHIN - THIGH),
        ((0.0, 0.0, -1.5), 0.5),
        ((2.0, 0.0, 0.0), 1.0),
        ((0.0, 0.0, -0.01), SHIN - THIGH - 0.01),
    ],
)
def test_out_of_reach_says_by_how_much(ankle, missed):
    angles, residual = limbs.leg_ik(np.array([ankle]), np.array([0.3]))
    assert residual[0] == pytest.approx(missed)
    assert np.all(np.isfinite(np.array(angles)))
    reached = limbs.leg_ends(angles)[1][0]
    assert np.linalg.norm(reached - ankle) == pytest.approx(missed)


def test_knees_bend_forward_of_the_line_to_the_ankle():
    angles, _ = limbs.leg_ik(np.array([[0.0, 0.0, -0.8]]), np.array([0.5]))
    knee = limbs.leg_ends(angles)[0][0]
    assert knee[0] > 0.1
    assert knee[1] / knee[0] == pytest.approx(np.tan(0.5))


def test_a_leg_by_hand():
    """Right angle at the knee: legs of a right triangle."""
    angles, _ = limbs.leg_ik(np.array([[0.0, 0.0, -np.hypot(THIGH, SHIN)]]), np.zeros(1))
    assert angles.knee[0] == pytest.approx(np.pi / 2)
    assert np.tan(angles.flexion[0]) == pytest.approx(SHIN / THIGH)
