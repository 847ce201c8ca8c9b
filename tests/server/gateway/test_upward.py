"""Wishes of people wait for a batch, and a movement goes out until it is acknowledged."""

from typing import Any, cast

import pytest

from esplanade.protocol.messages import Report, WalkTo
from esplanade.server.cluster.person_record import PersonRecord
from esplanade.server.gateway.frame_clock import FrameClock
from esplanade.server.gateway.occupant import Occupant
from esplanade.server.gateway.upward import AGAIN_S, MOST_TRIES, MOST_WAITING, Upward

EPOCH = 3


@pytest.fixture
def ann() -> Occupant:
    return Occupant(7, 2, cast(Any, None), PersonRecord(), resumed=False, since_s=0.0)


def test_of_each_person_the_newest_movement_goes_out(ann: Occupant) -> None:
    upward = Upward("east")
    assert upward.batch(EPOCH, [], 0.0) is None
    upward.steer(ann, 1, 0.0, 1.0)
    upward.walk(ann, WalkTo(seq=2, x=1.0, y=2.0))
    upward.steer(ann, 3, 0.5, 1.5)
    batch = upward.batch(EPOCH, [], 0.0)
    assert batch is not None
    assert (batch.gateway, batch.number, batch.epoch) == ("east", 1, EPOCH)
    assert batch.movements.tolist() == [(7, 2, 3, 0.5, 1.5)]
    assert batch.walks == []


def test_a_movement_goes_out_again_until_it_is_acknowledged(ann: Occupant) -> None:
    upward = Upward("east")
    upward.steer(ann, 3, 0.0, 1.0)
    assert upward.batch(EPOCH, [], 0.0) is not None
    assert upward.batch(EPOCH, [], AGAIN_S / 2) is None
    again = upward.batch(EPOCH, [], AGAIN_S)
    assert again is not None
    assert again.movements["seq"].tolist() == [3]
    upward.acknowledge({7: 2, 8: 3})
    assert upward.batch(EPOCH, [], 3 * AGAIN_S) is not None
    upward.acknowledge({7: 3})
    assert upward.batch(EPOCH, [], 9 * AGAIN_S) is None


def test_a_walk_that_nothing_comes_of_is_given_up(ann: Occupant) -> None:
    upward = Upward("east")
    upward.walk(ann, WalkTo(seq=1, x=1.0, y=2.0))
    sent = [upward.batch(EPOCH, [], 1.01 * k * AGAIN_S) is not None for k in range(2 * MOST_TRIES)]
    assert sent == [True] * MOST_TRIES + [False] * MOST_TRIES


def test_whoever_departs_or_stands_wants_nothing_any_more(ann: Occupant) -> None:
    upward = Upward("east")
    upward.steer(ann, 1, 0.0, 1.0)
    upward.stand(ann)
    upward.watch(ann, 9)
    upward.depart(ann, comes_back=True)
    batch = upward.batch(EPOCH, [(7, 2)], 0.0)
    assert batch is not None
    assert (len(batch.movements), batch.watched) == (0, [])
    assert (batch.stood, batch.departed, batch.held) == ([(7, 2)], [(7, 2, True)], [(7, 2)])


def test_lines_that_nobody_takes_are_refused_in_the_end(ann: Occupant) -> None:
    upward = Upward("east")
    assert all(upward.say(ann, str(k)) for k in range(MOST_WAITING))
    assert not upward.say(ann, "one more")
    assert upward.left_out == 1


def test_a_report_goes_out_once_and_few_wait(ann: Occupant) -> None:
    upward = Upward("east")
    report = Report(id=8, text="is rude")
    assert all(upward.report(ann, report) for _ in range(MOST_WAITING))
    assert not upward.report(ann, report)
    batch = upward.batch(EPOCH, [], 0.0)
    assert batch is not None
    assert batch.reports == [(7, 2, report)] * MOST_WAITING
    assert upward.batch(EPOCH, [], 0.0) is None


def test_a_clock_goes_by_the_frame_that_came_quickest() -> None:
    clock = FrameClock(0.05)
    assert clock.at(100.0) == 0.0
    clock.take(200, 100.03)
    clock.take(201, 100.05)
    clock.take(202, 100.30)
    assert clock.at(100.05) == pytest.approx(201 * 0.05)
    clock.begin()
    clock.take(20, 101.0)
    assert clock.at(101.5) == pytest.approx(1.5)
