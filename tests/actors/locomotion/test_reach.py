import numpy as np
import pytest

from actors.locomotion import _reach as reach
from actors.locomotion.skeleton import FOOT


def test_distances_are_eased_only_near_the_end():
    distance = np.array([0.3, 0.9, 0.99, 1.0, 1.2, 5.0])
    kept = reach.eased(distance)
    assert kept[:3] == pytest.approx(distance[:3])
    assert np.all(kept <= reach.FULL)
    assert np.all(np.diff(reach.eased(np.linspace(0.98, 1.01, 500))) > 0.0)


def test_easing_has_no_corner():
    distance = np.linspace(0.99, 1.0, 20001)
    slopes = np.diff(reach.eased(distance)) / np.diff(distance)
    assert np.abs(np.diff(slopes)).max() < 1e-3


def test_feet_in_the_air_are_drawn_along_the_leg():
    hip, ankle = np.array([[0.2, 0.1, 1.0]]), np.array([[0.9, 0.1, 0.0]])
    drawn = reach.drawn_to_hip(hip, ankle)
    assert np.linalg.norm(drawn - hip) <= reach.FULL + 1e-12
    assert np.cross(drawn - hip, ankle - hip)[0] == pytest.approx(np.zeros(3), abs=1e-12)
    near = hip - (0.0, 0.0, 0.8)
    assert reach.drawn_to_hip(hip, near) == pytest.approx(near)


def test_a_heel_rises_just_as_far_as_needed():
    """Against a search over the circle of the heel about the toe."""
    rng = np.random.default_rng(9)
    circle = np.linspace(0.0, np.radians(75.0), 2001)
    raised = 0
    for _ in range(200):
        hip = rng.uniform((-0.1, -0.3, 0.85), (0.75, 0.3, 0.95))
        heading = rng.uniform(-3.0, 3.0)
        ahead = np.array([np.cos(heading), np.sin(heading), 0.0])
        toe = -ahead * rng.uniform(0.0, 0.3)
        pitch = -rng.uniform(0.0, 0.2)

        def away(angle, hip=hip, toe=toe, ahead=ahead):
            up = np.array([0.0, 0.0, 1.0])
            ankle = toe + FOOT * (np.outer(np.sin(angle), up) - np.outer(np.cos(angle), ahead))
            return np.linalg.norm(hip - ankle, axis=1)

        wanted = reach.eased(away(np.array([-pitch])))[0]
        found = reach.raised_heel(hip[None], toe[None], np.array([heading]), np.array([pitch]))[0]
        assert found <= pitch
        if found < pitch and found > -np.radians(74.0) and away(circle).min() < wanted:
            raised += 1
            assert away(np.array([-found]))[0] == pytest.approx(wanted, abs=1e-9)
            between = circle[(circle > -pitch) & (circle < -found - 1e-3)]
            assert np.all(away(between) > wanted)
    assert raised > 40


def test_a_heel_in_reach_stays():
    pitch = np.array([0.0, -0.3])
    hip = np.array([[0.1, 0.0, 0.9], [0.1, 0.0, 0.9]])
    toe = np.array([[0.2, 0.0, 0.0], [0.2, 0.0, 0.0]])
    assert np.array_equal(reach.raised_heel(hip, toe, np.zeros(2), pitch), pitch)


def test_a_heel_out_of_all_reach_is_still_a_number():
    far = reach.raised_heel(np.array([[3.0, 0.0, 1.0]]), np.zeros((1, 3)), np.zeros(1), np.zeros(1))
    assert -np.radians(76.0) < far[0] <= 0.0


def test_how_high_a_hip_may_be():
    ankle = np.array([[0.0, 0.0, 0.1], [0.0, 0.0, 0.1]])
    hip = np.array([[0.6, 0.0, 2.0], [9.0, 0.0, 2.0]])
    ceiling = reach.hip_ceiling(hip, ankle, 1.0)
    assert ceiling[0] == pytest.approx(0.9)
    assert np.isfinite(ceiling[1])
