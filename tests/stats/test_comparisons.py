"""Paired differences: intervals that hold together, and the episodes that a difference needs."""

import math

import numpy as np
import pytest

from esplanade.stats import Difference, Interval, Sample, compare, needed


def pair(
    rng: np.random.Generator, shift: float, count: int = 40
) -> tuple[list[Sample], list[Sample]]:
    """Two figures of two that differ by `shift` in the first, with noise of 0.5 in each."""
    common = 3.0 * rng.normal(size=(count, 2))
    first = common + 0.5 * rng.normal(size=(count, 2)) + [shift, 0.0]
    second = common + 0.5 * rng.normal(size=(count, 2))
    labels = (np.arange(count) // 2).tolist()
    return [Sample.of(first, labels)], [Sample.of(second, labels)]


def test_a_difference_on_the_same_episodes_is_seen_however_much_these_scatter() -> None:
    found = compare({"far": pair(np.random.default_rng(0), 1.0)}, 0, even=False)["far"]
    assert [difference.differs for difference in found] == [True, False]
    assert found[0].interval.low < found[0].mean < found[0].interval.high
    assert found[0].mean == pytest.approx(1.0, abs=0.3)
    assert found[0].episodes == 40


@pytest.mark.usefixtures("fewer_resamples")
def test_of_many_without_a_difference_few_have_any_that_is_held_for_one() -> None:
    rng = np.random.default_rng(1)
    alarms = 0
    for _ in range(100):
        found = compare({name: pair(rng, 0.0) for name in "abcd"}, 0, even=False)
        alarms += any(difference.differs for each in found.values() for difference in each)
    assert alarms <= 11  # of 100 at 5 %, more come by chance in 4 of 1000 cases


def test_episodes_in_which_one_lacks_the_figure_count_for_nothing() -> None:
    ours, theirs = pair(np.random.default_rng(2), 1.0)
    ours[0].values[3, 0] = math.nan
    theirs[0].values[3:5, 0] = math.nan
    found = compare({"far": (ours, theirs)}, 0, even=False)["far"]
    assert [difference.episodes for difference in found] == [38, 40]


def test_other_episodes_are_no_pair() -> None:
    ours, theirs = pair(np.random.default_rng(3), 0.0)
    fewer = [Sample.of(theirs[0].values[:-1], theirs[0].clusters[:-1].tolist())]
    with pytest.raises(ValueError, match="the same episodes"):
        compare({"far": (ours, fewer)}, 0, even=False)


@pytest.mark.usefixtures("fewer_resamples")
def test_as_many_episodes_as_are_told_show_the_difference_in_four_of_five_studies() -> None:
    rng = np.random.default_rng(4)
    (found, _) = compare({"far": pair(rng, 0.2, 400)}, 0, even=False)["far"]
    episodes = int(needed(found, 0.2))
    assert 60 < episodes < 160  # (1.96 + 0.84)² 2 · 0.5² / 0.2² = 98
    seen = 0
    for _ in range(100):
        (again, _) = compare({"far": pair(rng, 0.2, episodes)}, 0, even=False)["far"]
        seen += again.mean - 1.96 * again.deviation > 0.0
    assert 65 <= seen <= 93


def test_where_nothing_differs_nothing_is_told_of_power() -> None:
    assert math.isnan(needed(Difference(0.0, Interval(0.0, 0.0), 0.0, 40), 1.0))
