"""Commands on actors: carried out whole in a tick, or refused without a trace, and told."""

import math
from collections.abc import Iterator
from typing import Any

import msgpack
import numpy as np
import pytest

from esplanade.actors import Population
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.server.world.actor_commands import MOST_WAITING
from esplanade.server.world.inputs import (
    ActorCommand,
    ChangeBehaviour,
    HoldActors,
    Join,
    MoveDoor,
    PlaceActor,
    RemoveActors,
    SendActors,
    SetParameters,
    Watch,
)
from esplanade.server.world.outcomes import FaultCode, Outcome
from tests.server.populated import Populated, adding, spec

A1, A2 = "main/a1", "main/a2"


@pytest.fixture
def world() -> Iterator[Populated]:
    populated = Populated([spec(1), spec(2)])
    populated.frame()
    yield populated
    populated.population.close()


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> Iterator[Populated]:
    # Without the time that work takes there is no rest after it.
    monkeypatch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
    populated = Populated([spec(1), spec(2)], outside=True)
    populated.frame()
    yield populated
    populated.population.close()


def test_an_actor_that_is_added_is_in_the_world_in_the_same_tick(world: Populated) -> None:
    (ann,) = world.join((3.0, 3.0))
    news = world.news(adding(7, spec(3, place=(3.0, 5.0, 0.0)), speed_mps=1.0))
    assert news.actors == 3
    assert len(news.entered[ann]) == 1
    slot = world.slot("main/a3")
    assert world.zone.state.names[slot] == "A3"
    assert world.zone.state.positions[slot].tolist() == pytest.approx([3.0, 5.0], abs=0.2)
    assert world.zone.parameters("main/a3").speed_mps == 1.0
    assert world.zone.actors["main/a3"].name == "A3"


def test_of_actors_that_are_added_all_come_in_or_none(world: Populated) -> None:
    free, taken = spec(3), spec(1)
    assert world.fault(adding(1, free, taken)).code is FaultCode.TAKEN
    assert world.fault(adding(2, free, free)).code is FaultCode.REFUSED
    lost = spec(4, "go_to", behaviour={"target": "moon"})
    assert world.fault(adding(3, free, lost)).code is FaultCode.UNKNOWN_PLACE
    outside = spec(4, place=(400.0, 1.0, 0.0))
    assert world.fault(adding(4, free, outside)).code is FaultCode.REFUSED
    assert list(world.population.table) == [A1, A2]
    many = [spec(k, place=None) for k in range(10, 10 + world.zone.most_actors)]
    assert world.fault(adding(5, *many)).arguments == {"most": 258, "there": 2}


def test_an_actor_that_is_removed_is_gone_in_the_same_tick(world: Populated) -> None:
    (ann,) = world.join((3.0, 3.0))
    avatar = world.zone.avatar_of(A1)
    assert avatar is not None
    world.frame(Watch(ann, avatar))
    news = world.news(RemoveActors(5, (A1,)))
    assert news.left == {ann: [avatar]}
    assert news.actors == 1
    assert avatar not in world.zone.state
    assert not any(frame.events.plans for frame in world.frames(8))
    assert world.zone.avatar_of(A1) is None
    assert A1 not in world.zone.actors
    world.news(adding(6, spec(1)))
    assert world.zone.avatar_of(A1) not in (None, avatar)


def test_a_place_of_one_who_was_removed_is_another_ones_with_feet_of_its_own(
    world: Populated,
) -> None:
    world.frame(RemoveActors(1, (A1, A2)), adding(2, spec(3, place=(10.0, 7.0, 0.0))))
    assert world.zone.count() == (0, 1)
    assert world.zone.feet.failures == world.zone.feet.lost == 0
    steps = world.zone.steps.records[world.slot("main/a3")]
    assert int(steps["id"]) == world.zone.avatar_of("main/a3")
    assert world.zone.failures == 0


def test_a_door_closes_when_the_actor_in_its_way_is_removed() -> None:
    world = Populated([spec(1, place=(7.0, 4.0, 0.0))])
    world.frame(HoldActors(1, (A1,), held=True))
    assert world.frame(MoveDoor("gate", is_open=False)).events.doors == {}
    assert world.frame().events.doors == {}
    assert world.frame(RemoveActors(2, (A1,))).events.doors == {"gate": False}
    world.population.close()


def test_every_outcome_is_told_by_the_number_of_its_command(world: Populated) -> None:
    frame = world.frame(
        SetParameters(4, (A1, A2), {"speed_mps": [1.0, 1.2]}),
        SetParameters(5, (A1,), {"speed_mps": 9.0}),
        RemoveActors(6, ("main/nobody",)),
    )
    done, wrong, unknown = frame.outcomes
    assert done == Outcome(4, frame.tick)
    assert wrong.fault is not None
    assert (wrong.command, wrong.fault.code) == (5, FaultCode.VALUES)
    (above, order) = wrong.fault.arguments["faults"]
    assert (above["field"], above["code"], above["limit"]) == ("speed_mps", "above", 3.0)
    assert (order["code"], order["other"]) == ("order", "max_speed_mps")
    assert unknown.fault is not None
    assert unknown.fault.arguments == {"actor": "main/nobody"}
    assert [world.zone.parameters(each).speed_mps for each in (A1, A2)] == [1.0, 1.2]
    assert world.frame().outcomes == []


def test_what_would_be_refused_is_said_beforehand(world: Populated) -> None:
    fault = world.zone.check(SetParameters(1, (A1,), {"radius_m": 7.0}))
    assert fault is not None
    assert fault.code is FaultCode.VALUES
    assert world.zone.check(SetParameters(1, (A1,), {"radius_m": 0.3})) is None
    assert world.zone.parameters(A1).radius_m == 0.25


@pytest.mark.parametrize(
    "command",
    [
        SetParameters(1, (A1, A2), {"speed_mps": 1.0, "radius_m": 0.3}),
        adding(1, spec(3, place=(10.0, 7.0, 0.0))),
        RemoveActors(1, (A1,)),
        SendActors(1, (A1,), "east"),
        PlaceActor(1, A1, (10.0, 7.0, 0.0)),
        HoldActors(1, (A1,), held=True),
    ],
    ids=lambda command: type(command).__name__,
)
def test_a_command_that_fails_half_way_is_undone_and_told(
    world: Populated, command: ActorCommand, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = story(world)
    with monkeypatch.context() as broken:
        for name in ("set_many", "add_many", "remove_many", "set_behaviour", "place", "hold"):
            broken.setattr(Population, name, failing_after(getattr(Population, name)))
        fault = world.fault(command)
    assert (fault.code, fault.text) == (FaultCode.FAILED, "it failed: told to fail")
    assert story(world, positions=False) == {**before, "positions": None}
    assert world.frame(command).outcomes == [Outcome(1, world.zone.tick)]


def failing_after(method: Any) -> Any:
    def fail(*arguments: Any, **more: Any) -> None:
        method(*arguments, **more)
        raise RuntimeError("told to fail")

    return fail


def story(world: Populated, *, positions: bool = True) -> dict[str, Any]:
    """All that a command may have changed."""
    table, population = world.population.table, world.population
    return {
        "ids": table.ids,
        "parameters": table.agents.parameters.tobytes(),
        "bodies": table.agents.bodies.tolist(),
        "goals": table.trips.wanted.tobytes(),
        "positions": table.agents.positions.tobytes() if positions else None,
        "behaviours": [type(population._behaviours[each]) for each in table.ids],
        "held": [population.held(each) for each in table.ids],
        "users": [n for n in population.navigator.potentials.users if n],
    }


def test_an_input_that_nobody_foresaw_does_not_end_ticking(
    world: Populated, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.world.actor_commands.check", failing_after(lambda *_: 0))
    assert world.fault(RemoveActors(1, (A1,))).code is FaultCode.FAILED
    monkeypatch.setattr(type(world.zone._actors), "_match_rows", failing_after(lambda *_: 0))
    world.zone._actors._version = -1
    frame = world.frame()
    assert world.zone.failures == 1
    assert frame.actors == 2


# --- behaviours ------------------------------------------------------------------------------


def test_actors_do_something_else_from_now_on(world: Populated) -> None:
    behaviour = BEHAVIOUR_SPEC.validate_python({"kind": "patrol", "stops": ["west", "east"]})
    world.frame(ChangeBehaviour(1, (A1, A2), behaviour))
    assert [world.population.explain(each).behaviour for each in (A1, A2)] == ["patrol"] * 2
    assert world.zone.actors[A1].behaviour == behaviour
    moon = BEHAVIOUR_SPEC.validate_python({"kind": "go_to", "target": "moon"})
    assert world.fault(ChangeBehaviour(2, (A1,), moon)).code is FaultCode.UNKNOWN_PLACE
    assert world.population.explain(A1).behaviour == "patrol"


def test_an_actor_is_sent_and_stays_there(world: Populated) -> None:
    world.frame(SendActors(1, (A1,), (6.0, 2.0, 0.0)))
    world.frames(140)
    where = world.zone.state.positions[world.slot(A1)]
    assert math.dist(where, (6.0, 2.0)) < 0.4


def test_an_actor_is_put_elsewhere_at_once_and_touches_nobody_on_its_way(world: Populated) -> None:
    world.join((2.2, 4.0))
    contacts = world.zone.contacts.actor_person
    world.frame(PlaceActor(1, A1, (2.2, 7.0, 0.0)))
    assert world.zone.state.positions[world.slot(A1)].tolist() == pytest.approx([2.2, 7.0], abs=0.1)
    assert world.zone.contacts.actor_person == contacts


def test_an_actor_that_is_held_stands_until_it_is_let_go() -> None:
    world = Populated([spec(1, "patrol", behaviour={"stops": ["east", "west"]})])
    world.frames(20)
    world.frame(HoldActors(1, (A1,), held=True))
    world.frames(30)
    stood = world.zone.state.positions[world.slot(A1)].copy()
    world.frames(40)
    assert math.dist(stood, world.zone.state.positions[world.slot(A1)]) < 0.05
    assert world.population.explain(A1).behaviour == "patrol"
    world.frame(HoldActors(2, (A1,), held=False))
    world.frames(60)
    assert math.dist(stood, world.zone.state.positions[world.slot(A1)]) > 1.0
    world.population.close()


# --- bodies ----------------------------------------------------------------------------------


def test_others_see_the_new_body(world: Populated) -> None:
    (ann,) = world.join((3.0, 3.0))
    slot, avatar = world.slot(A1), world.zone.avatar_of(A1)
    before = world.zone.state.statures_m[slot]
    news = world.news(SetParameters(1, (A1,), {"radius_m": 0.3, "height_m": 1.35}))
    ((body, viewers),) = news.reshaped
    assert (body.id, viewers) == (avatar, [ann])
    assert (body.radius_m, body.stature_m) == (0.3, pytest.approx(0.75 * before))
    assert world.zone.state.radii[slot] == 0.3
    assert world.news().reshaped == []
    news = world.news(Join(0, "Ben", (3.5, 3.5, 0.0)))
    entities = [msgpack.unpackb(packed) for packed in news.entered[max(news.entered)]]
    assert {one["id"]: one["radius"] for one in entities}[avatar] == 0.3


@pytest.mark.parametrize("height_m", [0.8, 2.5])
def test_bodies_of_every_height_have_feet(height_m: float) -> None:
    world = Populated([spec(1, "patrol", behaviour={"stops": ["east", "west"]})])
    world.frames(5)
    legs = {"height_m": height_m, "step_on_m": 0.3, "leg_length_m": 0.4}
    world.frame(SetParameters(1, (A1,), legs))
    begun = world.zone.feet.begun
    world.frames(100)
    assert world.zone.feet.failures == world.zone.feet.lost == 0
    assert world.zone.feet.begun > begun + 5
    world.population.close()


def test_a_body_is_prepared_outside_and_the_old_one_goes_on_until_then(served: Populated) -> None:
    assert served.frame(SetParameters(1, (A1,), {"radius_m": 0.4})).outcomes == []
    assert served.zone.parameters(A1).radius_m == 0.25
    assert served.zone.commands_waiting == 1
    outcomes = [outcome for frame in served.frames(4) for outcome in frame.outcomes]
    assert [(outcome.command, outcome.fault) for outcome in outcomes] == [(1, None)]
    assert served.zone.parameters(A1).radius_m == 0.4
    assert served.zone.commands_waiting == 0


def test_a_change_of_temper_waits_for_nothing(served: Populated) -> None:
    frame = served.frame(SetParameters(1, (A1,), {"risk_weight": 30.0}))
    assert frame.outcomes == [Outcome(1, frame.tick)]
    assert served.zone.parameters(A1).risk_weight == 30.0


def test_commands_for_the_same_actor_keep_their_order(served: Populated) -> None:
    served.frame(
        SetParameters(1, (A1,), {"radius_m": 0.4, "speed_mps": 1.0}),
        SetParameters(2, (A1,), {"speed_mps": 1.4}),
        SetParameters(3, (A2,), {"speed_mps": 0.9}),
    )
    assert served.zone.parameters(A2).speed_mps == 0.9
    told = [outcome.command for frame in served.frames(8) for outcome in frame.outcomes]
    assert told == [1, 2]
    assert served.zone.parameters(A1).speed_mps == 1.4


def test_of_a_slider_that_is_dragged_the_last_value_counts(served: Populated) -> None:
    waiting = [SetParameters(k, (A1,), {"radius_m": 0.3 + 0.01 * k}) for k in range(5)]
    frame = served.frame(*waiting)
    assert [(o.command, o.fault and o.fault.code) for o in frame.outcomes] == [
        (k, FaultCode.SUPERSEDED) for k in range(4)
    ]
    assert [o for f in served.frames(6) for o in f.outcomes if o.fault] == []
    assert served.zone.parameters(A1).radius_m == pytest.approx(0.34)


def test_no_more_commands_wait_than_there_may_be(served: Populated) -> None:
    many = [SetParameters(k, (A1,), {"radius_m": 0.4, "speed_mps": 1.0}) for k in range(1)]
    many += [RemoveActors(k, (A1,)) for k in range(1, MOST_WAITING + 3)]  # type: ignore[misc]
    outcomes = served.frame(*many).outcomes
    assert [(o.fault and o.fault.code) for o in outcomes] == [FaultCode.BUSY] * 3
    assert served.zone.commands_waiting == MOST_WAITING


def test_new_actors_come_in_when_their_places_are_found(served: Populated) -> None:
    wave = adding(1, *(spec(k, "wander", place=None) for k in range(3, 9)), radius_m=0.3)
    assert served.frame(wave).actors == 2
    frames = served.frames(4)
    assert [o.fault for frame in frames for o in frame.outcomes] == [None]
    assert frames[-1].actors == 8
    places = served.population.table.agents.positions
    away = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
    assert away[~np.eye(8, dtype=bool)].min() > 0.5


def test_more_kinds_of_body_come_and_go_than_there_may_be_at_once(world: Populated) -> None:
    grid = world.population.grid
    for k in range(150):
        values = {"height_m": 0.8 + 0.011 * k, "step_on_m": 0.05 + 0.003 * k, "leg_length_m": 0.9}
        (outcome,) = world.frame(SetParameters(k, (A1,), values)).outcomes
        assert outcome.fault is None
    assert len(grid.arrays.clearance) <= 64
    world.frame(SetParameters(200, (A1,), {"height_m": 1.8, "step_on_m": 0.6}))
    row = world.population.table.agents.bodies[world.population.table.row(A1)]
    assert row == grid.row_of(world.zone.parameters(A1).body)
    fresh = type(grid)(grid.floors)
    assert np.array_equal(grid.arrays.clearance[row], fresh.arrays.clearance[0])
