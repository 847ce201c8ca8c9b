"""Figures over time: seconds become longer steps, gaps stay gaps, and rings forget the oldest."""

import pytest

from esplanade.server.live.series import STEPS, Figure, Series

MICROSECONDS = 1_000_000
FIGURES = (
    Figure("people", "1", "People"),
    Figure("slowest", "ms", "The slowest", "max"),
    Figure("trips", "1", "Trips", "sum"),
)


def test_longer_steps_are_means_sums_and_greatest_values_of_seconds() -> None:
    series = Series(FIGURES)
    for second in range(120):
        series.add(second, {"people": second, "slowest": second % 7, "trips": 2.0})
    times, values = series.told(["people", "slowest", "trips"], 0, 200 * MICROSECONDS, 60)
    assert times == [0, 60 * MICROSECONDS]
    assert values["people"] == [29.5, 89.5]
    assert values["slowest"] == [6.0, 6.0]
    assert values["trips"] == [120.0, 120.0]
    times, values = series.told(["trips"], 10 * MICROSECONDS, 29 * MICROSECONDS, 10)
    assert times == [10 * MICROSECONDS, 20 * MICROSECONDS]
    assert values == {"trips": [20.0, 20.0]}


def test_what_is_not_known_is_none_and_a_second_without_ticks_is_left_out() -> None:
    series = Series(FIGURES)
    series.add(5, {"people": 1.0})
    series.add(8, {"trips": 3.0})
    times, values = series.told(["people", "trips"], 0, 100 * MICROSECONDS, 1)
    assert times == [5 * MICROSECONDS, 8 * MICROSECONDS]
    assert values == {"people": [1.0, None], "trips": [None, 3.0]}
    _, together = series.told(["people", "trips"], 0, 100 * MICROSECONDS, 10)
    assert together == {"people": [1.0], "trips": [3.0]}
    with pytest.raises(KeyError):
        series.told(["nothing"], 0, 1, 1)


def test_a_ring_keeps_an_hour_of_seconds() -> None:
    series = Series(FIGURES)
    for second in range(STEPS[1] + 30):
        series.add(second, {"people": float(second)})
    times, values = series.told(["people"], 0, 10**12, 1)
    assert len(times) == STEPS[1]
    assert times[0] == 30 * MICROSECONDS
    assert values["people"][-1] == float(STEPS[1] + 29)
