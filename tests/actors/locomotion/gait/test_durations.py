"""The durations of steps."""

import math

import pytest

from esplanade.actors.locomotion.gait.durations import LONGEST_S, SHORTEST_S, step_duration_s


def test_a_free_walk_keeps_its_relation_of_length_and_time():
    rv = 0.8
    cycle_length = 1.346 * math.sqrt(rv)
    assert math.isclose(step_duration_s(cycle_length / 2), cycle_length / rv / 2, rel_tol=1e-12)


def test_durations_stay_within_what_people_do():
    assert step_duration_s([0.0, 0.1, 0.5, 3.0]).tolist() == pytest.approx(
        [LONGEST_S, LONGEST_S, 0.905858, SHORTEST_S], abs=1e-6
    )


def test_negative_lengths_are_refused():
    with pytest.raises(ValueError, match="step_length"):
        step_duration_s([0.3, -0.1])
