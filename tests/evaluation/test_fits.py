"""Fits to errors drawn from known distributions, and their cross-validation."""

import numpy as np
import pytest

from esplanade.evaluation.calibration import negative_log_likelihood, pool
from esplanade.evaluation.fits import fit_each, fit_growth, fit_spread, without_standing
from esplanade.evaluation.forecasts import STEPS, Forecasts
from esplanade.planning import GAUSSIAN, PEOPLE, Spread
from tests.evaluation.worlds import drawn


@pytest.mark.parametrize(("sigma_0_m", "growth_mps"), [(0.05, 0.17), (0.2, 0.1), (0.02, 0.3)])
def test_a_fit_finds_the_deviation_that_was_drawn(sigma_0_m: float, growth_mps: float) -> None:
    found = fit_growth([drawn(sigma_0_m, growth_mps), drawn(sigma_0_m, growth_mps, count=50)])
    assert found.sigma_0_m == pytest.approx(sigma_0_m, abs=0.02)
    assert found.growth_mps == pytest.approx(growth_mps, rel=0.1)


def test_a_fit_is_likelier_than_its_neighbours() -> None:
    found = drawn(0.1, 0.2)
    fit = fit_growth([found])
    best = negative_log_likelihood(found, fit.sigmas(), GAUSSIAN)
    for factor in (0.9, 1.1):
        assert negative_log_likelihood(found, factor * fit.sigmas(), GAUSSIAN) > best


def test_recordings_weigh_the_same_in_a_fit() -> None:
    many, few = drawn(0.01, 0.1, count=8000), drawn(0.01, 0.3, count=500)
    growth = fit_growth([many, few]).growth_mps
    assert growth == pytest.approx(np.sqrt((0.1**2 + 0.3**2) / 2), rel=0.05)
    assert fit_growth([pool([many, few])]).growth_mps < 0.15


@pytest.mark.parametrize("spread", [PEOPLE, Spread((0.8, 2.5), (0.8, 0.2))])
def test_a_fit_finds_the_spread_that_was_drawn(spread: Spread) -> None:
    found = fit_spread([drawn(0.05, 0.2, spread), drawn(0.02, 0.3, spread, seed=4)])
    assert found.scales == pytest.approx(spread.scales, rel=0.05)
    assert found.weights == pytest.approx(spread.weights, abs=0.03)


def test_people_who_stand_do_not_affect_the_spread() -> None:
    walkers = drawn(0.05, 0.2, PEOPLE)
    standing = Forecasts(np.full((500, STEPS, 2), 1e-4), walkers.sigmas[:500])
    moved = without_standing(pool([standing, walkers]))
    np.testing.assert_array_equal(moved.errors, walkers.errors)
    assert len(without_standing(standing).errors) == 0
    assert fit_each([("square", standing)], PEOPLE).spreads == []


def test_each_recording_is_held_against_the_fit_to_the_others() -> None:
    small, large = drawn(0.0, 0.1, count=500), drawn(0.0, 0.3, count=500)
    fits = fit_each([("small", small), ("large", large)], PEOPLE)
    assert [row.left_out for row in fits.growths] == ["small", "large", None]
    assert [row.left_out for row in fits.spreads] == ["small", "large", None]
    without_small, without_large, both = fits.growths
    assert without_small.fit.growth_mps == pytest.approx(0.3, rel=0.05)
    assert without_large.fit.growth_mps == pytest.approx(0.1, rel=0.05)
    for row in (without_small, both):
        assert row.negative_log_likelihood > row.default_negative_log_likelihood
    default = negative_log_likelihood(small, small.sigmas, PEOPLE)
    assert fits.spreads[0].default_negative_log_likelihood == default


def test_one_recording_is_fitted_as_a_whole() -> None:
    fits = fit_each([("plaza", drawn(0.05, 0.2, PEOPLE))], PEOPLE)
    assert [row.left_out for row in fits.growths] == [None]
    (row,) = fits.spreads
    assert row.left_out is None
    assert row.negative_log_likelihood <= row.default_negative_log_likelihood


def test_without_recordings_there_are_no_fits() -> None:
    assert fit_each([], PEOPLE) == ([], [])
