"""Bodies wider than a person, as of a cart: they go where they fit, and touch nobody."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, Idle, Newcomer, Outcome, Population
from esplanade.planning import LayeredGrid, Scene, Wall
from tests.actors.worlds import Walk, along, holds, navigator, plaza
from tests.planning.worlds import scaled

CART = ActorParameters(radius_m=0.9, speed_mps=1.0, max_speed_mps=1.3)
PERSON_M = 0.25


def hall(door_m: float) -> Scene:
    """A hall that a wall with one doorway parts; none without a doorway."""
    ends = (0.0, 6.0 - 0.5 * door_m), (6.0 + 0.5 * door_m, 12.0)
    walls = tuple(Wall(start=(10.0, a), end=(10.0, b)) for a, b in ends)
    return Scene(bounds=(0.0, 0.0, 20.0, 12.0), walls=walls if door_m else ())


def crossing(chance: np.random.Generator, door_m: float) -> list[Walk]:
    """People who walk across both halves of a hall, or through all of it where there is no door."""
    walks = []
    for k in range(4):
        x, y = (6.5, 13.5)[k % 2], (1.0, 11.0)[k // 2]
        start = x + float(chance.uniform(-1.0, 1.0)), y
        end = (x if door_m else 20.0 - x) + float(chance.uniform(-1.0, 1.0)), 12.0 - y
        walks.append(along(start, end, speed_mps=float(chance.uniform(0.7, 1.3))))
    return walks


@given(st.integers(0, 999), st.sampled_from([0.0, 2.2]), st.sampled_from([0.6, 0.9]))
@holds(scaled(6, 1))
def test_a_wide_body_comes_through_a_hall_and_a_door_without_a_contact(seed, door_m, radius_m):
    chance = np.random.default_rng(seed)
    walks = crossing(chance, door_m)
    nav = navigator(hall(door_m))
    parameters = CART.model_copy(update={"radius_m": radius_m})
    start, goal = (2.5, float(chance.uniform(3.0, 9.0))), (17.5, float(chance.uniform(3.0, 9.0)))
    nav.add_actor("cart", start, goal, parameters)
    posts = [(10.0, 6.0 - 0.5 * door_m), (10.0, 6.0 + 0.5 * door_m)] if door_m else []
    room_m = math.inf
    for tick in range(600):
        seconds = tick * nav.tick_s
        nav.observe({k: walk(seconds) for k, walk in enumerate(walks)})
        state = nav.tick()["cart"]
        here = state.position
        apart_m = [math.dist(walk(seconds + nav.tick_s), here) - PERSON_M for walk in walks]
        room_m = min([room_m, *apart_m, *(math.dist(post, here) for post in posts)])
        if state.outcome is not None:
            break
    nav.close()
    assert state.outcome is Outcome.ARRIVED
    assert room_m >= radius_m - 0.01


def test_where_a_wide_body_does_not_fit_it_is_told_that_no_way_leads_there() -> None:
    nav = navigator(hall(1.2))
    nav.add_actor("cart", (2.5, 6.0), (17.5, 6.0), CART)
    nav.add_actor("narrow", (2.5, 9.0), (17.5, 9.0))
    ends = {}
    for _ in range(250):
        nav.observe({})
        ends |= {who: state.outcome for who, state in nav.tick().items() if state.outcome}
    nav.close()
    assert ends == {"cart": Outcome.NO_WAY, "narrow": Outcome.ARRIVED}


def test_wide_and_narrow_actors_come_through_one_door_from_both_sides() -> None:
    nav = navigator(hall(2.2))
    radii_m = (0.9, 0.9, 0.25, 0.25)
    for k, radius_m in enumerate(radii_m):
        x, y = (3.0, 17.0)[k % 2], 3.0 + 2.0 * k
        parameters = CART.model_copy(update={"radius_m": radius_m})
        nav.add_actor(k, (x, y), (20.0 - x, 12.0 - y), parameters)
    ends: dict[object, Outcome] = {}
    for _ in range(scaled(500, 100)):
        nav.observe({})
        states = nav.tick()
        for one, other in itertools.combinations(range(len(radii_m)), 2):
            apart_m = math.dist(states[one].position, states[other].position)
            assert apart_m >= radii_m[one] + radii_m[other]
        ends |= {who: state.outcome for who, state in states.items() if state.outcome}
    nav.close()
    assert set(ends.values()) <= {Outcome.ARRIVED}
    assert len(ends) == len(radii_m) or scaled(0, 1)


@pytest.mark.parametrize("radii_m", [(0.9, 0.25), (0.25, 0.9), (0.9, 0.6)])
def test_newcomers_have_room_beside_bodies_of_any_width(radii_m: tuple[float, float]) -> None:
    population = Population(LayeredGrid.from_scene(plaza()), plaza(), 0.1)
    bodies = [ActorParameters(radius_m=radius_m) for radius_m in radii_m]
    population.add("first", Idle(), bodies[0], (6.0, 6.0))
    for near, place in ((True, (6.0, 6.0, 0.0)), (False, None)):
        ids = [f"{near}{k}" for k in range(6)]
        population.add_many([Newcomer(who, Idle(), bodies[1], place, near=near) for who in ids])
    agents = population.table.agents
    radii = agents.parameters["radius_m"]
    apart = np.hypot(*(agents.positions[:, None] - agents.positions[None]).transpose(2, 0, 1))
    np.fill_diagonal(apart, math.inf)
    assert (apart >= radii[:, None] + radii[None]).all()
    population.close()
