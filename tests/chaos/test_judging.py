"""Every bar is missed by what it is there for, and cleared by a world that is well."""

from dataclasses import replace
from typing import Any

import pytest
from chaos.attacks.catalogue import ATTACKS
from chaos.canary import Sighting
from chaos.judging import Bars, missed
from chaos.server import grown, samples, unnamed
from chaos.trial import Trial, naming

WELL = Sighting(
    seconds=8.0,
    gap_ms=70.0,
    snapshots=160,
    due=160,
    dropped=0,
    ping_ms=5.0,
    way_ms=90.0,
    chat_ms=4.0,
    unheard=0,
    join_ms=50.0,
    turned_away=0,
    own_lag_ms=3.0,
    lost="",
)
GOOD = Trial(
    attack="pings",
    before=WELL,
    sighting=WELL,
    memory_before_mb=300.0,
    memory_most_mb=310.0,
    memory_after_mb=305.0,
    ticks_per_s=20.0,
    processor=0.3,
    named={'esplanade_floods_total{what="frames"}': 3.0},
    lines=["client closed, it floods frames"],
    unnamed=[],
)
BARS = Bars.beside(WELL)


def test_a_world_that_is_well_misses_nothing() -> None:
    assert missed(GOOD, ATTACKS["pings"], BARS) == []


def test_bars_are_fixed_or_twice_what_is_seen_alone() -> None:
    assert Bars(gap_ms=150.0, way_ms=300.0) == BARS
    slow = replace(WELL, gap_ms=100.0, way_ms=200.0)
    assert Bars.beside(slow) == Bars(gap_ms=200.0, way_ms=400.0)
    busy = replace(GOOD, before=slow, sighting=replace(WELL, gap_ms=190.0))
    assert missed(busy, ATTACKS["pings"], BARS) == []
    assert missed(replace(busy, before=WELL), ATTACKS["pings"], BARS) != []


@pytest.mark.parametrize(
    ("seen", "words"),
    [
        ({"gap_ms": 151.0}, "151 ms without a snapshot"),
        ({"dropped": 1}, "1 snapshots were left out"),
        ({"way_ms": 301.0}, "301 ms until walk_to counted"),
        ({"unheard": 2}, "2 lines of chat were not heard"),
        ({"turned_away": 3}, "3 newcomers were not let in"),
        ({"lost": "closed with 4008"}, "the canary lost its connection: closed with 4008"),
    ],
    ids=str,
)
def test_what_the_canary_sees_is_judged(seen: dict[str, Any], words: str) -> None:
    (found,) = missed(replace(GOOD, sighting=replace(WELL, **seen)), ATTACKS["pings"], BARS)
    assert words in found


@pytest.mark.parametrize(
    ("trial", "words"),
    [
        ({"memory_most_mb": 316.0}, "memory grew by 5 %"),
        ({"unnamed": ["a traceback"]}, "1 unforeseen faults in the log: a traceback"),
        ({"lines": []}, "no log line names the attacker"),
        ({"named": {}}, "no metric counts the attacker"),
        ({"faults": ["a wrong key was taken"]}, "a wrong key was taken"),
    ],
    ids=str,
)
def test_what_the_server_shows_is_judged(trial: dict[str, Any], words: str) -> None:
    (found,) = missed(replace(GOOD, **trial), ATTACKS["pings"], BARS)
    assert words in found


def test_an_attack_within_its_limits_need_not_be_named() -> None:
    quiet = replace(GOOD, lines=[], named={})
    assert missed(quiet, ATTACKS["frozen"], BARS) == []


def test_an_attack_that_needs_speed_is_named_once_it_was_refused_something() -> None:
    quiet = replace(GOOD, lines=[], named={})
    assert missed(quiet, ATTACKS["joins"], BARS) == []
    assert len(missed(replace(quiet, counts={"refused": 1}), ATTACKS["joins"], BARS)) == 2


def test_totals_are_compared_by_their_labels() -> None:
    text = (
        "# TYPE floods counter\n"
        'floods_total{{what="frames"}} {}\n'
        "# TYPE other counter\nother_total {}\n"
    )
    before, after = samples(text.format(1, 5)), samples(text.format(4, 9))
    assert grown(before, after, ("floods_total",)) == {'floods_total{what="frames"}': 3.0}


def test_the_log_is_searched_for_the_attacker_and_for_unforeseen_faults() -> None:
    lines = [
        {"event": "connection refused", "why": "address_sockets", "address": "127.0.0.2"},
        {"event": "connection refused", "why": "address_sockets", "address": "127.0.0.2"},
        {"event": "connection refused", "why": "port_full", "address": "127.0.0.1"},
        {"event": "connection failed", "level": "error", "exception": "Traceback"},
        {"raw": "Segmentation fault"},
    ]
    assert naming(lines) == ["connection refused address_sockets"]
    assert len(unnamed(lines)) == 2
