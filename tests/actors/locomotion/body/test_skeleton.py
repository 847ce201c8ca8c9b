import numpy as np
import pytest

from esplanade.actors.locomotion.body import skeleton


def test_lengths_add_up_to_one_leg():
    leg = skeleton.THIGH + skeleton.SHIN
    assert leg == pytest.approx(1.0)


def test_a_straight_leg_hangs_down_with_its_foot_flat():
    knee, heel, toe = skeleton.leg_points(np.zeros((1, 3)))
    assert knee[0] == pytest.approx((0.0, -skeleton.THIGH))
    assert heel[0] == pytest.approx((0.0, -1.0))
    assert toe[0] == pytest.approx((skeleton.FOOT, -1.0))


def test_hip_flexion_brings_the_leg_forward_and_the_knee_brings_the_heel_back():
    hip_only = skeleton.leg_points(np.radians([[90.0, 0.0, 0.0]]))[1][0]
    bent = skeleton.leg_points(np.radians([[90.0, 90.0, 0.0]]))[1][0]
    assert hip_only == pytest.approx((1.0, 0.0))
    assert bent == pytest.approx((skeleton.THIGH, -skeleton.SHIN))


def test_pitch_is_where_the_toe_points():
    angles = np.radians(np.random.default_rng(1).uniform(-60.0, 60.0, (50, 3)))
    _, heel, toe = skeleton.leg_points(angles)
    forward, up = (toe - heel).T
    assert np.arctan2(up, forward) == pytest.approx(
        np.arctan2(np.sin(skeleton.foot_pitch(angles)), np.cos(skeleton.foot_pitch(angles)))
    )
