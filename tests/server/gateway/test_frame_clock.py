"""A gateway's clock goes by the frames of its zone, at the pace that they tell."""

import pytest

from esplanade.server.gateway.frame_clock import FrameClock

TICK_S = 0.05


def test_a_clock_runs_at_the_rate_that_frames_tell() -> None:
    clock = FrameClock(TICK_S)
    for tick in range(100):
        clock.take(tick, 10.0 + TICK_S * tick)
    assert clock.at(15.0) == pytest.approx(5.0)
    for tick in range(100, 120):  # a quarter as fast
        clock.take(tick, 15.0 + 4 * TICK_S * (tick - 100), 0.25)
    assert clock.at(19.0) == pytest.approx(6.0)
    assert clock.at(19.0 + 1.0) == pytest.approx(6.25)
    clock.take(120, 19.5, 0.0)
    assert clock.at(19.5) == clock.at(500.0) == pytest.approx(6.0)


def test_a_frame_that_is_late_does_not_turn_the_clock_back() -> None:
    clock = FrameClock(TICK_S)
    clock.take(100, 1.0)
    clock.take(101, 1.0 + TICK_S + 0.2)
    assert clock.at(1.25) == pytest.approx(5.25)
