"""The same inputs give the same world, with commands on actors and what is derived for them."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import cast

import numpy as np
import pytest

from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.world.inputs import (
    ActorsDerived,
    ActorsStood,
    ChangeBehaviour,
    HoldActors,
    Input,
    Join,
    MoveDoor,
    PlaceActor,
    PlanEvery,
    RemoveActors,
    SendActors,
    SetParameters,
    Steer,
)
from tests.server.populated import AtOnce, Populated, adding, spec

ROUND = {"stops": ["east", "west"], "pause_s": 0.5}
TOUR = BEHAVIOUR_SPEC.validate_python({"kind": "guide", "tour": ["west", "east"]})


def hall() -> Populated:
    return Populated([spec(k, "patrol", behaviour=ROUND) for k in range(1, 4)])


def script() -> dict[int, list[Input]]:
    a1, a2, a3 = "main/a1", "main/a2", "main/a3"
    return {
        3: [Join(0, "Ann", (3.0, 4.0, 0.0))],
        10: [SetParameters(1, (a1, a2), {"radius_m": 0.4, "speed_mps": [1.0, 1.2]})],
        20: [SetParameters(2, (a3,), {"risk_weight": 25.0, "height_m": 1.2})],
        30: [Steer(4, 1, 0.3, 1.0), MoveDoor("gate", is_open=False)],
        40: [PlanEvery(2)],
        45: [adding(3, *(spec(k, "wander", place=None) for k in range(4, 7)), radius_m=0.3)],
        60: [ChangeBehaviour(4, (a2,), TOUR), HoldActors(5, (a1,), held=True)],
        75: [MoveDoor("gate", is_open=True), PlaceActor(6, a3, (11.0, 2.0, 0.0))],
        80: [PlanEvery(3)],
        90: [RemoveActors(7, ("main/a5",)), SendActors(8, (a3,), (3.3, 2.2, 0.0))],
        105: [PlanEvery(1)],
        110: [HoldActors(9, (a1,), held=False), RemoveActors(10, ("main/a5",))],
    }


def played(world: Populated, inputs: list[list[Input]]) -> list[tuple[bytes, str]]:
    story = []
    for given in inputs:
        world.zone.begin(given)
        frame = world.zone.finish(world.zone.think())
        told = [(one.command, one.tick, one.fault) for one in frame.outcomes]
        state = world.zone.state
        story.append((state.positions.tobytes(), f"{frame.left} {told} {state.names}"))
    world.population.close()
    return story


@pytest.fixture(scope="module")
def recorded() -> tuple[list[list[Input]], list[tuple[bytes, str]]]:
    """A world for whose commands all is derived outside of ticks: its inputs, and its story."""
    world, inputs, story = hall(), [], []
    at = script()
    failing = world.population.navigator.advance

    def fail() -> None:
        failing()
        raise MemoryError("told to fail")

    with pytest.MonkeyPatch.context() as patch:
        # Without the time that work takes there is no rest after it.
        patch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
        work = GroundWork(world.zone, cast(ThreadPoolExecutor, AtOnce()))
        for tick in range(160):
            given: list[Input] = [*at.get(tick, []), *work.drain()]
            world.zone.begin(given)
            world.population.navigator.advance = fail if tick == 50 else failing  # type: ignore[method-assign]
            try:
                moved = world.zone.think()
            except MemoryError:
                moved = False
            frame = world.zone.finish(moved)
            if frame.actors_stood:
                given.append(ActorsStood())
            inputs.append(given)
            told = [(one.command, one.tick, one.fault) for one in frame.outcomes]
            state = world.zone.state
            story.append((state.positions.tobytes(), f"{frame.left} {told} {state.names}"))
    world.population.close()
    return inputs, story


def test_every_command_had_an_outcome(
    recorded: tuple[list[list[Input]], list[tuple[bytes, str]]],
) -> None:
    inputs, story = recorded
    kinds = [type(item) for given in inputs for item in given]
    assert kinds.count(ActorsDerived) >= 3
    assert kinds.count(ActorsStood) == 1
    told = "".join(text for _, text in story)
    assert all(f"({number}, " in told for number in range(1, 11))
    assert "no actor main/a5" in told


def test_a_replay_is_the_same_world_bit_for_bit(
    recorded: tuple[list[list[Input]], list[tuple[bytes, str]]],
) -> None:
    inputs, story = recorded
    again = hall()
    again.zone.derive_outside()
    for tick, (one, other) in enumerate(zip(played(again, inputs), story, strict=True)):
        assert one == other, tick


def test_bodies_that_were_derived_elsewhere_are_derived_again_to_the_same_end(
    recorded: tuple[list[list[Input]], list[tuple[bytes, str]]],
) -> None:
    """A replay may know of bodies no more than the command; potentials come with the inputs."""
    inputs, story = recorded
    bare = [
        [replace(one, bodies=None) if isinstance(one, ActorsDerived) else one for one in given]
        for given in inputs
    ]
    again = hall()
    again.zone.derive_outside()
    places = [np.frombuffer(one) for one, _ in played(again, bare)]
    assert all(np.array_equal(a, np.frombuffer(b)) for a, (b, _) in zip(places, story, strict=True))
