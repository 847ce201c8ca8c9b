"""The phase of steps grows without a jump of its rate."""

import math

import numpy as np
import pytest

from esplanade.actors.locomotion.gait.durations import LONGEST_S, SHORTEST_S
from esplanade.actors.locomotion.reference.step_phase import boundary_rates, step_phase

SHARES = np.linspace(0.0, 1.0, 2001)


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
