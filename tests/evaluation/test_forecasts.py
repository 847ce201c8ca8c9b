"""Predictions compared with what people did, and their scores."""

import numpy as np
import pytest

from esplanade.evaluation.calibration import pool, score_forecasts
from esplanade.evaluation.forecasts import STEPS, Forecasts, ahead_s, forecast
from esplanade.planning import GAUSSIAN, PEOPLE, PredictionModel, Spread
from esplanade.recordings import Crowd, Obstacles, Track, read_crowd
from tests.evaluation.worlds import crowd, drawn, walk
from tests.recordings.data import recorded

MODEL = PredictionModel()


def forecast_of(*tracks: Track, sample_s: float = 0.4) -> Forecasts:
    return forecast(crowd(*tracks), Obstacles(), MODEL, sample_s)


@pytest.mark.parametrize("sample_s", [0.4, 0.2, 0.1])
def test_people_at_constant_velocity_are_predicted_exactly(sample_s: float) -> None:
    found = forecast_of(walk("1", 3.3, (0, 0), (20, 0)), sample_s=sample_s)
    seconds = 20 / 1.2
    assert len(found.errors) == pytest.approx((seconds - 1.6 - 4.8) / sample_s, abs=2)
    np.testing.assert_allclose(found.errors, 0.0, atol=1e-9)


def test_errors_are_where_they_went_minus_where_they_were_expected() -> None:
    turns = walk("1", 0.0, (0, 0), (3.36, 0), (3.36, 20))
    found = forecast_of(turns)
    before = found.errors[0]
    np.testing.assert_allclose(before[0], [0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(before[-1], [3.36 - 1.2 * 6.4, 1.2 * 6.4 - 3.36], atol=0.5)


def test_people_do_not_depend_on_each_other() -> None:
    one = walk("1", 0.0, (0, 0), (5, 0), (5, 9))
    two = walk("2", 7.1, (0, 0), (9, 1))
    together = forecast_of(one, two)
    alone = [forecast_of(track) for track in (one, two)]
    assert len(together.errors) == sum(len(f.errors) for f in alone)
    assert np.abs(together.errors).sum() == pytest.approx(
        sum(np.abs(f.errors).sum() for f in alone)
    )


def test_people_who_are_not_recorded_for_long_enough_do_not_count() -> None:
    assert forecast_of(walk("1", 0.0, (0, 0), (7, 0))).errors.shape == (0, STEPS, 2)


@pytest.mark.parametrize("spread", [GAUSSIAN, PEOPLE])
def test_circles_of_the_right_distribution_hold_their_shares(spread: Spread) -> None:
    score = score_forecasts(drawn(0.05, 0.2, spread), spread)
    assert score.coverage == pytest.approx((0.5, 0.9, 0.95), abs=0.01)


def test_one_gaussian_misjudges_heavy_tails() -> None:
    heavy = drawn(0.05, 0.2, PEOPLE)
    right, wrong = (score_forecasts(heavy, spread) for spread in (PEOPLE, GAUSSIAN))
    assert right.negative_log_likelihood < wrong.negative_log_likelihood - 0.1
    assert wrong.coverage[0] > 0.6


def test_errors_are_averaged_up_to_the_horizon_and_at_it() -> None:
    errors = np.zeros((1, STEPS, 2))
    errors[0, :, 1] = np.arange(1, STEPS + 1)
    score = score_forecasts(Forecasts(errors, np.ones((1, STEPS))), GAUSSIAN)
    assert score.ade_m == (2.0, 3.5, 6.5)
    assert score.fde_m == (3.0, 6.0, 12.0)
    squares = np.arange(1, STEPS + 1) ** 2
    expected = np.log(2 * np.pi) + squares.mean() / 2
    assert score.negative_log_likelihood == pytest.approx(expected)
    assert score.coverage[2] == pytest.approx(2 / 12)


def people(name: str) -> Crowd:
    return read_crowd(recorded(name))


def test_printed_equation_extrapolates_noise_on_recorded_people() -> None:
    walkers = people("hotel")
    ours, printed = (
        score_forecasts(forecast(walkers, Obstacles(), model, 0.4), model.spread)
        for model in (MODEL, PredictionModel(printed=True))
    )
    assert ours.forecasts == printed.forecasts > 1000
    assert all(a < 0.6 * b for a, b in zip(ours.fde_m, printed.fde_m, strict=True))


def test_errors_on_recorded_people_are_those_known() -> None:
    """Scores on three recordings are close to figures from an independent implementation."""
    found = pool([forecast(people(n), Obstacles(), MODEL, 0.4) for n in ("eth", "hotel", "zara1")])
    score = score_forecasts(found, MODEL.spread)
    np.testing.assert_allclose(score.ade_m, (0.12, 0.23, 0.47), atol=0.03)
    np.testing.assert_allclose(score.fde_m, (0.18, 0.40, 0.97), atol=0.03)
    growth = np.sqrt(np.mean((found.errors / ahead_s()[:, None]) ** 2))
    assert growth == pytest.approx(0.167, abs=0.01)


def test_recorded_people_stray_as_is_expected_by_default() -> None:
    found = pool([forecast(people(n), Obstacles(), MODEL, 0.4) for n in ("eth", "zara1")])
    ours, even = (score_forecasts(found, spread) for spread in (PEOPLE, GAUSSIAN))
    assert ours.negative_log_likelihood < even.negative_log_likelihood - 0.1
    assert ours.coverage == pytest.approx((0.5, 0.9, 0.95), abs=0.04)
