"""The estimate of the server's clock."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots.clock import KEPT, ServerClock


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
