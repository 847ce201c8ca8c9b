"""The course of a run: second by second, bounded, added up over processes."""

import pickle

import pytest

from esplanade.bots.series import MAX_BUCKETS, Series


def test_things_are_in_the_second_in_which_they_happen() -> None:
    series = Series(begin_s=100.0)
    series.at(99.0).joined += 1
    series.at(100.5).joined += 1
    series.at(102.1).left += 1
    assert [bucket.joined for bucket in series.buckets] == [2, 0, 0]
    assert series.present() == [2, 2, 1]


def test_ages_are_told_within_five_per_cent() -> None:
    bucket = Series(0.0).at(0.0)
    for age_ms in range(1, 101):
        bucket.add_age(age_ms / 1e3)
    assert bucket.due == 100
    for percent in (1, 50, 99, 100):
        assert bucket.age_s(percent) == pytest.approx(percent / 1e3, rel=0.051)
    assert Series(0.0).at(0.0).age_s(50) is None


def test_a_long_run_is_told_in_longer_stretches() -> None:
    series = Series(begin_s=0.0)
    for second in range(10 * MAX_BUCKETS):
        series.at(second).bytes_in += 1
        series.at(second).add_age(0.01)
    assert len(series.buckets) <= MAX_BUCKETS
    assert series.width_s == 16.0
    assert sum(bucket.bytes_in for bucket in series.buckets) == 10 * MAX_BUCKETS
    assert {bucket.bytes_in for bucket in series.buckets} == {16}
    # An hour and a half of it goes from process to process in less than this.
    assert len(pickle.dumps(series)) < 200_000


@pytest.mark.parametrize("finer_first", [True, False])
def test_series_of_unequal_lengths_add_up(finer_first: bool) -> None:
    short, long = Series(0.0), Series(1000.0)
    short.at(3.0).received += 1
    for second in range(MAX_BUCKETS + 1):
        long.at(1000.0 + second).received += 1
    total = Series(0.0)
    for each in (short, long) if finer_first else (long, short):
        total.merge(each)
    assert total.width_s == 2.0
    assert [bucket.received for bucket in total.buckets[:3]] == [2, 3, 2]
    assert sum(bucket.received for bucket in total.buckets) == MAX_BUCKETS + 2
