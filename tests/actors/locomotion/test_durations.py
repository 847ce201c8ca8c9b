"""How long steps take; the phase grows without a jump of its rate."""

import math

import numpy as np
import pytest

from esplanade.actors.locomotion.durations import (
    LONGEST_S,
    SHORTEST_S,
    boundary_rates,
    step_duration_s,
    step_phase,
)

SHARES = np.linspace(0.0, 1.0, 2001)


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


@pytest.mark.parametrize("bad", [[], [0.5, 0.0], [[0.5]], [0.5, math.nan]])
def test_durations_must_be_positive(bad: list):
    with pytest.raises(ValueError, match="durations_s"):
        boundary_rates(bad)


def test_phase_grows_everywhere_and_its_rate_never_jumps():
    durations = np.random.default_rng(2).uniform(SHORTEST_S, LONGEST_S, 500)
    rates = boundary_rates(durations)
    phases = step_phase(SHARES[:, None], durations, rates[:-1], rates[1:])
    assert np.allclose(phases[0], 0.0, atol=1e-15)
    assert np.allclose(phases[-1], 1.0, atol=1e-15)
    local = np.diff(phases, axis=0) / np.diff(SHARES)[:, None]
    assert local.min() > 0.62
    # A second's rate at the end of each step and at the beginning of the next.
    ends, begins = local[-1] / durations, local[0] / durations
    assert np.max(np.abs(ends[:-1] - begins[1:])) < 0.005
