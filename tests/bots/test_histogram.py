"""Percentiles against sorting everything."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots.histogram import GREATEST, LEAST, STEP, Histogram

values = st.lists(st.floats(LEAST, GREATEST), min_size=1, max_size=200)


@given(values, st.floats(0.1, 100.0))
def test_a_percentile_is_at_most_one_step_too_great(seen: list[float], percent: float) -> None:
    exact = sorted(seen)[max(1, math.ceil(len(seen) * percent / 100.0)) - 1]
    found = Histogram(seen).percentile(percent)
    assert found is not None
    assert exact * (1 - 1e-9) <= found <= exact * STEP * (1 + 1e-9)


@given(values, values)
def test_merging_is_counting_in_one(some: list[float], others: list[float]) -> None:
    merged, all_at_once = Histogram(some), Histogram(some + others)
    merged.merge(Histogram(others))
    assert merged.counts == all_at_once.counts
    assert merged.count == len(some) + len(others)
    assert merged.mean == pytest.approx(all_at_once.mean)
    assert merged.greatest == max(some + others)


def test_nothing_counted_has_no_percentile() -> None:
    assert Histogram().percentile(50) is None
    assert Histogram().mean is None


def test_what_is_off_the_scale_falls_into_the_outer_bins() -> None:
    histogram = Histogram([-1.0, 0.0, 1e-9, 1e9])
    assert histogram.count == 4
    assert histogram.percentile(50) == LEAST
    assert histogram.percentile(100) == pytest.approx(GREATEST, rel=0.02)
    assert histogram.greatest == 1e9
    assert histogram.mean == pytest.approx(2.5e8)
