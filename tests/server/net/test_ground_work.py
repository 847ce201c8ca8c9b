"""Doors of a served world: derived outside of ticks, coalesced, and the same in a replay."""

from concurrent.futures import Future, ThreadPoolExecutor
from itertools import count
from typing import Any, cast

import numpy as np
import pytest

from esplanade.actors import ActorParameters, Patrol, Population
from esplanade.planning import Door, LayeredGrid, Potential, Scene, Wall
from esplanade.server.net.ground_work import DOOR_PAUSE_S, GroundWork
from esplanade.server.world.inputs import (
    DoorDerived,
    Input,
    Join,
    MoveDoor,
    PotentialDerived,
    Steer,
)
from esplanade.server.world.zone import Zone
from tests.server.worlds import TICK_S, Trial, rules

GATED = Scene(
    name="gated",
    bounds=(0.0, 0.0, 14.0, 9.0),
    walls=(Wall(start=(6.0, 0.0), end=(6.0, 3.0)), Wall(start=(6.0, 5.0), end=(6.0, 8.0))),
    doors=(Door(name="gate", start=(6.0, 3.0), end=(6.0, 5.0)),),
)


_NUMBERS = count()
"""Scenes of different names have grids of their own."""


class AtOnce:
    """An executor that is done before it returns, so that a test knows when."""

    def __init__(self) -> None:
        self.works = 0

    def submit(self, work: Any, *arguments: Any) -> "Future[Any]":
        self.works += 1
        done: Future[Any] = Future()
        try:
            done.set_result(work(*arguments))
        except Exception as error:  # noqa: BLE001 - as an executor does
            done.set_exception(error)
        return done


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> AtOnce:
    # Without the time that work takes there is no rest after it.
    monkeypatch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
    return AtOnce()


def moves_of(trial: Trial, work: GroundWork, inputs: list[list[Input]]) -> list[dict[str, bool]]:
    """The doors that moved in each tick."""
    return [dict(trial.tick(*given, *work.drain()).doors) for given in inputs]


def gated() -> Trial:
    """A world with a grid of its own, whose gate is open."""
    trial = Trial(GATED.model_copy(update={"name": f"gated {next(_NUMBERS)}"}))
    assert trial.world.doors.states() == {"gate": True}
    return trial


def test_a_door_moves_as_an_input_of_a_later_tick(at_once: AtOnce) -> None:
    trial = gated()
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once))
    arrays = trial.grid.arrays
    moved = moves_of(trial, work, [[MoveDoor("gate", is_open=False)], [], []])
    assert moved == [{}, {}, {"gate": False}]
    assert not trial.grid.is_free([(6.0, 4.0)], [0.0], 0.2)[0]
    assert trial.population.renewed_outside
    assert trial.grid.arrays is not arrays


def test_wishes_at_every_tick_are_merged_and_the_last_one_holds(at_once: AtOnce) -> None:
    trial = gated()
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once))
    ticks = round(4.0 / TICK_S)
    wishes: list[list[Input]] = [[MoveDoor("gate", is_open=k % 2 == 1)] for k in range(ticks)]
    moved = [doors for doors in moves_of(trial, work, wishes) if doors]
    assert len(moved) <= 4.0 / DOOR_PAUSE_S + 1
    assert at_once.works <= 4.0 / DOOR_PAUSE_S + 1
    trial.world.doors.want("gate", is_open=False)
    moves_of(trial, work, [[]] * 40)
    assert trial.world.doors.states() == {"gate": False}
    assert trial.world.doors.waiting() == 0


def test_who_steps_into_a_door_while_it_is_derived_keeps_it_open(at_once: AtOnce) -> None:
    trial = gated()
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once))
    (ann,) = trial.join((3.0, 4.0))
    trial.tick(MoveDoor("gate", is_open=False), *work.drain())
    assert work.drain() == []
    assert at_once.works == 1, "it is being derived"
    trial.world.state.positions[trial.world.state.slot(ann)] = (6.0, 4.0)
    (derived,) = work.drain()
    assert isinstance(derived, DoorDerived)
    assert trial.tick(derived).doors == {}
    trial.world.state.positions[trial.world.state.slot(ann)] = (2.0, 4.0)
    assert {"gate": False} in moves_of(trial, work, [[]] * 20)


def test_a_door_that_nobody_wants_moved_any_more_stays(at_once: AtOnce) -> None:
    trial = gated()
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once))
    trial.tick(MoveDoor("gate", is_open=False))
    work.drain()
    (derived,) = work.drain()
    assert trial.tick(MoveDoor("gate", is_open=True), derived).doors == {}
    assert trial.world.doors.states() == {"gate": True}


def test_work_that_fails_is_passed_over(at_once: AtOnce, monkeypatch: pytest.MonkeyPatch) -> None:
    trial = gated()
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once))

    def fail(*_: Any) -> None:
        raise RuntimeError("told to fail")

    with monkeypatch.context() as broken:
        broken.setattr(LayeredGrid, "prepare_door", fail)
        moves_of(trial, work, [[MoveDoor("gate", is_open=False)], [], []])
    assert {"gate": False} in moves_of(trial, work, [[]] * 20)


def test_what_is_ahead_is_done_where_nothing_else_waits(at_once: AtOnce) -> None:
    trial, done = gated(), list[str]()
    ahead = [lambda name=name: done.append(name) for name in ("one", "two")]
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once), ahead)
    trial.world.doors.want("gate", is_open=False)
    assert work.drain() == []
    assert done == [], "the door comes first"
    assert {"gate": False} in moves_of(trial, work, [[]] * 20)
    assert done == ["one", "two"]


def test_a_rest_after_what_is_ahead_holds_up_nothing_else(
    at_once: AtOnce, monkeypatch: pytest.MonkeyPatch
) -> None:
    trial, done = gated(), list[str]()
    ahead = [lambda name=name: done.append(name) for name in ("one", "two")]
    work = GroundWork(trial.world, cast(ThreadPoolExecutor, at_once), ahead)
    seconds = count()
    monkeypatch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 60 * next(seconds))
    moves_of(trial, work, [[]] * 10)
    assert done == ["one"], "it rests for a minute"
    assert {"gate": False} in moves_of(trial, work, [[MoveDoor("gate", is_open=False)], [], [], []])
    assert done == ["one"]


def populated() -> tuple[Zone, Population]:
    grid = LayeredGrid.from_scene(GATED)
    population = Population(grid, GATED, TICK_S)
    for k in range(4):
        stops = [(2.0 + k, 2.0, 0.0), (12.0, 2.0 + k, 0.0)]
        population.add(f"a{k}", Patrol(stops), ActorParameters(), position=(2.0, 2.0 + k))
    world = Zone(
        GATED,
        grid,
        population,
        {f"a{k}": f"A{k}" for k in range(4)},
        rules(),
        tick_s=TICK_S,
        max_people=4,
        seed=3,
        clock=lambda: 0.0,
    )
    world.derive_outside()
    return world, population


def test_a_replay_of_the_inputs_is_the_same_world_bit_for_bit() -> None:
    world, population = populated()
    inputs: list[list[Input]] = []
    places = []
    with ThreadPoolExecutor(1) as thread:
        work = GroundWork(world, thread)
        for tick in range(400):
            given: list[Input] = []
            if tick == 2:
                given.append(Join(0, "Ann", (3.0, 4.0, 0.0)))
            if tick == 10:
                given.append(Steer(5, 1, 0.0, 0.7))
            if tick % 37 == 0:
                given.append(MoveDoor("gate", is_open=tick % 2 == 1))
            inputs.append([*given, *work.drain()])
            world.begin(inputs[-1])
            world.finish(world.think())
            places.append(world.state.positions.copy())
    population.close()
    kinds = [type(item) for given in inputs for item in given]
    assert kinds.count(DoorDerived) >= 3
    assert kinds.count(PotentialDerived) >= 3

    again, population = populated()
    for given, expected in zip(inputs, places, strict=True):
        again.begin(given)
        again.finish(again.think())
        assert np.array_equal(again.state.positions, expected)
    assert again.doors.states() == world.doors.states()
    population.close()


def test_actors_find_their_way_anew_by_potentials_from_outside(at_once: AtOnce) -> None:
    world, population = populated()
    work = GroundWork(world, cast(ThreadPoolExecutor, at_once))
    potentials = population.navigator.potentials
    for tick in range(200):
        given: list[Input] = [MoveDoor("gate", is_open=False)] if tick == 20 else []
        world.begin([*given, *work.drain()])
        world.finish(world.think())
    assert world.doors.states() == {"gate": False}
    assert potentials.outdated_rows == 0
    others = LayeredGrid.from_scene(
        GATED.model_copy(update={"doors": (GATED.doors[0].model_copy(update={"open": False}),)})
    )
    assert np.array_equal(others.arrays.clearance, population.grid.arrays.clearance)
    body = ActorParameters().body
    agents = population.table.agents
    for goal, row in zip(agents.goals.tolist(), agents.potential_rows.tolist(), strict=True):
        anew = Potential(others, (goal[0], goal[1]), 0.0, body.radius_m, body=body)
        assert np.array_equal(potentials.arrays[row], anew.values)
    population.close()
