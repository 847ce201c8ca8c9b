"""Requests for traces: how many wait, whom one trace is for, and when it is made."""

from concurrent.futures import Future

import pytest

from esplanade.server.live.traces import (
    MOST_PASSED,
    MOST_WAITING,
    ROOM_S,
    TooManyError,
    Traced,
    Traces,
)
from tests.server.populated import HALL, Populated, spec


class Asked:
    """A world with two actors, and the requests to it."""

    def __init__(self, *, kept: bool = True) -> None:
        self.world = Populated((spec(1), spec(2)), scene=HALL)
        self.traces = Traces(self.world.zone)
        self.world.zone.keep_decisions(kept)
        for _ in range(2):
            self.world.frame()
        self.avatars = [self.world.zone.avatar_of(f"main/a{n}") or 0 for n in (1, 2)]

    def ask(self, number: int) -> "Future[Traced | None]":
        return self.traces.ask(self.avatars[number])


def test_one_trace_is_for_all_who_asked_for_that_actor() -> None:
    asked = Asked()
    answers = [asked.ask(number) for number in (0, 1, 0, 1, 0)]
    assert asked.traces.ticked(1.0)
    asked.traces.make_one()
    assert [answer.done() for answer in answers] == [True, False, True, False, True]
    traced = answers[0].result()
    assert traced is not None
    assert traced.trace.exact
    assert traced.tick == asked.world.zone.tick
    assert answers[2].result() is traced
    asked.traces.make_one()
    assert all(answer.done() for answer in answers)
    assert (asked.traces.made, asked.traces.waiting) == (2, 0)
    assert not asked.traces.ticked(1.0)
    asked.traces.make_one()


def test_more_than_may_wait_are_refused() -> None:
    asked = Asked()
    for _ in range(MOST_WAITING):
        asked.ask(0)
    with pytest.raises(TooManyError):
        asked.ask(1)
    assert asked.traces.refused == 1
    asked.traces.make_one()
    asked.ask(1)


def test_a_tick_that_is_due_comes_first_but_not_for_ever() -> None:
    asked = Asked()
    asked.ask(0)
    passed = [asked.traces.ticked(ROOM_S / 2) for _ in range(MOST_PASSED + 1)]
    assert passed == [False] * MOST_PASSED + [True]
    assert asked.traces.ticked(ROOM_S)


def test_what_is_not_known_is_answered_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked()
    nobody = asked.traces.ask(10**9)
    gone = asked.ask(0)
    gone.cancel()
    asked.traces.make_one()
    asked.traces.make_one()
    assert nobody.result() is None
    failing = asked.ask(1)
    monkeypatch.setattr(type(asked.world.zone), "trace", lambda *_: 1 / 0)
    asked.traces.make_one()
    assert failing.result() is None


def test_what_nobody_waits_for_any_more_is_not_made() -> None:
    asked = Asked()
    gone, stays = asked.ask(0), asked.ask(1)
    gone.cancel()
    asked.traces.make_one()
    assert stays.result() is not None
    assert (asked.traces.made, asked.traces.waiting) == (1, 0)


def test_a_world_that_stands_and_has_kept_nothing_says_so_at_once() -> None:
    asked = Asked(kept=False)
    answer = asked.ask(0)
    assert not asked.traces.stood()
    assert answer.result() is None
    asked.world.frame()  # it is kept from now on
    again = asked.ask(0)
    assert asked.traces.stood()
    asked.traces.make_one()
    assert again.result() is not None
