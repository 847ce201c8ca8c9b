import numpy as np
import pytest

from esplanade.actors.locomotion.gait import step_length
from esplanade.actors.locomotion.gait.step_length import sl_planted, solve_relative_velocity
from esplanade.actors.locomotion.reference.published_lengths import sl_noslide, sl_paper

LENGTHS = np.arange(1, 16) * 0.05
PAPER = """.035827 .068113 .100452 .132868 .165385 .198028 .230823 .263796 .296976 .330391
           .364073 .398055 .432373 .467066"""
NOSLIDE = """.034957 .066918 .098879 .130862 .162891 .194988 .227175 .259478 .291920 .324526
             .357323 .390339 .423603 .457146 .491000"""
PLANTED = """.035049 .068099 .100418 .132804 .165279 .197867 .230590 .263475 .296547 .329832
             .363361 .397162 .431269 .465717"""


@pytest.mark.parametrize(
    ("length", "velocities"), [(sl_paper, PAPER), (sl_noslide, NOSLIDE), (sl_planted, PLANTED)]
)
def test_known_velocities_give_known_lengths(length, velocities):
    velocities = np.array([float(word) for word in velocities.split()])
    assert length(velocities) == pytest.approx(LENGTHS[: len(velocities)], abs=3e-6)


@pytest.mark.parametrize("length", [sl_paper, sl_noslide, sl_planted])
def test_a_faster_step_is_longer(length):
    velocities = np.linspace(0.0, 0.5, 2001)
    slopes = np.diff(length(velocities)) / np.diff(velocities)
    assert slopes.min() > 1.37


def test_ranges():
    assert sl_planted(0.0) == 0.0
    assert sl_planted(0.5) == pytest.approx(0.7492, abs=1e-4)
    assert sl_noslide(0.5) == pytest.approx(0.7632, abs=1e-4)
    assert step_length.longest_step() == sl_planted(0.5)


def test_velocity_of_a_length_is_exact():
    lengths = np.concatenate(
        [[0.0, step_length.longest_step()], np.random.default_rng(3).uniform(0.0, 0.749, 1000)]
    )
    velocities = solve_relative_velocity(lengths)
    assert sl_planted(velocities) == pytest.approx(lengths, abs=1e-12)
    assert velocities[0] == 0.0
    assert velocities[1] == pytest.approx(0.5)


def test_velocity_of_a_length_agrees_with_halving_the_interval():
    for wanted in (0.01, 0.2, 0.5, 0.74):
        low, high = 0.0, 0.5
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (low, middle) if sl_planted(middle) > wanted else (middle, high)
        assert solve_relative_velocity([wanted])[0] == pytest.approx(low, abs=1e-12)


@pytest.mark.parametrize("length", [-0.01, 0.76, np.nan])
def test_lengths_that_no_step_has(length):
    with pytest.raises(ValueError, match="step lengths"):
        solve_relative_velocity([0.3, length])


def test_velocities_without_a_length():
    with pytest.raises(ValueError, match="relative velocities"):
        sl_planted([0.6])
