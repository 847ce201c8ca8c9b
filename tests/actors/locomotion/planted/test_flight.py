"""Running steps: both feet are in the air at their ends."""

import numpy as np
import pytest

from esplanade.actors.locomotion.planted.step import step_targets
from tests.actors.locomotion import walks
from tests.naive.planted import step_targets as naive_targets

SHARES = np.linspace(0.0, 1.0, 41)
INTO_A_RUN_AND_OUT = walks.straight([0.3, 0.6, 0.9, 1.05, 1.1, 0.88, 0.6, 0.3, 0.0])


def test_running_steps_are_those_of_the_plain_twin() -> None:
    bend = walks.arc(4.0, 0.95, 5)
    for footprints in (INTO_A_RUN_AND_OUT, bend):
        found = step_targets(footprints, SHARES)
        assert (found.flight > 0.1).any()
        for one, other in zip(found, naive_targets(footprints, SHARES), strict=True):
            np.testing.assert_allclose(one, other, atol=1e-9)


def test_only_steps_that_legs_cannot_span_have_a_flight() -> None:
    targets = step_targets(walks.straight([0.3, 0.74, 0.86, 0.9, 1.0, 1.2]), SHARES)
    assert (targets.flight[:3] == 0.0).all()
    assert (np.diff(targets.flight[2:]) > 0.0).all()
    assert (step_targets(walks.staircase(0.25, 0.9, 4), SHARES).flight == 0.0).all()


def test_hips_of_runners_are_lowest_in_support_and_highest_in_flight() -> None:
    targets = step_targets(walks.straight([1.0, 1.0, 1.0, 1.0]), SHARES)
    heights = targets.root[2, :, 2]
    lowest, highest = SHARES[heights.argmin()], SHARES[heights.argmax()]
    assert lowest < 0.5
    assert highest > 1.0 - targets.flight[2]
    assert 0.03 < np.ptp(heights) < 0.1


def test_a_foot_that_was_in_the_air_is_not_pinned_when_it_swings() -> None:
    targets = step_targets(walks.straight([0.5, 1.0, 1.0, 0.5]), SHARES)
    assert targets.lift[:2] == pytest.approx(targets.lift[:2].clip(0.1, 0.5))
    assert (targets.lift[2:] == 0.0).all()
