"""Mixtures of Gaussians against eq. (4) summed as written."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import GAUSSIAN, PEOPLE, PredictionModel, Spread
from tests.naive import prediction as naive
from tests.planning.worlds import holds, points

SPREADS = [GAUSSIAN, PEOPLE, Spread((0.3, 0.8, 1.9), (0.2, 0.5, 0.3))]


def test_people_are_expected_with_heavy_tails() -> None:
    assert PredictionModel().spread is PEOPLE
    assert len(PEOPLE.scales) == 2


@given(st.sampled_from(SPREADS), points(-3.0, 3.0), st.floats(0.05, 2.0))
@holds(100, 100)
def test_the_density_is_its_sum(spread, offset, sigma_m) -> None:
    found = spread.density(offset, sigma_m)
    parts = list(zip(spread.scales, spread.weights, strict=True))
    assert found == pytest.approx(naive.density(parts, np.array(offset), sigma_m), abs=1e-12)


@pytest.mark.parametrize("spread", SPREADS)
@pytest.mark.parametrize("sigma_m", [0.05, 1.7])
def test_a_density_integrates_to_one(spread, sigma_m) -> None:
    within = 8.0 * math.sqrt(2.0)
    total = naive.integral_of_density(spread.density, sigma_m, within)
    assert total == pytest.approx(1.0, abs=1e-4)


def test_the_density_is_that_of_two_dimensions() -> None:
    assert GAUSSIAN.density(np.zeros(2), 0.5) == pytest.approx(1.0 / (2.0 * math.pi * 0.25))
    printed = 1.0 / (0.5 * math.sqrt(2.0 * math.pi))
    assert GAUSSIAN.density(np.zeros(2), 0.5) != pytest.approx(printed)


def test_what_is_very_unlikely_still_has_a_likelihood() -> None:
    far = PEOPLE.log_density([500.0, 0.0], 0.1)
    assert np.isfinite(far)
    assert far < -1e6


def test_offsets_and_deviations_broadcast() -> None:
    offsets = np.arange(12.0).reshape(2, 3, 2)
    found = PEOPLE.log_density(offsets, [1.0, 2.0, 3.0])
    assert found.shape == (2, 3)
    assert found[1, 2] == pytest.approx(float(PEOPLE.log_density(offsets[1, 2], 3.0)))


@pytest.mark.parametrize("spread", SPREADS)
@pytest.mark.parametrize("radius", [0.4, 1.3, 2.6])
def test_a_circle_holds_the_density_within(spread, radius) -> None:
    summed = naive.integral_of_density(spread.density, 0.7, radius)
    assert spread.share_within(radius) == pytest.approx(summed, abs=0.02)


@given(st.sampled_from(SPREADS), st.floats(0.01, 0.999))
@holds(100, 100)
def test_the_circle_of_a_share_holds_that_share(spread, share) -> None:
    assert spread.share_within(spread.radius_of(share)) == pytest.approx(share, abs=1e-9)


def test_circles_of_one_gaussian_are_those_in_closed_form() -> None:
    assert GAUSSIAN.radius_of(0.5) == pytest.approx(math.sqrt(2.0 * math.log(2.0)))
    assert GAUSSIAN.radius_of(0.95) == pytest.approx(math.sqrt(2.0 * math.log(20.0)))


@pytest.mark.parametrize("share", [0.0, 1.0, -0.1, math.nan])
def test_no_circle_holds_nobody_or_everybody(share) -> None:
    with pytest.raises(ValueError, match="share"):
        PEOPLE.radius_of(share)


@pytest.mark.parametrize("sigma_m", [0.0, -1.0, math.nan, [1.0, 0.0]])
def test_a_density_needs_a_width(sigma_m) -> None:
    with pytest.raises(ValueError, match="sigma_m"):
        PEOPLE.density(np.zeros(2), sigma_m)


@pytest.mark.parametrize(
    ("scales", "weights", "fault"),
    [
        ((), (), "each scale needs a weight"),
        ((1.0, 2.0), (1.0,), "each scale needs a weight"),
        ((0.0, 2.0), (0.5, 0.5), "must be positive"),
        ((1.0, math.inf), (0.5, 0.5), "must be positive"),
        ((1.0, 2.0), (1.5, -0.5), "must be positive"),
        ((1.0, 2.0), (0.5, 0.4), "sum to one"),
    ],
)
def test_a_spread_that_is_none_is_refused(scales, weights, fault) -> None:
    with pytest.raises(ValueError, match=fault):
        Spread(scales, weights)
