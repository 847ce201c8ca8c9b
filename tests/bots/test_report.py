"""Figures and tables of a run."""

import io
import json
from collections import Counter

import pytest
from rich.console import Console

from esplanade.bots.figures import figures
from esplanade.bots.histogram import Histogram
from esplanade.bots.report import show
from esplanade.bots.tally import Tally


def full() -> Tally:
    return Tally(
        expected=10,
        joined=9,
        failed=1,
        left=8,
        lost=1,
        skipped=2,
        messages_in=1000,
        messages_out=50,
        bytes_in=123_456,
        bytes_out=789,
        steps=400,
        step_bytes=94_000,
        walker_seconds=200.0,
        client_seconds=50.0,
        cpu_seconds=0.5,
        snapshots_due=1000,
        snapshots_received=900,
        snapshots_missing=100,
        snapshots_late=20,
        pings_sent=50,
        pings_unanswered=2,
        errors=Counter(flooding=3),
        scenario_faults=Counter({"tour.py:3: ValueError: no": 2}),
        join_s=Histogram([0.02]),
        round_trip_s=Histogram([0.001] * 99 + [0.05]),
        snapshot_age_s=Histogram([0.01]),
        snapshot_interval_s=Histogram([0.05]),
        deviation_m=Histogram([0.01] * 3 + [0.2]),
        near=3,
        capped=4,
    )


def text_of(tally: Tally) -> str:
    out = io.StringIO()
    show(Console(file=out, width=100), tally)
    return out.getvalue()


def test_figures_are_plain_json() -> None:
    found = json.loads(json.dumps(figures(full()).plain()))
    assert found["clients"]["lost"] == 1
    assert found["bytes"] == {"in": 123_456, "out": 789}
    assert found["per_client_and_second"]["bytes_in"] == pytest.approx(2469.12)
    assert found["per_client_and_second"]["cpu_us"] == pytest.approx(10_000)
    assert found["round_trip_ms"]["p50"] == pytest.approx(1.0, rel=0.011)
    assert found["round_trip_ms"]["max"] == 50.0
    assert found["steps"]["bytes_per_walker_and_second"] == 470.0
    assert found["errors"] == {"flooding": 3}
    assert found["scenario_faults"] == {"tour.py:3: ValueError: no": 2}
    assert found["snapshots"]["received_share"] == 0.9
    assert found["pings"] == {"sent": 50, "unanswered": 2}
    assert found["join_ms"]["p99.9"] == 20.0
    assert found["replay"]["share_within_0_1_m"] == 0.75
    assert found["replay"]["skipped"] == 2


def test_nothing_measured_is_none_not_zero() -> None:
    found = figures(Tally()).plain()
    assert found["round_trip_ms"]["p50"] is None
    assert found["per_client_and_second"]["bytes_in"] is None
    assert found["steps"]["bytes_per_walker_and_second"] is None
    assert "replay" not in found
    assert "0 of 0" in text_of(Tally())


def test_tables_tell_everything() -> None:
    text = text_of(full())
    for words in (
        "9 of 10",
        "2,469.1",
        "1,000",
        "skipped",
        "75.00 %",
        "flooding",
        "round trip, ms",
        "470.0",
        "100 = 10.0 %",
        "2 of 50",
        "tour.py:3: ValueError: no",
        "p99.9",
    ):
        assert words in text


def test_tables_leave_out_what_did_not_happen() -> None:
    text = text_of(Tally(expected=1, joined=1, left=1))
    for words in ("skipped", "Errors", "recorded way", "round trip", "who walks"):
        assert words not in text
