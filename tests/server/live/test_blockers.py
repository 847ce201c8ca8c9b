"""Who holds an actor, and whom it touches, in a world that a test drives tick by tick."""

import base64
from typing import Any

import numpy as np

from esplanade.actors.state import Reason
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.live import Live
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
