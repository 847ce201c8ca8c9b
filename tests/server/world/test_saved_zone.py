"""A zone that was saved goes on as it would have, and believes nothing that cannot be."""

import copy
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.protocol.looks import NO_LOOK, Look
from esplanade.server.checkpoint.format import digest, pack, unpack
from esplanade.server.world.inputs import (
    ActorCommand,
    ChangeBehaviour,
    HoldActors,
    Input,
    Join,
    MoveDoor,
    PlanEvery,
    RemoveActors,
    SendActors,
    SetLook,
    SetParameters,
    Steer,
)
from esplanade.server.world.saved_zone import Returning, set_doors
from tests.server.populated import Populated, adding, spec

FEW = (Phase.explicit, Phase.reuse, Phase.generate)
"""Worlds are too dear to look for the smallest one that fails."""
ROUND = {"stops": ["east", "west"], "pause_s": 0.3}
TOUR = {"kind": "guide", "tour": ["west", "east"], "pause_s": 0.2}


def hall() -> Populated:
    return Populated(
        [
            spec(1, "patrol", behaviour=ROUND),
            spec(2, "wander", behaviour={"least_pause_s": 0.1, "most_pause_s": 0.4}),
            spec(3, "guide", behaviour=TOUR),
        ]
    )


def story(world: Populated) -> str:
    """The digest of all that a zone saves."""
    return digest(pack(world.zone.save()))


def loaded(saved: dict[str, Any], next_id: int, *people: Returning) -> Populated:
    """Another zone that goes on from bytes."""
    again: dict[str, Any] = unpack(pack(saved))
    world = Populated([])
    world.zone.state.begin_ids(next_id, 10_000)
    set_doors(world.grid, again)
    world.zone.load(again, people)
    return world


def test_a_zone_goes_on_with_its_planning_interval() -> None:
    world = hall()
    world.frame(PlanEvery(3))
    world.frames(5)
    assert world.zone.planning_interval == 3
    again = loaded(world.zone.save(), 10)
    for one in (world, again):
        one.frames(20)
    assert story(again) == story(world)
    assert again.zone.planning_interval == 3


def _names(world: Populated) -> list[str]:
    return sorted(name for name in world.zone.state.names if name)


def commands(number: int) -> st.SearchStrategy[ActorCommand]:
    actor = st.sampled_from(["main/a1", "main/a2", "main/a3", "main/a9"])
    return st.one_of(
        st.builds(
            lambda who, radius, weight: SetParameters(
                number, (who,), {"radius_m": radius, "risk_weight": weight}
            ),
            actor,
            st.sampled_from([0.25, 0.3, 0.4]),
            st.floats(1.0, 20.0),
        ),
        st.builds(
            lambda who, kind: ChangeBehaviour(number, (who,), BEHAVIOUR_SPEC.validate_python(kind)),
            actor,
            st.sampled_from([TOUR, {"kind": "patrol", **ROUND}, {"kind": "wander"}]),
        ),
        st.builds(lambda who, held: HoldActors(number, (who,), held), actor, st.booleans()),
        st.builds(lambda who: SendActors(number, (who,), (11.0, 7.5, 0.0)), actor),
        st.builds(lambda who: RemoveActors(number, (who,)), actor),
        st.just(adding(number, spec(9, "wander", place=None))),
    )


@given(
    before=st.lists(st.tuples(st.integers(1, 25), commands(1)), max_size=4),
    after=st.lists(st.tuples(st.integers(1, 25), commands(2)), max_size=3),
)
@settings(max_examples=6, phases=FEW, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_what_was_saved_goes_on_bit_for_bit(
    before: list[tuple[int, Input]], after: list[tuple[int, Input]]
) -> None:
    first = hall()
    for ticks, command in before:
        first.frames(ticks)
        first.frame(command)
    second = loaded(first.zone.save(), first.zone.state.next_id)
    assert story(first) == story(second)
    for ticks, command in [*after, (15, Join(0, "Ann", None))]:
        for world in (first, second):
            world.frames(ticks)
            world.frame(command)
        assert story(first) == story(second)
    assert _names(first) == _names(second)
    first.population.close()
    second.population.close()


def test_doors_stand_as_they_did_and_go_on_to_what_is_wanted() -> None:
    first = hall()
    first.frame(MoveDoor("gate", is_open=False))
    # The order in which potentials are derived after that is not saved.
    first.frames(20)
    assert first.zone.doors.states() == {"gate": False}
    saved = first.zone.save()
    saved["doors"]["wanted"] = {"gate": False}
    second = loaded(saved, first.zone.state.next_id)
    for world in (first, second):
        world.frames(20)
        assert world.zone.doors.states() == {"gate": False}
    assert story(first) == story(second)
    saved["doors"]["wanted"] = {"gate": True}
    third = loaded(saved, first.zone.state.next_id)
    third.frame()
    assert third.zone.doors.states() == {"gate": True}
    for world in (first, second, third):
        world.population.close()


def test_people_stand_where_they_were_and_keep_their_ids() -> None:
    first = hall()
    ann, ben = first.join((3.0, 4.0), (4.0, 6.0))
    first.frame(Steer(ann, 1, 0.0, 1.0))
    first.frames(20)
    where = first.zone.where(ann)
    heading = first.zone.state.headings[first.zone.state.slot(ann)]
    gone = Returning(ben, "Ben", (4.0, 6.0, 0.0))
    new = Returning(50, "Cid", (5.0, 6.5, 0.0))
    second = loaded(first.zone.save(), 100, Returning(ann, "Ann", (0.5, 0.5, 0.0)), gone, new)
    assert second.zone.where(ann) == where
    assert second.zone.where(ben) == first.zone.where(ben)
    assert second.zone.where(50) == (5.0, 6.5, 0.0)
    assert second.zone.state.headings[second.zone.state.slot(ann)] == heading
    frame = second.frame(Join(0, "Dan", None))
    assert [avatar for _, avatar in frame.joined] == [100]
    assert {entered.id for entered in frame.entered} >= {ann, ben, 50, 100}
    second.frames(10)
    assert second.zone.where(ann) == where
    first.population.close()
    second.population.close()


def test_people_look_as_they_did() -> None:
    first = hall()
    (ann,) = first.join((3.0, 4.0))
    look = Look(shirt=3, skin=2, stature_cm=185)
    first.frame(SetLook(ann, look))
    before = first.zone.save()
    second = loaded(before, 100, Returning(ann, "Ann", (0.5, 0.5, 0.0)))
    (entered,) = [one for one in second.frame().entered if one.id == ann]
    assert second.zone.state.look(ann) == look
    assert b"look" in entered.constants[1]
    stature_m = second.zone.state.statures_m[second.zone.state.slot(ann)]
    assert stature_m == pytest.approx(1.85)
    # A checkpoint of a program that knew no looks.
    del before["people"]["looks"]
    third = loaded(before, 100, Returning(ann, "Ann", (0.5, 0.5, 0.0)))
    assert third.zone.state.look(ann) == NO_LOOK
    for world in (first, second, third):
        world.population.close()


@pytest.fixture(scope="module")
def saved() -> Iterator[dict[str, Any]]:
    world = hall()
    world.join((3.0, 4.0))
    world.frames(30)
    yield unpack(pack(world.zone.save()))
    world.population.close()


def _paths(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    yield path
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _paths(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from _paths(inner, (*path, index))


HOSTILE: list[Any] = [
    None,
    -1,
    2**62,
    float("nan"),
    float("inf"),
    "",
    "main/a1",
    b"\xc1",
    [],
    {},
    [[]],
    {"x": float("nan")},
    np.zeros((0, 3)),
    np.full(3, np.nan),
]


@given(data=st.data())
@settings(max_examples=80, phases=FEW, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_hostile_data_are_refused_or_harmless(saved: dict[str, Any], data: st.DataObject) -> None:
    broken = copy.deepcopy(saved)
    paths = [path for path in _paths(broken) if path]
    path = data.draw(st.sampled_from(paths))
    *way, last = path
    holder = broken
    for key in way:
        holder = holder[key]
    found = holder[last]
    if isinstance(found, np.ndarray) and found.size and data.draw(st.booleans()):
        flat = found.view(np.uint8).reshape(-1)
        place = data.draw(st.integers(0, flat.size - 1))
        flat[place // 8 * 8 : place // 8 * 8 + 8] = np.frombuffer(
            data.draw(st.binary(min_size=8, max_size=8)), np.uint8
        )[: len(flat[place // 8 * 8 : place // 8 * 8 + 8])]
    elif isinstance(found, bytes) and data.draw(st.booleans()):
        place = data.draw(st.integers(0, len(found) - 1))
        holder[last] = found[:place] + data.draw(st.binary(max_size=3)) + found[place + 1 :]
    else:
        holder[last] = data.draw(st.sampled_from(HOSTILE))
    world = Populated([])
    world.zone.state.begin_ids(1000, 10_000)
    try:
        set_doors(world.grid, broken)
        world.zone.load(broken, [Returning(4, "Ann", (3.0, 4.0, 0.0))])
    except (ValueError, TypeError, LookupError, AttributeError, OverflowError):
        world.population.close()
        return
    frames = world.frames(4)  # what is harmless walks on
    assert world.zone.failures == 0
    assert not any(frame.actors_stood for frame in frames if len(world.population))
    assert np.isfinite(world.zone.state.positions).all()
    world.population.close()
