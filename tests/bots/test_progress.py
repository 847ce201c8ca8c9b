"""The progress that is shown while a run goes on."""

import io

import pytest
from rich.console import Console

from esplanade.bots.histogram import Histogram
from esplanade.bots.progress import Progress
from esplanade.bots.tally import Tally

TALLY = Tally(expected=5, joined=4, lost=1, bytes_in=3000, round_trip_s=Histogram([0.002]))


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time, to be moved on by hand."""
    now = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    return now


def test_without_a_terminal_a_plain_line_comes_now_and_then(clock: list[float]) -> None:
    out = io.StringIO()
    with Progress(Console(file=out)) as shown:
        for _ in range(20):
            clock[0] += 0.5
            shown.show_tally(TALLY)
    lines = out.getvalue().splitlines()
    assert len(lines) == 2
    assert "3 here" in lines[0]
    assert "4/5 joined" in lines[0]
    assert "0 failed, 1 lost" in lines[0]
    assert "round trip p50 2.0 p99 2.0 ms" in lines[0]
    assert "\x1b" not in out.getvalue()


def test_on_a_terminal_one_line_changes(clock: list[float]) -> None:
    out = io.StringIO()
    with Progress(Console(file=out, force_terminal=True, width=120)) as shown:
        shown.show_tally(TALLY)
        clock[0] += 2.0
        shown.show_tally(TALLY)
    assert "4/5 joined" in out.getvalue()
    assert "1.5 kB/s each" not in out.getvalue()
    assert "0.5 kB/s each" in out.getvalue()


def test_nothing_yet_is_shown_as_well(clock: list[float]) -> None:
    out = io.StringIO()
    with Progress(Console(file=out)) as shown:
        clock[0] += 6.0
        shown.show_tally(Tally(expected=5))
    assert "0/5 joined" in out.getvalue()
