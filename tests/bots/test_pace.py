"""The progress of a replay: by the clock at first, then by the server's ticks."""

import asyncio

import pytest

from esplanade.bots.pace import Pace
from tests.patience import PATIENCE_S


@pytest.fixture
async def _stopped_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """No time passes while a test computes."""
    monkeypatch.setattr(asyncio.get_running_loop(), "time", lambda: 1000.0)


@pytest.mark.usefixtures("_stopped_clock")
async def test_ticks_take_over_from_the_clock_without_a_jump() -> None:
    pace = Pace(5.0, speedup=2.0)
    before = pace.recorded_s
    timeline = pace.timeline(1000, 0.05)
    assert timeline.recorded_s(1000) == pytest.approx(before)
    assert pace.timeline(1010, 0.05) is timeline
    assert pace.recorded_s == pytest.approx(timeline.recorded_s(1010))


@pytest.mark.usefixtures("_stopped_clock")
async def test_a_server_that_is_ahead_or_behind_sets_the_pace() -> None:
    pace = Pace(0.0, speedup=1.0)
    timeline = pace.timeline(100, 0.05)
    pace.saw(100 + 20 * 60)
    assert pace.recorded_s == pytest.approx(timeline.recorded_s(100) + 60.0)
    pace.saw(101)
    assert pace.recorded_s > 59.0


async def test_waiting_ends_at_the_moment_or_when_stopped() -> None:
    stop = asyncio.Event()
    pace = Pace(0.0, speedup=10.0)
    await pace.until(0.5, stop)
    assert pace.recorded_s >= 0.5
    waiting = asyncio.create_task(pace.until(1e6, stop))
    await asyncio.sleep(0)
    stop.set()
    await asyncio.wait_for(waiting, PATIENCE_S)
