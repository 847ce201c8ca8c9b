import numpy as np
import pytest

from esplanade.actors.locomotion.gait import curves
from esplanade.actors.locomotion.reference import body_curves


def test_timing_of_a_cycle():
    at = body_curves.timing([1.0, 0.25])
    assert at.relative_length == pytest.approx((1.346, 0.673))
    assert at.cycle_s == pytest.approx((1.346, 2.692))
    assert at.support_s + at.balance_s == pytest.approx(at.cycle_s)
    assert at.double_support_s == pytest.approx(0.252 * at.cycle_s - 0.143)
    assert curves.support_share(np.array([1.0, 0.25])) == pytest.approx(at.support_s / at.cycle_s)


def test_the_pelvis_sways_over_the_standing_foot():
    """In the middle of the left leg's support the pelvis is to the left (X), and later right."""
    sideways = body_curves.pelvis_motion(np.array([0.4, 0.4]), np.array([0.35, 0.85])).left
    assert sideways[0] > 0.02
    assert sideways[1] == pytest.approx(-sideways[0])


def test_arms_swing_against_legs():
    arm_of_front_leg, arm_of_rear_leg = body_curves.upper_angles(
        np.array([0.4, 0.4]), np.array([0.0, 0.5])
    ).shoulder
    assert arm_of_front_leg < 0.0 < arm_of_rear_leg


def test_timing_needs_speed():
    with pytest.raises(ValueError, match="above 0"):
        body_curves.timing([0.0])
