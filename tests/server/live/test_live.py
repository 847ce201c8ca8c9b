"""Live views of a world that a test drives tick by tick: who holds an actor, whom it touches."""

import base64
import json
from typing import Any

import numpy as np
import pytest

from esplanade.actors.state import Reason
from esplanade.server.live import bulletin, tap
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.encounters import NearMisses
from esplanade.server.live.live import Live
from esplanade.server.live.subscriber import Subscriber
from esplanade.server.live.subscriptions import read_wish
from esplanade.server.live.trips import Progress, TimeRatios
from esplanade.server.metrics import Traffic
from tests.server.populated import HALL, Populated, spec


class Watched:
    """A world, and what operators see of it, beat by beat."""

    def __init__(self, *specs: Any) -> None:
        self.world = Populated(specs, scene=HALL)
        self.live = Live(self.world.zone, [0.0], Bulletin(), Traffic(), hide_names=False)

    def ticks(self, number: int, *inputs: Any) -> None:
        for k in range(number):
            self.live.tap.take(self.world.frame(*(inputs if k == 0 else ())), 0.001, 0)
            if k % 2:
                self.live.beat()
        self.live.beat()


def test_an_actor_whose_way_a_closed_door_bars_is_held_by_that_door() -> None:
    crossing = spec(1, "go_to", behaviour={"target": "east"}, place=(3.0, 4.0, 0.0))
    watched = Watched(crossing)
    watched.ticks(1)
    watched.world.zone.doors.want("gate", is_open=False)
    watched.ticks(160)
    avatar = watched.world.zone.avatar_of("main/a1")
    assert avatar is not None
    spans = watched.live.reasons.told(avatar, 0, names=True)
    last = spans[-1]
    assert last["reason"] == "no_path"
    assert last["blocker"]["kind"] == "door"
    assert last["blocker"]["id"] == "gate"
    assert last["seconds"] > 5.0
    (event,) = [each for each in watched.live.events if each.kind == "no_path"]
    assert event.told(names=True)["text"] == "A1 finds no path, held by the door gate"


def test_spans_name_the_person_who_stands_in_the_way_and_hide_the_name() -> None:
    crossing = spec(1, "go_to", behaviour={"target": "east"}, place=(3.0, 4.0, 0.0))
    watched = Watched(crossing)
    watched.ticks(1)
    people = watched.world.join(*((7.0, y) for y in (3.3, 3.8, 4.2, 4.7)))
    watched.live.tap._all = True
    watched.ticks(200)
    avatar = watched.world.zone.avatar_of("main/a1")
    assert avatar is not None
    named = [
        span["blocker"]
        for span in watched.live.reasons.told(avatar, 0, names=True)
        if span["blocker"] is not None and span["blocker"]["kind"] == "person"
    ]
    assert named
    assert {each["id"] for each in named} <= set(people)
    assert {each["name"] for each in named} <= {f"p{k}" for k in range(4)}
    hidden = [
        span["blocker"]
        for span in watched.live.reasons.told(avatar, 0, names=False)
        if span["blocker"] is not None and span["blocker"]["kind"] == "person"
    ]
    assert {each["name"] for each in hidden} <= {f"Person {who}" for who in people}


def test_a_contact_is_an_event_a_heat_and_a_figure() -> None:
    watched = Watched(spec(1, place=(3.0, 3.0, 0.0)))
    watched.ticks(1)
    zone = watched.world.zone
    (person,) = watched.world.join((3.2, 3.1))
    watched.live.tap._all = True
    slot = zone.state.slot(person)
    zone.state.positions[slot] = (3.2, 3.0)
    watched.ticks(4)
    (event,) = [each for each in watched.live.events if each.kind == "contact"]
    told = event.told(names=True)
    assert (told["who"], told["other"]) == ("main/a1", person)
    *_, answer = watched.live.heat.told("contacts", 60)
    assert answer is not None
    values = np.frombuffer(base64.b64decode(answer["storeys"][0]["values"]), "<f4")
    assert values.sum() == 1.0


def test_the_map_agrees_with_the_state_after_many_comings_and_goings() -> None:
    watched = Watched(*(spec(k, "wander") for k in (1, 2, 3)))
    seen: dict[int, tuple[int, ...]] = {}
    tick = 0
    random = np.random.default_rng(4)
    for _ in range(30):
        if random.random() < 0.4:
            watched.live.tap._all = False
            frame = watched.world.join((float(random.uniform(1, 6)), 5.0))
            watched.live.tap._all = True
            assert frame
        watched.ticks(int(random.integers(1, 5)))
        text, block = watched.live.map.since(tick, names=True)
        tick = watched.live.map.tick
        if text is not None and '"reset": true' in text:
            seen.clear()
        if block is not None:
            records = np.frombuffer(block[12:], watched.live.map.records.dtype)
            seen |= {record[0]: record for record in records.tolist()}
    assert sorted(seen) == watched.live.map.ids.tolist()
    assert list(map(tuple, watched.live.map.records.tolist())) == [
        seen[who] for who in sorted(seen)
    ]
    assert Reason.MOVING in {record[2] for record in seen.values()}


def test_who_stands_near_an_actor_without_touching_is_a_near_miss_once() -> None:
    watched = Watched(spec(1, place=(3.0, 3.0, 0.0)))
    watched.ticks(1)
    watched.world.join((3.0, 3.8))
    watched.live.tap._all = True
    near = NearMisses(watched.live.map)
    watched.ticks(2)
    touching = watched.world.zone.contacts.touching
    assert [near.count(touching), near.count(touching)] == [1, 0]
    watched.ticks(12)
    *_, answer = watched.live.heat.told("risk", 60)
    assert answer is not None
    assert np.frombuffer(base64.b64decode(answer["storeys"][0]["values"]), "<f4").sum() > 0.0


def test_the_time_of_a_trip_is_held_against_its_way_alone() -> None:
    ratios, ids = TimeRatios(), ("main/a1",)
    nowhere, there = np.full((1, 3), np.nan), np.array([[9.0, 1.0, 0.0]])
    speed = np.array([1.0])

    def at(time_s: float, wanted: Any, left_m: float, *, arrived: bool = False) -> list[float]:
        return ratios.take(
            Progress(time_s, ids, wanted, np.array([arrived]), np.array([left_m]), speed)
        )

    assert at(0.0, nowhere, np.nan) == []
    assert at(1.0, there, np.nan) == []
    assert at(1.25, there, 8.0) == []
    assert at(6.0, there, 3.0) == []
    assert at(13.0, there, 0.0, arrived=True) == [12.0 / 8.0]
    assert at(14.0, there, 0.0, arrived=True) == []


def test_questions_are_answered_while_the_world_stands() -> None:
    watched = Watched(spec(1))
    watched.ticks(1)
    avatar = watched.world.zone.avatar_of("main/a1")
    assert avatar is not None
    subscriber = Subscriber(names=True)
    subscriber.take(read_wish('{"subscribe": "actor:a1"}'))
    watched.live.hello(subscriber)
    watched.live.beat()
    before = subscriber.waiting
    for _ in range(8):
        watched.live.tap.stand()
    watched.live.beat()
    assert subscriber.waiting == before + 1


def test_after_lost_ticks_everybody_is_told_of_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tap, "MOST_TICKS", 3)
    watched = Watched(spec(1, "wander"), spec(2))
    watched.ticks(2)
    for _ in range(6):
        watched.live.tap.take(watched.world.frame(), 0.001, 0)
    assert watched.live.tap.lost == 3
    watched.live.beat()
    assert watched.live.map.ids.tolist() == sorted(
        watched.world.zone.state.ids[watched.world.zone.state.live()].tolist()
    )
    text, block = watched.live.map.since(2, names=True)
    assert text is not None
    assert json.loads(text)["reset"] is True
    assert block is not None


def test_of_too_many_notices_the_oldest_are_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bulletin, "MOST_NOTICES", 2)
    board = Bulletin()
    for name in ("one", "two", "three"):
        board.about(name)
    assert board.lost == 1
    assert [notice.about for notice in board.fetch()] == ["two", "three"]
    assert board.fetch() == []
