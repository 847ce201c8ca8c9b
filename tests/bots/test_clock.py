"""The estimate of the server's clock."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots.clock import KEPT, ServerClock
from esplanade.bots.world_pace import WorldPace, pace_of
from esplanade.protocol.messages import Notice


def test_welcome_counts_until_the_first_pong() -> None:
    clock = ServerClock()
    clock.seed(100.0, now_s=7.0)
    assert clock.at(8.0) == 101.0
    assert clock.add(sent_s=8.0, received_s=8.2, server_time_s=100.9) == 8.2 - 8.0
    clock.seed(500.0, now_s=9.0)
    assert clock.local(clock.at(5.0)) == pytest.approx(5.0)
    assert abs(clock.at(9.1) - 101.9) < 1e-9


def test_the_quickest_round_trip_wins() -> None:
    clock = ServerClock()
    clock.add(0.0, 1.0, 10.6)
    clock.add(2.0, 2.01, 12.0)
    clock.add(3.0, 3.5, 13.2)
    assert abs(clock.at(4.0) - 13.995) < 1e-9


def test_old_round_trips_are_forgotten() -> None:
    clock = ServerClock()
    clock.add(0.0, 0.01, 100.0)
    for second in range(1, KEPT + 1):
        clock.add(float(second), second + 0.1, second + 100.05)
    assert abs(clock.at(50.0) - 150.0) < 1e-9


def test_a_step_of_the_servers_clock_counts_at_once() -> None:
    clock = ServerClock()
    clock.add(0.0, 0.01, 100.0)
    clock.add(1.0, 1.2, 100.6)
    assert abs(clock.at(2.0) - 101.5) < 1e-9


@given(
    offset_s=st.floats(-1e6, 1e6),
    ways=st.lists(st.tuples(st.floats(0, 2), st.floats(0, 2)), min_size=1, max_size=KEPT),
)
def test_the_error_is_at_most_half_the_quickest_round_trip(
    offset_s: float, ways: list[tuple[float, float]]
) -> None:
    clock = ServerClock()
    for second, (there_s, back_s) in enumerate(ways):
        clock.add(float(second), second + there_s + back_s, second + there_s + offset_s)
    quickest_s = min(there_s + back_s for there_s, back_s in ways)
    assert abs(clock.at(0.0) - offset_s) <= quickest_s / 2 + 1e-6


@pytest.mark.parametrize("rate", [0.1, 0.25, 1.0, 4.0])
def test_it_runs_at_the_pace_of_the_world(rate: float) -> None:
    clock = ServerClock()
    clock.add(0.0, 0.1, 100.05)
    # A notice is under way for half a round trip, in which the world goes on at the new rate.
    clock.pace(rate, server_time_s=101.0, now_s=1.05)
    assert clock.at(3.0) == pytest.approx(101.0 + 2.0 * rate)
    clock.add(5.0, 5.1, 101.0 + 4.05 * rate)
    clock.pace(rate, server_time_s=0.0, now_s=6.0)  # whoever shares the clock is told too
    assert clock.at(11.0) == pytest.approx(101.0 + 10.0 * rate)
    assert clock.local(101.0 + 10.0 * rate) == pytest.approx(11.0)


def test_in_a_pause_it_stands_and_follows_single_ticks() -> None:
    clock = ServerClock()
    clock.add(0.0, 0.1, 100.05)
    clock.pace(0.0, 101.0, 1.0)
    assert clock.at(60.0) == 101.0
    assert clock.local(200.0) == 1.0
    clock.add(60.0, 60.3, 101.5)
    clock.add(61.0, 61.4, 101.55)
    assert clock.at(99.0) == 101.55
    clock.pace(1.0, 101.55, 99.0)
    assert clock.at(100.0) == pytest.approx(102.55 + 0.2)


@given(
    rate=st.floats(0.1, 4.0),
    ways=st.lists(st.tuples(st.floats(0, 2), st.floats(0, 2)), min_size=1, max_size=KEPT),
)
def test_at_any_pace_the_error_is_at_most_half_the_quickest_round_trip(
    rate: float, ways: list[tuple[float, float]]
) -> None:
    clock = ServerClock()
    clock.pace(rate, 0.0, 0.0)
    for second, (there_s, back_s) in enumerate(ways):
        clock.add(float(second), second + there_s + back_s, rate * (second + there_s))
    quickest_s = min(there_s + back_s for there_s, back_s in ways)
    assert abs(clock.at(40.0) - 40.0 * rate) <= rate * quickest_s / 2 + 1e-6


@pytest.mark.parametrize(
    ("notice", "told", "found"),
    [
        ("pace", {"factor": 2, "rate": 1.5, "server_time": 3}, WorldPace(1.5, 3.0)),
        ("paused", {"factor": 1.0, "rate": 0, "server_time": 7.5}, WorldPace(0.0, 7.5)),
        ("announcement", {"rate": 1.0, "server_time": 1.0}, None),
        ("pace", {"rate": "fast", "server_time": 1.0}, None),
        ("resumed", {"rate": -1.0, "server_time": 1.0}, None),
        ("pace", {"rate": float("nan"), "server_time": 1.0}, None),
        ("pace", {}, None),
    ],
)
def test_a_notice_tells_the_pace(
    notice: str, told: dict[str, object], found: WorldPace | None
) -> None:
    assert pace_of(Notice(text="", notice=notice, arguments=told)) == found
