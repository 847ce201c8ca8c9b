"""Every trip has an outcome, which a judge that knows geometry alone confirms."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from benchmarks import outcomes
from benchmarks.outcomes import World

from esplanade.actors import (
    ActorParameters,
    GoTo,
    Navigator,
    Outcome,
    Patrol,
    Population,
    Reason,
    Wander,
)
from esplanade.planning import LayeredGrid, Scene, Wall
from tests.actors.worlds import navigator, plaza
from tests.planning.worlds import scaled

PATIENCE_S = 12.0
BODY = ActorParameters(patience_s=PATIENCE_S)

Point = tuple[float, float]


def wall_with_door(half_m: float = 0.6) -> Scene:
    """Two rooms and one doorway."""
    walls = ((5.0, 0.0), (5.0, 5.0 - half_m)), ((5.0, 5.0 + half_m), (5.0, 10.0))
    return Scene(bounds=(0.0, 0.0, 10.0, 10.0), walls=tuple(Wall(start=a, end=b) for a, b in walls))


def run_until_ended(nav: Navigator, people: dict[str, Point], most_s: float = 60.0):
    """States of all actors once each trip has an outcome, and the seconds until then."""
    states = {}
    for tick in range(round(most_s / nav.tick_s)):
        nav.observe(people)
        states = nav.tick()
        if all(state.outcome is not None for state in states.values()):
            return states, (tick + 1) * nav.tick_s
    return states, math.inf


def test_a_trip_has_no_outcome_while_it_goes_on_and_then_it_has_arrived() -> None:
    nav = navigator(Scene.open_space((0.0, 0.0, 6.0, 6.0)))
    nav.add_actor("a", (1.0, 1.0), (4.0, 4.0), BODY)
    nav.add_actor("idle", (5.0, 1.0))
    nav.observe({})
    assert nav.tick()["a"].outcome is None
    for _ in range(50):
        nav.observe({})
        states = nav.tick()
    assert states["a"].outcome is Outcome.ARRIVED
    assert states["a"].in_the_way is None
    assert states["idle"].outcome is None
    nav.set_goal("a", (1.0, 1.0))
    assert nav.state("a").outcome is None


@pytest.mark.parametrize("count", [2, scaled(8, 3)])
def test_of_actors_with_one_goal_one_stands_there_and_the_others_end_beside_it(count: int) -> None:
    """One who comes right behind the first may come through the goal too, before it stops."""
    goal = (10.0, 12.0)
    nav = navigator(Scene.open_space((0.0, 0.0, 20.0, 20.0)))
    for k in range(count):
        nav.add_actor(k, (4.0 + 1.5 * k, 6.0), goal, BODY)
    states, _ = run_until_ended(nav, {})
    arrived = {who for who, state in states.items() if state.outcome is Outcome.ARRIVED}
    assert 1 <= len(arrived) <= 2
    assert [state.outcome for state in states.values()].count(Outcome.NEAR) == count - len(arrived)
    (there,) = (who for who in states if math.dist(states[who].position, goal) < 0.3)
    assert there in arrived
    for who, state in states.items():
        if who not in arrived:
            assert state.in_the_way is not None
            assert state.in_the_way.kind == "actor"
            assert state.in_the_way.id in arrived
            assert math.dist(state.position, goal) < 1.0 + 0.5 * math.sqrt(count)


def test_an_actor_stands_beside_a_person_at_its_goal_and_goes_in_when_that_one_leaves() -> None:
    nav = navigator(Scene.open_space((0.0, 0.0, 10.0, 10.0)))
    nav.add_actor("a", (2.0, 5.0), (7.0, 5.0), BODY)
    for _ in range(100):
        nav.observe({"p": (7.0, 5.0)})
        state = nav.tick()["a"]
    assert state.outcome is None
    assert state.reason is Reason.WAITING
    assert 0.65 < math.dist(state.position, (7.0, 5.0)) < 1.9
    for k in range(60):
        nav.observe({"p": (7.0, min(9.5, 5.0 + 0.12 * k))})
        state = nav.tick()["a"]
    assert state.outcome is Outcome.ARRIVED


def test_whoever_stands_at_the_goal_for_longer_than_the_patience_is_named() -> None:
    nav = navigator(Scene.open_space((0.0, 0.0, 10.0, 10.0)))
    nav.add_actor("a", (2.0, 5.0), (7.0, 5.0), BODY)
    states, seconds = run_until_ended(nav, {"p": (7.0, 5.0), "q": (3.0, 8.0)})
    assert states["a"].outcome is Outcome.NEAR
    assert states["a"].in_the_way == ("person", "p")
    assert seconds == pytest.approx(4.0 + PATIENCE_S, abs=2.0)


def test_a_doorway_that_somebody_stands_in_for_longer_blocks_the_way() -> None:
    nav = navigator(wall_with_door())
    nav.add_actor("a", (2.0, 5.0), (8.0, 5.0), BODY)
    states, _ = run_until_ended(nav, {"p": (5.0, 5.0)})
    assert states["a"].outcome is Outcome.BLOCKED
    assert states["a"].in_the_way == ("person", "p")


def test_an_actor_that_is_kept_from_a_taken_goal_by_somebody_else_is_blocked_by_that_one() -> None:
    nav = navigator(wall_with_door())
    nav.add_actor("a", (7.5, 6.0), (2.2, 5.0), BODY)
    states, _ = run_until_ended(nav, {"door": (5.0, 5.0), "there": (2.2, 5.0)})
    assert states["a"].outcome is Outcome.BLOCKED
    assert states["a"].in_the_way == ("person", "door")


def test_patience_decides_how_long_a_trip_waits() -> None:
    ends = []
    for patience_s in (2.0, 6.0):
        nav = navigator(wall_with_door())
        parameters = ActorParameters(patience_s=patience_s)
        nav.add_actor("a", (2.0, 5.0), (8.0, 5.0), parameters)
        ends.append(run_until_ended(nav, {"p": (5.0, 5.0)})[1])
    assert ends[0] + 3.0 < ends[1] < ends[0] + 12.0


def test_a_goal_behind_walls_has_no_way() -> None:
    walls = (Wall(start=(5.0, 0.0), end=(5.0, 10.0)),)
    nav = navigator(Scene(bounds=(0.0, 0.0, 10.0, 10.0), walls=walls))
    nav.add_actor("a", (2.0, 5.0), (8.0, 5.0), BODY)
    states, seconds = run_until_ended(nav, {})
    assert states["a"].outcome is Outcome.NO_WAY
    assert states["a"].in_the_way == ("wall", None)
    assert states["a"].reason is Reason.NO_PATH
    assert seconds < 2.0 * PATIENCE_S


def crowded_world(seed: int) -> World:
    """A seeded world of rooms, people who stand, and actors; and where everyone wants to be."""
    chance = np.random.default_rng(seed)
    side_m = 10.0
    middle = float(chance.uniform(2.5, 7.5))
    half = float(chance.uniform(0.4, 1.4))
    ends = ((0.0, middle - half), (middle + half, side_m))
    walls = tuple(Wall(start=(5.0, a), end=(5.0, b)) for a, b in ends)
    if chance.uniform() < 0.5:
        walls = walls[:1]
    if chance.uniform() < 0.2:
        walls = ()
    scene = Scene(bounds=(0.0, 0.0, side_m, side_m), walls=walls)
    places: list[Point] = []
    while len(places) < 12:
        x, y = chance.uniform(0.6, side_m - 0.6, 2).tolist()
        far = all(math.dist((x, y), other) > 0.7 for other in places)
        if far and not any(abs(x - 5.0) < 0.4 for _ in walls):
            places.append((x, y))
    people: dict[str, Point] = {f"p{k}": places[k] for k in range(int(chance.integers(0, 4)))}
    if chance.uniform() < 0.4:
        people["door"] = (5.0, middle)
    count = int(chance.integers(1, 5))
    starts = {f"a{k}": places[4 + k] for k in range(count)}
    goals = {f"a{k}": places[8 + k] for k in range(count)}
    if people and chance.uniform() < 0.3:
        goals["a0"] = next(iter(people.values()))
    if count > 1 and chance.uniform() < 0.3:
        goals["a1"] = goals["a0"]
    return World(scene, people, starts, goals, dict.fromkeys(starts, BODY), {})


def worlds(block: int, most: int) -> Iterator[World]:
    """Worlds of two kinds in turn: with walls along the cells, and with walls at any angle."""
    for seed in range(block * 8, block * 8 + most):
        yield crowded_world(seed)
        yield outcomes.random_world([77, seed])


@pytest.mark.parametrize("block", range(scaled(8, 1)))
def test_reasons_are_true_and_every_outcome_is_confirmed_in_seeded_worlds(block: int) -> None:
    verdicts = []
    for world in worlds(block, scaled(8, 1)):
        found = outcomes.judged(world)
        assert {verdict.actor for verdict in found} == set(world.starts)
        verdicts += found
    # Gaps beside people that leave some 10 cm are now and then missed, since anchors are points.
    assert len([verdict for verdict in verdicts if verdict.fault]) <= 1, verdicts
    assert outcomes.arriving(verdicts) >= outcomes.ARRIVING


def people_at(place: Point) -> dict[str, tuple[float, float, float]]:
    return {"p": (*place, 0.0)}


def population(behaviour, patience_s: float = 2.0) -> Population:
    grid = LayeredGrid.from_scene(plaza())
    crowd = Population(grid, plaza(), 0.1)
    crowd.add("a", behaviour, ActorParameters(patience_s=patience_s), (4.0, 2.0))
    return crowd


def test_a_wanderer_goes_on_after_a_goal_that_is_taken() -> None:
    crowd = population(Wander(pause_s=(0.2, 0.4)))
    goals = set()
    for _ in range(scaled(600, 300)):
        states = crowd.tick(people_at((10.0, 2.0)))
        goals.add(states["a"].goal)
    assert len(goals) >= 2
    assert crowd.ended[Outcome.NEAR] + crowd.ended[Outcome.ARRIVED] >= 2
    crowd.close()


def test_a_patrol_goes_on_after_a_stop_that_is_taken() -> None:
    crowd = population(Patrol(("fountain", "gate"), pause_s=0.2))
    for _ in range(200):
        crowd.tick(people_at((10.0, 2.0)))
    assert crowd.ended[Outcome.NEAR] >= 1
    assert crowd.ended[Outcome.ARRIVED] >= 1
    crowd.close()


def test_an_actor_that_is_sent_to_a_place_tries_again_later() -> None:
    crowd = population(GoTo("fountain"))
    for _ in range(90):
        state = crowd.tick(people_at((10.0, 2.0)))["a"]
    assert state.outcome is Outcome.NEAR
    for _ in range(140):
        state = crowd.tick({})["a"]
    assert state.outcome is Outcome.ARRIVED
    assert crowd.ended[Outcome.NEAR] == 1
    crowd.close()
