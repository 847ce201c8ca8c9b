import pytest

from esplanade.server.net.schedule import MAX_BEHIND_TICKS, Schedule
from esplanade.server.world.pace import Pace

PERIOD_S = 0.05


def test_deadlines_do_not_drift_however_late_ticks_begin() -> None:
    schedule = Schedule(PERIOD_S, start=100.0)
    for tick in range(1000):
        assert schedule.next_deadline == pytest.approx(100.0 + tick * PERIOD_S)
        schedule.begin(schedule.next_deadline + 0.01)
    assert schedule.late_ticks == schedule.given_up_ticks == 0


def test_a_short_delay_is_caught_up_tick_by_tick() -> None:
    schedule = Schedule(PERIOD_S, start=0.0)
    schedule.begin(2.5 * PERIOD_S)
    begun = 1
    while schedule.next_deadline <= 2.5 * PERIOD_S:
        schedule.begin(2.5 * PERIOD_S)
        begun += 1
    assert begun == 3
    assert schedule.late_ticks == 2
    assert schedule.given_up_ticks == 0


def test_after_a_long_delay_the_lost_time_is_given_up() -> None:
    schedule = Schedule(PERIOD_S, start=0.0)
    now = 100.5 * PERIOD_S
    begun = 0
    while schedule.next_deadline <= now:
        schedule.begin(now)
        begun += 1
    assert begun == MAX_BEHIND_TICKS + 1
    assert schedule.given_up_ticks == 100 - MAX_BEHIND_TICKS


def test_world_time_is_tick_times_period_and_runs_on_in_between() -> None:
    schedule = Schedule(PERIOD_S, start=10.0)
    for _ in range(8):
        schedule.begin(schedule.next_deadline)
    begun_at = 10.0 + 7 * PERIOD_S
    assert schedule.world_time(8, begun_at) == pytest.approx(8 * PERIOD_S)
    assert schedule.world_time(8, begun_at + 0.02) == pytest.approx(8 * PERIOD_S + 0.02)


def test_deadlines_and_the_time_of_the_world_follow_the_pace() -> None:
    pace = Pace()
    schedule = Schedule(PERIOD_S, start=0.0, pace=pace)
    schedule.begin(0.0)
    pace.change(0.5 * PERIOD_S, factor=0.25)
    assert schedule.world_time(1, 0.5 * PERIOD_S) == pytest.approx(1.5 * PERIOD_S)
    assert schedule.next_deadline == pytest.approx(2.5 * PERIOD_S)
    schedule.begin(schedule.next_deadline)
    assert schedule.next_deadline == pytest.approx(6.5 * PERIOD_S)
    assert schedule.late_ticks == 0


def test_the_time_of_a_paused_world_goes_on_by_its_ticks_alone() -> None:
    pace = Pace()
    schedule = Schedule(PERIOD_S, start=0.0, pace=pace)
    schedule.begin(0.0)
    pace.change(0.4 * PERIOD_S, paused=True)
    assert pace.stands
    for now in (1.0, 100.0):
        assert schedule.world_time(1, now) == pytest.approx(1.4 * PERIOD_S)
    pace.step(1)
    assert not pace.stands
    schedule.begin(100.0)
    pace.ticked(100.0, 2, PERIOD_S)
    assert pace.stands
    assert schedule.world_time(2, 100.0) == pytest.approx(2.4 * PERIOD_S)
    assert pace.standing_s(100.0) == pytest.approx(100.0 - 0.4 * PERIOD_S)
    pace.change(100.0, paused=False)
    assert schedule.next_deadline == pytest.approx(100.0 + 0.6 * PERIOD_S)
    assert schedule.given_up_ticks == schedule.late_ticks == 0


def test_a_pace_is_saved_and_loaded() -> None:
    pace, other = Pace(), Pace()
    pace.change(0.0, factor=0.5, paused=True)
    other.load(pace.save(), 3.0)
    assert (other.state.factor, other.state.paused, other.state.rate) == (0.5, True, 0.0)
    with pytest.raises(ValueError, match="factor"):
        pace.change(0.0, factor=5.0)
