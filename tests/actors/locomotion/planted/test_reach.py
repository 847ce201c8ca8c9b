import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.planted import _reach_kernels as reach


def test_distances_are_eased_only_near_the_end():
    assert [reach.soft_reach(distance) for distance in (0.3, 0.9, 0.99)] == [0.3, 0.9, 0.99]
    far = np.array([reach.soft_reach(distance) for distance in np.linspace(0.98, 1.01, 500)])
    assert np.all(np.diff(far) > 0.0)
    assert reach.soft_reach(5.0) == reach.FULL


def test_easing_has_no_corner():
    distance = np.linspace(0.99, 1.0, 2001)
    kept = np.array([reach.soft_reach(value) for value in distance])
    slopes = np.diff(kept) / np.diff(distance)
    assert np.abs(np.diff(slopes)).max() < 2e-3


def test_a_heel_rises_just_as_far_as_needed():
    """Against a search over the circle of the heel about the toe."""
    rng = np.random.default_rng(9)
    circle = np.linspace(0.0, np.radians(75.0), 2001)
    raised = 0
    for _ in range(200):
        hip = rng.uniform((-0.1, -0.3, 0.85), (0.75, 0.3, 0.95))
        pitch = -rng.uniform(0.0, 0.2)

        def away(angle, hip=hip):
            ankle = FOOT * np.stack([-np.cos(angle), np.zeros_like(angle), np.sin(angle)], -1)
            return np.linalg.norm(hip - ankle, axis=-1)

        wanted = reach.soft_reach(away(np.array(-pitch)))
        found = reach.raised_heel(*hip, pitch)
        assert found <= pitch
        if -np.radians(74.0) < found < pitch and away(circle).min() < wanted:
            raised += 1
            assert away(np.array(-found)) == pytest.approx(wanted, abs=1e-9)
            between = circle[(circle > -pitch) & (circle < -found - 1e-3)]
            assert np.all(away(between) > wanted)
    assert raised > 40


@pytest.mark.parametrize("pitch", [0.0, -0.3])
def test_a_heel_in_reach_stays(pitch):
    assert reach.raised_heel(-0.1, 0.0, 0.9, pitch) == pitch


def test_a_heel_out_of_all_reach_is_still_a_number():
    assert -np.radians(76.0) < reach.raised_heel(3.0, 0.0, 1.0, 0.0) <= 0.0


def test_how_much_a_hip_is_too_high():
    assert reach.excess_height(0.6, 0.0, 1.9, 1.0) == pytest.approx(1.1)
    assert reach.excess_height(0.6, 0.0, 0.7, 1.0) == 0.0
    assert np.isfinite(reach.excess_height(9.0, 0.0, 2.0, 1.0))
