"""Adding up what processes have counted."""

from collections import Counter

from esplanade.bots.histogram import Histogram
from esplanade.bots.tally import Tally, merged


def test_every_field_is_added_up() -> None:
    numbers = {name: 1 for name, value in vars(Tally()).items() if isinstance(value, int | float)}
    histograms = [name for name, value in vars(Tally()).items() if isinstance(value, Histogram)]
    some, others = Tally(**numbers), Tally(**numbers)  # type: ignore[arg-type]
    for tally in (some, others):
        tally.errors["flooding"] += 2
        tally.scenario_faults["a.py:1"] += 1
        tally.series.at(tally.series.begin_s + 3.5).received += 1
        for name in histograms:
            getattr(tally, name).add(0.5)
    total = merged([some, others])
    assert {name: getattr(total, name) for name in numbers} == dict.fromkeys(numbers, 2)
    assert total.errors == Counter(flooding=4)
    assert total.scenario_faults == {"a.py:1": 2}
    assert [bucket.received for bucket in total.series.buckets] == [0, 0, 0, 2]
    assert [getattr(total, name).count for name in histograms] == [2] * len(histograms)
    assert len(numbers) + len(histograms) + len(["errors", "scenario_faults", "series"]) == len(
        vars(total)
    )
    assert some.errors == Counter(flooding=2)


def test_well_means_that_nothing_went_wrong() -> None:
    assert Tally(joined=3, left=3).well
    assert not Tally(joined=3, left=3, failed=1).well
    assert not Tally(joined=3, left=2, lost=1).well
    assert not Tally(joined=3, left=3, errors=Counter(flooding=1)).well


def test_present_are_those_who_came_and_did_not_go() -> None:
    assert Tally(joined=7, left=2, lost=1).present == 4
