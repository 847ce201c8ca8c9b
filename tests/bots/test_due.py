"""Ticks that were due, by arithmetic: no sockets, no clock but numbers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots.due import EXACT, DueTicks
from esplanade.bots.tally import Tally

RATE = 20
TICK_S = 1.0 / RATE


def counted(arrivals: list[tuple[int, float, float]], end_s: float) -> Tally:
    """The tally of snapshots (tick, when it was due, when it came), of a client welcomed at 0 s."""
    tally = Tally()
    tally.series.begin_s = 0.0
    due = DueTicks(tally, RATE, welcomed_s=0.0)
    for tick, due_s, now_s in arrivals:
        due.take(tick, due_s, now_s)
    due.finish(end_s)
    return tally


def on_time(ticks: range, age_s: float = 0.01) -> list[tuple[int, float, float]]:
    return [(tick, tick * TICK_S, tick * TICK_S + age_s) for tick in ticks]


def test_all_is_well_when_all_comes() -> None:
    tally = counted(on_time(range(1, 201)), end_s=10.01)
    assert tally.snapshots_due == tally.snapshots_received == 200
    assert (tally.snapshots_missing, tally.snapshots_late) == (0, 0)
    assert tally.snapshot_age_s.greatest == pytest.approx(0.01)
    assert [bucket.due for bucket in tally.series.buckets[:10]] == [19, *[20] * 9]


def test_snapshots_that_are_left_out_are_as_old_as_the_next_one_makes_them() -> None:
    kept = [each for each in on_time(range(1, 201)) if each[0] % 8 == 0]
    tally = counted(kept, end_s=10.02)
    assert tally.snapshots_received == 25
    assert tally.snapshots_due == 199  # the first tick of a client is not due yet
    assert tally.snapshots_missing == 174
    assert tally.snapshot_age_s.greatest == pytest.approx(7 * TICK_S + 0.01)
    assert tally.snapshot_age_s.percentile(50) == pytest.approx(0.16, abs=0.055)


@pytest.mark.parametrize("gives_up", [True, False])
def test_a_gap_of_four_seconds_is_eighty_ticks_of_all_ages(gives_up: bool) -> None:
    """Whether the server counts on where it was or leaves numbers out, the gap is the same."""
    before, stop_s = on_time(range(1, 81)), 4.0
    skipped = 0 if gives_up else 80
    after = [
        (tick + skipped, tick * TICK_S + stop_s, tick * TICK_S + stop_s + 0.01)
        for tick in range(81, 161)
    ]
    tally = counted([*before, *after], end_s=12.01)
    assert tally.snapshots_due == 240
    assert tally.snapshots_received == 160
    assert tally.snapshots_missing == 80
    ages = tally.snapshot_age_s
    assert ages.greatest == pytest.approx(4.01)
    assert sum(ages.counts) == 240
    assert ages.percentile(100 * 200 / 240) == pytest.approx(2.0, rel=0.03)
    assert ages.percentile(95) == pytest.approx(4.0 - 12 * TICK_S, rel=0.03)
    assert [bucket.due for bucket in tally.series.buckets[4:8]] == [20] * 4
    assert sum(bucket.received for bucket in tally.series.buckets[4:8]) <= 1


def test_snapshots_that_come_in_a_burst_are_late_and_not_missing() -> None:
    held = [(tick, tick * TICK_S, 8.0) for tick in range(81, 161)]
    tally = counted([*on_time(range(1, 81)), *held], end_s=8.01)
    assert (tally.snapshots_due, tally.snapshots_missing) == (160, 0)
    assert tally.snapshots_late == 77  # that of tick 158 came two ticks late, and no more
    assert tally.snapshot_age_s.greatest == pytest.approx(8.0 - 81 * TICK_S)


def test_a_server_that_ends_in_silence_owes_what_was_due_until_the_end() -> None:
    tally = counted(on_time(range(1, 41)), end_s=5.0)
    assert tally.snapshots_missing == 57  # 60, less two and what is usually on its way
    assert tally.snapshot_age_s.greatest == pytest.approx(5.0 - 41 * TICK_S)


def test_a_server_without_any_snapshot_owes_them_all() -> None:
    tally = counted([], end_s=5.0)
    assert tally.snapshots_due == tally.snapshots_missing == 97
    assert tally.snapshots_received == 0


def test_a_snapshot_that_comes_twice_counts_once() -> None:
    twice = [each for each in on_time(range(1, 41)) for _ in range(2)]
    assert counted(twice, end_s=2.01).snapshots_received == 40


@pytest.mark.parametrize("rate", [0.1, 0.5, 4.0])
def test_at_another_pace_other_ticks_are_due(rate: float) -> None:
    tally = Tally()
    tally.series.begin_s = 0.0
    due, period_s = DueTicks(tally, RATE, welcomed_s=0.0), TICK_S / rate
    for tick in range(1, 21):
        due.take(tick, tick * TICK_S, tick * TICK_S + 0.01)
    due.pace(rate, 1.01)
    begun_s = 1.01
    for k in range(1, 41):
        if k not in {10, 11}:
            due.take(20 + k, begun_s + k * period_s, begun_s + k * period_s + 0.01)
    assert (tally.snapshots_received, tally.snapshots_missing) == (58, 2)
    end_s = begun_s + 40 * period_s
    due.pace(0.0, end_s)
    due.take(61, 0.0, end_s + 30.0)  # a single step in a pause
    due.finish(end_s + 60.0)
    assert (tally.snapshots_received, tally.snapshots_missing) == (59, 2)


@given(st.integers(1, 20_000))
def test_long_gaps_are_counted_whole(ticks: int) -> None:
    """Ticks of a long gap are counted a second at a time; ages are right within a second."""
    gap_s = ticks * TICK_S
    tally = counted([(1, TICK_S, TICK_S), (2, 2 * TICK_S + gap_s, 2 * TICK_S + gap_s)], gap_s)
    assert tally.snapshots_missing == ticks
    assert tally.snapshots_due == ticks + 2
    assert sum(bucket.due for bucket in tally.series.buckets) == ticks + 2
    half_s = 0.0 if ticks <= EXACT else 0.5
    assert tally.snapshot_age_s.greatest == pytest.approx(gap_s, abs=half_s + 1e-6)


@given(st.lists(st.booleans(), min_size=1, max_size=200))
def test_due_is_received_and_missing(comes: list[bool]) -> None:
    arrivals = [
        each for each, here in zip(on_time(range(1, 1 + len(comes))), comes, strict=True) if here
    ]
    tally = counted(arrivals, end_s=len(comes) * TICK_S + 0.01)
    assert tally.snapshots_due == tally.snapshots_received + tally.snapshots_missing
    assert tally.snapshot_age_s.count == tally.snapshots_due
    assert tally.snapshots_received == sum(comes)
