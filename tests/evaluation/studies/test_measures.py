"""Means over recordings and their bootstrap intervals."""

from dataclasses import replace

import numpy as np
import pytest

from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.simulation import Environment, run_episode
from esplanade.evaluation.studies.measures import (
    MEASURES,
    RESAMPLES,
    bootstrap,
    mean_over_recordings,
    named,
    percentile_interval,
    table,
)
from tests.evaluation.worlds import RULES, replay, trip, walk


def column(*values: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """A table with one measure."""
    return np.array([values]).T


def test_a_table_has_a_row_for_each_episode_and_a_column_for_each_measure() -> None:
    place = Environment.of(replay(walk("1", 0.0, (0, 0), (10, 0)), walk("2", 0.0, (10, 0), (0, 0))))
    score = run_episode(place, trip(place.replay), make_policy("straight"), RULES).score
    lost = replace(score, reached=False, time_ratio=np.nan)
    rows = table([score, lost])
    assert rows.shape == (2, len(MEASURES))
    touched, gone = (named(row) for row in rows)
    assert touched["contacts_percent"] == 100.0
    assert touched["near_s"] == score.near_s
    assert touched["missed_percent"] == 0.0
    assert gone["missed_percent"] == 100.0
    assert np.isnan(gone["time_ratio"])


def test_every_recording_weighs_the_same_however_many_episodes_it_has() -> None:
    assert mean_over_recordings([column(0.0, 0.0, 3.0), column(5.0)]).tolist() == [3.0]


def test_episodes_without_a_figure_are_left_out() -> None:
    assert mean_over_recordings([column(2.0, np.nan), column(4.0, 4.0)]).tolist() == [3.0]
    assert np.isnan(mean_over_recordings([column(np.nan)])[0])


def test_resamples_scatter_as_the_mean_of_so_many_episodes_does() -> None:
    values = np.random.default_rng(3).normal(5.0, 2.0, (400, 1))
    resamples = bootstrap([values], seed=0)
    assert resamples.shape == (RESAMPLES, 1)
    assert resamples.std() == pytest.approx(2.0 / np.sqrt(400), rel=0.15)
    low, high = percentile_interval(resamples)
    assert low[0] < mean_over_recordings([values])[0] < high[0]
    assert high[0] - low[0] == pytest.approx(2 * 1.96 * 0.1, rel=0.15)


def test_the_same_seed_draws_the_same_episodes_of_every_table() -> None:
    rng = np.random.default_rng(4)
    first, second = rng.normal(size=(2, 50, 1))
    together = [first, second]
    shifted = [first + 1.0, second + 1.0]
    difference = bootstrap(shifted, seed=7) - bootstrap(together, seed=7)
    np.testing.assert_allclose(difference, 1.0)
    assert not np.array_equal(bootstrap(together, seed=7), bootstrap(together, seed=8))
