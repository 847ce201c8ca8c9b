"""Steps that sum to a distance, with ramps at both ends."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors.locomotion.footsteps.planner import LONGEST_STEP, PREFERRED_STEP, plan_steps


@given(st.floats(1e-6, 200.0))
def test_any_distance_is_met_by_steps_that_can_be_walked(distance: float):
    steps = plan_steps(distance)
    assert math.isclose(math.fsum(steps), distance, rel_tol=1e-14)
    assert np.all(steps[:-1] > 0.0)
    assert np.max(steps) <= LONGEST_STEP
    assert steps[-1] == 0.0


def test_sums_are_exact_over_800_distances():
    errors = [abs(plan_steps(d).sum() - d) for d in np.linspace(0.01, 60.0, 800)]
    assert max(errors) < 1e-12


def test_a_long_way_speeds_up_and_slows_down():
    steps = plan_steps(20.0)[:-1]
    full = steps[len(steps) // 2]
    assert np.allclose(steps[:3] / full, [0.60, 0.85, 1.0])
    assert np.allclose(steps, steps[::-1])
    assert abs(full - PREFERRED_STEP) < 0.01


def test_no_other_number_of_steps_comes_closer_to_the_preferred_length():
    for distance in np.linspace(0.05, 30.0, 300):
        steps = plan_steps(distance, ramp=())[:-1]
        off = abs(steps.max() - PREFERRED_STEP)
        for count in (len(steps) - 1, len(steps) + 1):
            if count > 0 and distance / count <= LONGEST_STEP:
                assert off <= abs(distance / count - PREFERRED_STEP) + 1e-12


def test_nothing_to_walk_needs_no_step():
    assert plan_steps(0.0).shape == (0,)


def test_a_way_shorter_than_a_step_is_one_step_and_the_closing_one():
    assert plan_steps(0.3).tolist() == [0.3, 0.0]


@pytest.mark.parametrize("distance", [0.2, 1.1, 7.0, 33.3])
def test_jitter_changes_steps_but_not_where_they_lead(distance: float):
    plain = plan_steps(distance)
    random = np.random.default_rng(1)
    jittered = plan_steps(distance, jitter=0.1, random=random)
    assert len(jittered) == len(plain)
    assert abs(jittered.sum() - distance) < 1e-12
    assert np.all((jittered[:-1] > 0.0) & (jittered[:-1] <= LONGEST_STEP + 1e-12))
    if len(plain) > 2:
        assert np.max(np.abs(jittered - plain)) > 1e-3


def test_the_same_generator_gives_the_same_steps():
    once, again = (plan_steps(9.0, jitter=0.1, random=np.random.default_rng(7)) for _ in range(2))
    assert np.array_equal(once, again)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ({"distance": -1.0}, "distance"),
        ({"distance": math.nan}, "distance"),
        ({"distance": math.inf}, "distance"),
        ({"distance": 1e9}, "distance"),
        ({"distance": None}, "distance"),
        ({"distance": np.array([1.0, 2.0])}, "distance"),
        ({"distance": 5.0, "longest": 0.9}, "longest"),
        ({"distance": 5.0, "longest": 0.0}, "longest"),
        ({"distance": 5.0, "preferred": 0.7}, "preferred"),
        ({"distance": 5.0, "ramp": (0.5, 0.0)}, "ramp"),
        ({"distance": 5.0, "ramp": (1.5,)}, "ramp"),
        ({"distance": 5.0, "jitter": 0.9}, "jitter"),
        ({"distance": 5.0, "jitter": 0.1}, "random"),
    ],
)
def test_what_cannot_be_planned_is_named(arguments: dict, named: str):
    with pytest.raises(ValueError, match=named):
        plan_steps(**arguments)
