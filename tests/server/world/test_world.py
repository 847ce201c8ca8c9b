import math

import numpy as np

from esplanade.actors import Population
from esplanade.planning import LayeredGrid
from esplanade.protocol import Kind
from esplanade.server.populating import populate
from esplanade.server.world.inputs import Detach, Follow, Input, Join, Leave, Stand, Steer
from esplanade.server.world.stage_times import STAGES
from esplanade.server.world.world import World
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import ROOM, TICK_S, Trial, rules


def recorded(ticks: int) -> list[list[Input]]:
    """Inputs of eight people, tick by tick, the same in every run."""
    random = np.random.default_rng(12)
    record: list[list[Input]] = [[Join(k, f"p{k}", None) for k in range(8)]]
    first_person = 4
    for tick in range(1, ticks):
        who = int(first_person + random.integers(8))
        choice = random.uniform()
        inputs: list[Input] = []
        if choice < 0.4:
            inputs.append(Steer(who, tick, float(random.uniform(0.0, 6.3)), 1.4))
        elif choice < 0.5:
            inputs.append(
                Follow(who, tick, ((5.0, 17.0, 0), (float(random.uniform(6.0, 19.0)), 17.0, 0)))
            )
        elif choice < 0.51:
            inputs.append(Detach(who))
        elif choice < 0.515:
            inputs.append(Stand(who))
        elif choice < 0.52:
            inputs += [Leave(who), Join(100 + tick, "late", (5.0, 5.0, 0))]
        record.append(inputs)
    return record


def replay(record: list[list[Input]]) -> bytes:
    """Every byte of the world's story: all positions, and all that viewers are sent."""
    grid = LayeredGrid.from_scene(ROOM)
    population: Population
    population, bodies = populate(grid, ROOM, 3, TICK_S, seed=7)
    world = World(
        ROOM,
        grid,
        population,
        bodies,
        rules(),
        tick_s=TICK_S,
        max_people=32,
        seed=7,
        clock=lambda: 0.0,
    )
    world.begin([])
    world.finish(world.think())
    story = bytearray()
    for inputs in record:
        world.begin(inputs)
        update = world.finish(world.think())
        world.wrote(update.snapshots, list(range(len(update.snapshots.viewers))))
        story += world.state.positions.tobytes() + bytes(update.snapshots.data)
    story += repr((world.trips, world.contacts.actor_person, world.state.names)).encode()
    population.close()
    return bytes(story)


def test_same_seed_and_same_inputs_give_the_same_world_bit_for_bit() -> None:
    record = recorded(120)
    assert replay(record) == replay(record)


def test_every_stage_of_a_tick_is_timed_in_order() -> None:
    trial = Trial()
    trial.tick()
    assert tuple(trial.world.times.seconds) == STAGES
    assert all(seconds > 0.0 for seconds in trial.world.times.seconds.values())


def test_inputs_of_people_who_are_gone_are_void() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Leave(ann))
    trial.tick(Steer(ann, 1, 0.0, 1.0), Follow(ann, 2, ((4.0, 4.0, 0),)), Leave(ann), Detach(999))
    assert trial.world.count() == (0, 0)


def test_actors_see_the_people_of_this_tick_and_people_the_actors() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (5.0, 5.0), (1.0, 0.0))
    trial = Trial(population=population)
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Steer(ann, 1, math.pi / 2.0, 1.0))
    assert population.observed == {ann: (*trial.position(ann), 0)}
    state = trial.world.state
    (oak,) = [int(i) for i in state.ids[state.alive] if trial.world.is_actor(int(i))]
    described = trial.world.describe(state.slot(oak))
    assert described["kind"] == Kind.ACTOR.value
    assert described["name"] == "oak"
    assert trial.speed(oak) == 1.0
    assert trial.world.explain(oak).behaviour == "patrol"
    assert trial.world.count() == (1, 1)


def test_actors_stand_when_there_is_no_plan() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (5.0, 5.0), (1.0, 0.0))
    trial = Trial(population=population)
    trial.tick()
    trial.world.begin([])
    trial.world.finish(False)
    assert trial.world.state.speeds.max() == 0.0


def test_what_an_actor_points_at_is_told_when_it_changes_and_to_who_comes() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (4.0, 3.0))
    population.put("elm", (5.0, 3.0))
    trial = Trial(population=population)
    assert trial.tick().pointing == {}
    oak, elm = (int(i) for i in trial.world.state.ids[trial.world.state.live()])
    population.pointed_at["oak"] = (1.0, 2.0, 3.0)
    assert trial.tick().pointing == {oak: (1.0, 2.0, 3.0)}
    assert trial.tick().pointing == {}
    slots = trial.world.state.slot(oak), trial.world.state.slot(elm)
    assert [trial.world.describe(slot)["points_at"] for slot in slots] == [(1.0, 2.0, 3.0), None]
    population.pointed_at = {"oak": (4.0, 2.0, 3.0), "elm": (1.0, 2.0, 3.0)}
    assert trial.tick().pointing == {oak: (4.0, 2.0, 3.0), elm: (1.0, 2.0, 3.0)}
    population.pointed_at = {}
    assert trial.tick().pointing == {oak: None, elm: None}
    assert [trial.world.describe(slot)["points_at"] for slot in slots] == [None, None]


def test_who_is_told_to_stand_stands_and_may_walk_again() -> None:
    trial = Trial()
    walker, follower = trial.join((3.0, 3.0), (3.0, 6.0))
    route = ((9.0, 6.0, 0.0),)
    trial.tick(Steer(walker, 1, 0.0, 1.0), Follow(follower, 1, route))
    assert trial.world.moves(walker)
    assert trial.world.moves(follower)
    trial.tick(Stand(walker), Stand(follower))
    stood = [trial.position(who) for who in (walker, follower)]
    trial.ticks(5)
    assert [trial.position(who) for who in (walker, follower)] == stood
    assert not trial.world.moves(walker)
    assert not trial.world.moves(follower)
    trial.tick(Steer(walker, 2, 0.0, 1.0))
    assert trial.position(walker)[0] > stood[0][0]
    trial.tick(Leave(walker), Stand(walker))
    assert not trial.world.moves(walker)
