"""Predictions beside what people did, and how their deviations are judged and fitted."""

import numpy as np
import pytest

from evaluation.calibration import (
    Fit,
    fit_deviation,
    negative_log_likelihood,
    pool,
    score_forecasts,
)
from evaluation.forecasts import STEPS, Forecasts, ahead_s, forecast
from planning import PredictionModel
from recordings import Crowd, Obstacles, Track, read_crowd
from tests.evaluation.worlds import crowd, walk
from tests.recordings.data import recorded

MODEL = PredictionModel()


def drawn(sigma_0_m: float, growth_mps: float, count: int = 4000, seed: int = 3) -> Forecasts:
    """Errors that are as uncertain as said."""
    sigmas = np.broadcast_to(Fit(sigma_0_m, growth_mps).sigmas(), (count, STEPS))
    noise = np.random.default_rng(seed).standard_normal((count, STEPS, 2))
    return Forecasts(noise * sigmas[:, :, None], sigmas)


def forecast_of(*tracks: Track, sample_s: float = 0.4) -> Forecasts:
    return forecast(crowd(*tracks), Obstacles(), MODEL, sample_s)


@pytest.mark.parametrize("sample_s", [0.4, 0.2, 0.1])
def test_who_walks_on_evenly_is_predicted_exactly(sample_s: float) -> None:
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


def test_who_is_not_followed_for_long_enough_does_not_count() -> None:
    assert forecast_of(walk("1", 0.0, (0, 0), (7, 0))).errors.shape == (0, STEPS, 2)


def test_right_deviations_hold_the_right_shares() -> None:
    score = score_forecasts(drawn(0.05, 0.2))
    assert score.inside == pytest.approx((0.5, 0.9, 0.95), abs=0.01)


def test_errors_are_averaged_up_to_the_horizon_and_at_it() -> None:
    errors = np.zeros((1, STEPS, 2))
    errors[0, :, 1] = np.arange(1, STEPS + 1)
    score = score_forecasts(Forecasts(errors, np.ones((1, STEPS))))
    assert score.average_m == (2.0, 3.5, 6.5)
    assert score.final_m == (3.0, 6.0, 12.0)
    squares = np.arange(1, STEPS + 1) ** 2
    expected = np.log(2 * np.pi) + squares.mean() / 2
    assert score.negative_log_likelihood == pytest.approx(expected)
    assert score.inside[2] == pytest.approx(2 / 12)


@pytest.mark.parametrize(("sigma_0_m", "growth_mps"), [(0.05, 0.17), (0.2, 0.1), (0.02, 0.3)])
def test_a_fit_finds_what_was_drawn(sigma_0_m: float, growth_mps: float) -> None:
    found = fit_deviation([drawn(sigma_0_m, growth_mps), drawn(sigma_0_m, growth_mps, 50, 9)])
    assert found.sigma_0_m == pytest.approx(sigma_0_m, abs=0.02)
    assert found.growth_mps == pytest.approx(growth_mps, rel=0.1)


def test_a_fit_is_likelier_than_its_neighbours() -> None:
    found = drawn(0.1, 0.2)
    fit = fit_deviation([found])
    best = negative_log_likelihood(found, fit.sigmas())
    for factor in (0.9, 1.1):
        assert negative_log_likelihood(found, factor * fit.sigmas()) > best


def test_recordings_weigh_the_same_in_a_fit() -> None:
    many, few = drawn(0.01, 0.1, 8000), drawn(0.01, 0.3, 500)
    growth = fit_deviation([many, few]).growth_mps
    assert growth == pytest.approx(np.sqrt((0.1**2 + 0.3**2) / 2), rel=0.05)
    assert fit_deviation([pool([many, few])]).growth_mps < 0.15


def people(name: str) -> Crowd:
    return read_crowd(recorded(name))


def test_printed_equation_extrapolates_noise_on_recorded_people() -> None:
    walkers = people("hotel")
    ours, printed = (
        score_forecasts(forecast(walkers, Obstacles(), model, 0.4))
        for model in (MODEL, PredictionModel(printed=True))
    )
    assert ours.forecasts == printed.forecasts > 1000
    assert all(a < 0.6 * b for a, b in zip(ours.final_m, printed.final_m, strict=True))


def test_errors_on_recorded_people_are_those_known() -> None:
    """Three recordings together, against figures that were measured by other means."""
    found = pool([forecast(people(n), Obstacles(), MODEL, 0.4) for n in ("eth", "hotel", "zara1")])
    score = score_forecasts(found)
    np.testing.assert_allclose(score.average_m, (0.12, 0.23, 0.47), atol=0.03)
    np.testing.assert_allclose(score.final_m, (0.18, 0.40, 0.97), atol=0.03)
    growth = np.sqrt(np.mean((found.errors / ahead_s()[:, None]) ** 2))
    assert growth == pytest.approx(0.167, abs=0.01)
