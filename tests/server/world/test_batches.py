"""Mixed lists of commands are one input: carried out whole in a tick, or gone without a trace."""

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, Population
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC, WanderSpec
from esplanade.server.world.inputs import (
    AddActors,
    Batch,
    ChangeBehaviour,
    HoldActors,
    Input,
    MoveDoor,
    OneActorCommand,
    PlaceActor,
    RemoveActors,
    SendActors,
    SetParameters,
)
from esplanade.server.world.outcomes import FaultCode, Outcome
from tests.server.populated import Populated, adding, spec

A1, A2, A3 = "main/a1", "main/a2", "main/a3"
CHANGES = ("set_many", "add_many", "remove_many", "set_behaviour", "place", "hold")


def world_of_three(*, outside: bool = False) -> Populated:
    return Populated([spec(k) for k in range(1, 4)], outside=outside)


@pytest.fixture(scope="module")
def world() -> Iterator[Populated]:
    populated = world_of_three()
    populated.frame()
    yield populated
    populated.population.close()


def test_all_of_a_batch_is_done_in_one_tick() -> None:
    world = world_of_three()
    world.frame()
    patrol = BEHAVIOUR_SPEC.validate_python({"kind": "patrol", "stops": ["west", "east"]})
    batch = Batch(
        7,
        (
            RemoveActors(0, (A1,)),
            adding(0, spec(9, place=(10.0, 7.0, 0.0)), spec(1, place=(4.0, 6.0, 0.0))),
            SetParameters(0, (A2, A3), {"speed_mps": [1.0, 1.1], "radius_m": 0.3}),
            ChangeBehaviour(0, (A3, "main/a9"), patrol),
            HoldActors(0, (A2,), held=True),
        ),
        (MoveDoor("gate", is_open=False),),
    )
    avatar = world.zone.avatar_of(A1)
    frame = world.frame(batch)
    assert frame.outcomes == [Outcome(7, frame.tick)]
    assert frame.left == [avatar]
    assert frame.events.doors == {"gate": False}
    assert frame.actors == 4
    assert world.zone.avatar_of(A1) not in (None, avatar)
    assert world.zone.parameters(A3).speed_mps == 1.1
    assert world.zone.actors["main/a9"].behaviour == patrol
    assert world.population.held(A2)
    world.population.close()


def test_a_batch_waits_as_a_whole_for_what_is_derived(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
    world = world_of_three(outside=True)
    world.frame()
    going = BEHAVIOUR_SPEC.validate_python({"kind": "go_to", "target": "east"})
    batch = Batch(
        3,
        (
            adding(0, spec(9, place=(10.0, 7.0, 0.0)), radius_m=0.35),
            SetParameters(0, (A2,), {"radius_m": 0.4}),
            ChangeBehaviour(0, (A3,), going),
        ),
    )
    assert world.frame(batch).outcomes == []
    assert world.zone.actors[A3].behaviour.kind == "idle"
    frames = world.frames(8)
    (done,) = [one for frame in frames for one in frame.outcomes]
    assert done.fault is None
    assert world.zone.parameters(A2).radius_m == 0.4
    assert world.zone.actors[A3].behaviour == going
    assert "main/a9" in world.zone.actors
    world.population.close()


def actors(*more: str) -> st.SearchStrategy[tuple[str, ...]]:
    return st.lists(st.sampled_from([A1, A2, A3, *more]), min_size=1, max_size=3, unique=True).map(
        tuple
    )


def commands(*strange: str) -> st.SearchStrategy[OneActorCommand]:
    """One command; with some `strange` ids it may name actors that are not there."""
    some = actors(*strange)
    targets = st.sampled_from(["east", "west", (5.0, 6.0, 0.0), *(["moon"] if strange else [])])
    speeds = st.floats(0.3, 9.0 if strange else 1.5)
    newcomer = st.builds(
        lambda number, place: AddActors(
            0, (spec(number, place=(*place, 0.0)),), (ActorParameters(),)
        ),
        st.integers(3 if strange else 4, 12),
        st.tuples(st.floats(1.0, 13.0), st.floats(1.0, 8.0)),
    )
    return st.one_of(
        st.builds(
            lambda who, speed: SetParameters(0, who, {"speed_mps": speed, "max_speed_mps": 2.0}),
            some,
            speeds,
        ),
        st.builds(lambda who, m: SetParameters(0, who, {"radius_m": m}), some, st.floats(0.2, 0.4)),
        st.builds(lambda who: RemoveActors(0, who), some),
        st.builds(lambda who: ChangeBehaviour(0, who, WanderSpec()), some),
        st.builds(lambda who, target: SendActors(0, who, target), some, targets),
        st.builds(lambda who, held: HoldActors(0, who, held), some, st.booleans()),
        st.builds(lambda who: PlaceActor(0, who[0], (5.0, 6.0, 0.0)), some),
        newcomer,
    )


def batches(*strange: str) -> st.SearchStrategy[Batch]:
    doors = st.lists(
        st.builds(
            MoveDoor, st.sampled_from(["gate", *(["no gate"] if strange else [])]), st.booleans()
        ),
        max_size=1,
    )
    return st.builds(
        lambda some, moves: Batch(1, tuple(some), tuple(moves)),
        st.lists(commands(*strange), min_size=2, max_size=5),
        doors,
    )


@settings(max_examples=60, deadline=None)
@given(batch=batches("main/nobody"), fails_at=st.integers(0, 6))
def test_a_batch_that_is_refused_or_fails_half_way_leaves_no_trace(
    world: Populated, batch: Batch, fails_at: int
) -> None:
    before = story(world)
    with pytest.MonkeyPatch.context() as broken:
        calls = iter(range(100))

        def failing(method: Any) -> Any:
            def fail(*arguments: Any, **more: Any) -> Any:
                result = method(*arguments, **more)
                if next(calls) == fails_at:
                    raise RuntimeError("told to fail")
                return result

            return fail

        for name in CHANGES:
            broken.setattr(Population, name, failing(getattr(Population, name)))
        # A later part cannot be carried out, so that none is: of this actor there is none.
        last = RemoveActors(0, ("main/nobody",))
        refused = Batch(
            1, (*batch.commands, last) if fails_at == 6 else batch.commands, batch.doors
        )
        world.zone.begin([refused])
        (outcome,) = world.zone._commands.outcomes
        after = story(world)
    if outcome.fault is None:
        # It was carried out: the world is set right by hand for the next example.
        restore(world)
    else:
        assert after == before
        if fails_at == 6:
            assert outcome.fault.code is not FaultCode.FAILED
    world.zone.finish(False)


def restore(world: Populated) -> None:
    population = world.population
    there = [str(each) for each in population.table.ids]
    world.zone.begin(
        [
            Batch(
                2,
                (
                    RemoveActors(0, tuple(there)),
                    adding(0, *(spec(k) for k in range(1, 4))),
                ),
                (MoveDoor("gate", is_open=True),),
            )
        ]
    )
    (outcome,) = world.zone._commands.outcomes
    assert outcome.fault is None, outcome.fault
    world.zone.finish(False)


def story(world: Populated) -> dict[str, Any]:
    """All that a batch may have changed."""
    population, zone = world.population, world.zone
    table, state = population.table, zone.state
    return {
        "ids": table.ids,
        "agents": [column.tobytes() for column in (*table.agents, *table.trips)],
        "behaviours": dict(population._behaviours),
        "held": [population.held(each) for each in table.ids],
        "specs": dict(zone.actors),
        "names": dict(zone._actors._names),
        "avatars": dict(zone._actors._avatars),
        "live": state.live().tolist(),
        "places": state.positions[state.live()].tobytes(),
        "doors": (zone.doors.states(), dict(zone.doors._wanted)),
        "users": [n for n in population.navigator.potentials.users if n],
    }


@settings(max_examples=8, deadline=None)
@given(script=st.lists(batches("main/nobody"), min_size=3, max_size=6))
def test_a_replay_is_the_same_also_without_the_batches_that_were_refused(
    script: list[Batch],
) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
        first = world_of_three(outside=True)
        refused: set[int] = set()
        digests = []
        for number, batch in enumerate(script, 1):
            for tick in range(6):
                given_now: list[Input] = (
                    [Batch(number, batch.commands, batch.doors)] if tick == 0 else []
                )
                frame = first.frame(*given_now)
                refused |= {one.command for one in frame.outcomes if one.fault is not None}
                digests.append(digest(first))
        first.population.close()
    for without in (set[int](), refused):
        again = world_of_three()
        again.zone.derive_outside()
        for tick, inputs in enumerate(first.inputs):
            kept = [one for one in inputs if getattr(one, "command", None) not in without]
            again.frame(*kept)
            assert digest(again) == digests[tick], tick
        again.population.close()


def digest(world: Populated) -> tuple[Any, ...]:
    state = world.zone.state
    live = state.live()
    return (
        state.positions[live].tobytes(),
        state.speeds[live].tobytes(),
        state.radii[live].tobytes(),
        state.ids[live].tolist(),
        sorted(map(str, world.zone.actors)),
        world.zone.doors.states(),
    )
