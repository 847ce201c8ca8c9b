"""Thresholds: what they mean, and how those that mean nothing are refused."""

import re
from collections import Counter

import pytest

from esplanade.bots.histogram import Histogram
from esplanade.bots.measures import AMOUNTS, SPREADS
from esplanade.bots.options import MEASURES
from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import read_thresholds
from esplanade.bots.verdict import exit_code, warnings

TALLY = Tally(
    expected=20,
    joined=10,
    failed=10,
    lost=1,
    client_seconds=100.0,
    bytes_in=250_000,
    snapshots_due=2000,
    snapshots_received=260,
    snapshots_missing=1740,
    pings_sent=100,
    errors=Counter(flooding=3, closed_1006=1),
    snapshot_age_s=Histogram([0.01] * 90 + [0.5] * 10),
)


def crossed(text: str, tally: Tally = TALLY) -> bool:
    (threshold,) = read_thresholds(text)
    return threshold.verdict(tally).failed


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("snapshot_age.p99>200ms", True),
        ("snapshot_age.p99 > 0.6 s", False),
        ("snapshot_age.p90>200ms", False),
        ("snapshot_age.p90.5>200ms", True),
        ("snapshot_age.max>=500000us", True),
        ("snapshot_age.mean<10ms", False),
        ("snapshots.received<90%", True),
        ("snapshots.received<260", False),
        ("snapshots.received<=260", True),
        ("snapshots.missing>8.7e1%", False),
        ("snapshots.missing>=87%", True),
        ("clients.failed>50%", False),
        ("clients.lost>9%", True),
        ("errors>3", True),
        ("errors.flooding>3", False),
        ("errors.closed_1006>0", True),
        ("errors.no_such_thing>0", False),
        ("bytes.in>2kB/s", True),
        ("bytes.in>2600B/s", False),
    ],
)
def test_a_threshold_holds_or_does_not(text: str, holds: bool) -> None:
    assert crossed(text) is holds


def test_what_was_never_measured_is_within_no_limit() -> None:
    (verdict,) = [each.verdict(Tally()) for each in read_thresholds("join.p99>10s")]
    assert verdict.failed
    assert str(verdict) == "join.p99>10s: nothing was measured"
    assert crossed("snapshots.missing>5%", Tally())


def test_several_stand_in_one_text() -> None:
    found = read_thresholds("join.p99>1s, errors > 0")
    assert [each.text for each in found] == ["join.p99>1s", "errors > 0"]
    assert str(found[1].verdict(TALLY)) == "errors > 0: it is 4"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "'' is no threshold, expected one like snapshot_age.p99>200ms"),
        ("snapshot_age.p99", "is no threshold"),
        ("snapshot_age.p99=200ms", "is no threshold"),
        ("snapshot_age.p99>-1ms", "is no threshold"),
        ("__import__('os')>1", "is no threshold"),
        ("snapshot_age.p99>200", "the unit is missing, expected 'us' or"),
        ("snapshot_age.p99>200m", "unit 'm' does not fit"),
        ("snapshot_age>200ms", "something is missing after the measure"),
        ("snapshot_age.p0>200ms", "there is no 'p0'"),
        ("snapshot_age.p101>200ms", "there is no 'p101'"),
        ("snapshot_age.median>200ms", "there is no 'median'"),
        ("snapshots_age.p99>200ms", "no measure snapshots_age.p99; did you mean snapshot_age?"),
        ("qq>1", "there is no measure qq; there are join,"),
        ("clients.lost>1s", "unit 's' does not fit, expected no unit or '%'"),
        ("errors>1%", "unit '%' does not fit, expected no unit"),
        ("errors.flooding>1%", "unit '%' does not fit"),
        ("bytes.in>1", "the unit is missing, expected 'B/s'"),
    ],
)
def test_what_means_nothing_is_told(text: str, fault: str) -> None:
    with pytest.raises(ValueError, match=re.escape(fault)):
        read_thresholds(text)


def test_help_lists_every_measure() -> None:
    for name in (*SPREADS, *AMOUNTS):
        assert re.search(rf"(?<![\w.]){re.escape(name)}(?![\w.])", MEASURES), name


WELL = Tally(expected=2, joined=2, left=2, snapshots_due=100, snapshots_received=99)


@pytest.mark.parametrize(
    ("tally", "limits", "code"),
    [
        (WELL, (), 0),
        (WELL, ("snapshots.received<100%",), 3),
        (TALLY, (), 1),
        (TALLY, ("join.p99>1s",), 3),
        (Tally(expected=2, joined=2, left=2, errors=Counter(flooding=1)), (), 1),
        (Tally(expected=2, joined=2, left=2, errors=Counter(flooding=1)), ("errors>1",), 0),
        (Tally(expected=2, joined=1, failed=1), ("clients.failed>50%",), 0),
        (Tally(expected=2, failed=2), ("errors>5",), 1),
        (Tally(expected=2, joined=2, scenario_faults=Counter({"a.py:1": 1})), ("errors>5",), 1),
    ],
)
def test_exit_codes(tally: Tally, limits: tuple[str, ...], code: int) -> None:
    verdicts = [each.verdict(tally) for text in limits for each in read_thresholds(text)]
    assert exit_code(tally, verdicts, ()) == code


def test_a_fault_of_a_worker_fails_the_run() -> None:
    assert exit_code(WELL, (), ["a worker process ended without a word"]) == 1


def test_the_report_warns_of_what_spoils_it() -> None:
    told = "\n".join(warnings(TALLY, [read_thresholds("errors>3")[0].verdict(TALLY)]))
    assert told.startswith("limit crossed: errors>3: it is 4")
    assert "WARNING: only 13.0 % of the snapshots that were due came in (260 of 2,000)" in told
    assert "10 of 20 bots did not come in" in told
    assert list(warnings(WELL, ())) == []
    assert list(warnings(Tally(expected=3, failed=3), ())) == ["none of 3 bots came in"]
    busy = Tally(run_seconds=10.0, cpu_seconds=9.0)
    assert "nearly all of their processor time" in "\n".join(warnings(busy, ()))
