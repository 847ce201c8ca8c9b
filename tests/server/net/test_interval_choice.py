"""The planning interval that a server chooses: as small as ticks have time for, and steady."""

import pytest
import structlog

from esplanade.server.net.interval_choice import ENOUGH_WINDOWS, MOST_TICKS, WINDOW_TICKS
from esplanade.server.net.interval_choice import IntervalChoice as Choice

PERIOD_S = 0.05


def run(choice: Choice, ticks: int, planning_s: float, other_s: float = 0.01) -> list[int]:
    """The intervals after so many ticks of a world that plans everybody in `planning_s`."""
    found = []
    for _ in range(ticks):
        took_s = planning_s / choice.ticks
        choice.ticked(PERIOD_S - took_s - other_s, took_s, PERIOD_S)
        found.append(choice.ticks)
    return found


def test_where_there_is_time_everybody_is_planned_in_each_tick() -> None:
    assert set(run(Choice(1), 500, 0.03)) == {1}


@pytest.mark.parametrize(("planning_s", "wanted"), [(0.06, 2), (0.1, 3), (0.13, 4), (0.5, 4)])
def test_it_goes_up_to_what_there_is_time_for_and_stays(planning_s: float, wanted: int) -> None:
    found = run(Choice(1), 60 * WINDOW_TICKS, planning_s)
    assert found[-1] == wanted
    assert found == sorted(found)
    assert found[MOST_TICKS * WINDOW_TICKS] == wanted


def test_it_comes_down_only_after_a_while_with_much_room() -> None:
    choice = Choice(4)
    down = WINDOW_TICKS * ENOUGH_WINDOWS
    found = run(choice, down - 1, 0.01)
    assert set(found) == {4}
    assert run(choice, 3 * down, 0.01)[-1] == 1


@pytest.mark.parametrize("planning_s", [0.03, 0.04, 0.05, 0.06, 0.07, 0.09, 0.12])
def test_it_never_goes_to_and_fro_under_an_even_load(planning_s: float) -> None:
    for begin in (1, MOST_TICKS):
        found = run(Choice(begin), 100 * WINDOW_TICKS, planning_s)
        assert found in (sorted(found), sorted(found, reverse=True))


def test_a_single_slow_tick_and_a_slow_world_without_planning_change_nothing() -> None:
    choice = Choice(1)
    for _ in range(50):
        choice.ticked(-1.0, 1.05, PERIOD_S)
        run(choice, WINDOW_TICKS - 1, 0.02)
    assert choice.ticks == 1
    assert set(run(choice, 500, 0.001, other_s=0.08)) == {1}


def test_it_never_goes_below_the_least() -> None:
    assert set(run(Choice(1, least=2), 500, 0.001)) == {2}
    found = run(Choice(4, least=2), 10 * WINDOW_TICKS * ENOUGH_WINDOWS, 0.001)
    assert (found[-1], min(found)) == (2, 2)


def test_one_that_is_fixed_stays_and_others_are_told_of() -> None:
    assert set(run(Choice(1, fixed=2), 500, 0.5)) == {2}
    with structlog.testing.capture_logs() as lines:
        run(Choice(1), 4 * WINDOW_TICKS, 0.06)
    (line,) = lines
    assert line["log_level"] == "warning"
    assert line["interval_ticks"] == 2
    assert "planning interval goes up" in line["event"]
