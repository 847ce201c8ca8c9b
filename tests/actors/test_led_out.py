"""Bodies closer to a wall than their radius, in cells whose anchors are behind it, come out."""

import math
from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import LayeredGrid, PlanModel, Potential, Scene
from esplanade.planning.routes.walking_route import RouteSearch, SharedWaves
from tests.planning.routes.test_any_angle import Turned, turns
from tests.planning.worlds import holds

END_M = 1.0
"""The wall ends so far along; there is a way around."""
NEAR_M = (0.02, 0.06, 0.1, 0.15, 0.19)
radii = st.sampled_from([0.2, 0.25, 0.35])


def beside_a_wall(turned: Turned) -> Scene:
    """A thin wall from beyond the bounds to somewhat past the middle."""
    wall = {"start": turned.at(0.0, -30.0), "end": turned.at(0.0, END_M), "height_m": 3.0}
    return Scene.model_validate({"bounds": (0.0, 0.0, 9.0, 9.0), "walls": [wall]})


def shortest(away: float, across: float, goal: float) -> float:
    """The way from beside the wall to a place in front of it, or behind it by way of its end."""
    if goal < 0.0:
        return math.hypot(goal + away, 0.3)
    return math.hypot(away, END_M - across) + math.hypot(goal, END_M - across - 0.3)


def most(least: float, radius_m: float) -> float:
    """The greatest length of a way over anchors that keeps its radius from the wall."""
    return 1.25 * (least + math.pi * radius_m) + 0.5


@given(turns, radii, st.sampled_from(NEAR_M), st.integers(-14, 0), st.sampled_from([-0.9, 0.9]))
@holds(30, 2)
def test_the_potential_is_that_of_the_own_side(turned, radius_m, away, across, goal) -> None:
    across = across / 10
    grid = LayeredGrid.from_scene(beside_a_wall(turned))
    here, there = turned.at(-away, across), turned.at(goal, across + 0.3)
    potential = Potential(grid, there, 0.0, radius_m)
    least = shortest(away, across, goal)
    left_m = potential.distance([here], [0.0])[0]
    assert least - 0.1 <= left_m <= most(least, radius_m)
    step = np.array(here) + 0.01 * potential.direction([here], [0.0])[0]
    towards_wall = math.dist(step, turned.at(0.0, across)) < away - 0.005
    assert not (towards_wall and away < 0.1)


@given(turns, radii, st.sampled_from(NEAR_M), st.integers(-14, 0), st.sampled_from([-0.9, 0.9]))
@holds(30, 1)
def test_an_actor_behind_its_anchor_gets_to_its_goal(turned, radius_m, away, across, goal) -> None:
    across = across / 10
    zone = Navigator(beside_a_wall(turned), tick_s=0.1, plan=PlanModel(threads=1))
    here, there = turned.at(-away, across), turned.at(goal, across + 0.3)
    zone.add_actor("a", here, there, ActorParameters(radius_m=radius_m))
    for _ in range(120):
        zone.observe({})
        state = zone.tick()["a"]
        assert state.reason is not Reason.NO_PATH
        if state.reason is Reason.ARRIVED:
            break
    zone.close()
    assert math.dist(state.position, there) < 0.35


@given(turns, st.sampled_from(NEAR_M), st.integers(-14, 0), st.sampled_from([-0.9, 0.9]))
@holds(30, 2)
def test_a_person_behind_its_anchor_is_led_to_the_goal(turned, away, across, goal) -> None:
    across, radius_m = across / 10, 0.25
    grid = LayeredGrid.from_scene(beside_a_wall(turned))
    here, there = (*turned.at(-away, across), 0.0), (*turned.at(goal, across + 0.3), 0.0)
    search = RouteSearch(SharedWaves(grid), here, there, radius_m)
    while not search.advance():
        pass
    assert search.route is not None
    way = [here, *search.route]
    length = sum(math.dist(a, b) for a, b in pairwise(way))
    least = shortest(away, across, goal)
    assert least - 0.1 <= length <= most(least, radius_m)
