"""Ways depend on geometry, not on where cells lie."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, PathStatus, find_path
from tests.planning.turned import (
    Turned,
    arrives,
    doorways,
    expected,
    flight,
    has_route,
    radii,
    turns,
)
from tests.planning.worlds import holds


@given(doorways())
@holds(150, 3)
def test_a_tool_and_a_person_find_what_the_plan_has(example) -> None:
    scene, obstacles, start, goal, radius_m = example
    way = expected(obstacles, start, goal, radius_m)
    grid, body = LayeredGrid.from_scene(scene), Body(radius_m=radius_m)
    for a, b in (((*start, 0.0), (*goal, 0.0)), ((*goal, 0.0), (*start, 0.0))):
        assert (find_path(grid, a, b, body).status is PathStatus.FOUND) == way
        assert has_route(grid, a, b, radius_m) == way


@given(doorways())
@holds(15, 1)
def test_a_live_actor_gets_where_the_plan_has_a_way(example) -> None:
    scene, obstacles, start, goal, radius_m = example
    way = expected(obstacles, start, goal, radius_m)
    assert arrives(scene, (*start, 0.0), (*goal, 0.0), radius_m) == way


@given(turns, radii, st.sampled_from([-0.06, 0.1, 0.2, 0.5]))
@holds(80, 2)
def test_a_flight_is_climbed_wherever_it_is_wide_enough(turned, radius_m, wider) -> None:
    grid = LayeredGrid.from_scene(flight(turned, 2.0 * radius_m + wider))
    foot, top = (*turned.at(-2.5, 0.0), 0.0), (*turned.at(2.4, 0.0), 1.6)
    body = Body(radius_m=radius_m)
    for a, b in ((foot, top), (top, foot)):
        assert (find_path(grid, a, b, body).status is PathStatus.FOUND) == (wider > 0.0)
        assert has_route(grid, a, b, radius_m) == (wider > 0.0)


@pytest.mark.parametrize("degrees", [18.0, 45.0, 60.0])
def test_arrow_keys_lead_up_and_down_the_middle_of_a_turned_flight(degrees) -> None:
    turned = Turned(degrees, (0.05, 0.1))
    grid = LayeredGrid.from_scene(flight(turned, 0.9))
    for begin, end, z in ((-2.5, 2.4, 0.0), (2.4, -2.5, 1.6)):
        here, height = [turned.at(begin, 0.0)], [z]
        goal = turned.at(end, 0.0)
        length = math.dist(here[0], goal)
        move = [[0.05 * (q - p) / length for p, q in zip(here[0], goal, strict=True)]]
        for _ in range(round(4.9 / 0.05)):
            here, height = grid.walk(here, height, move, 0.25)
        assert math.dist(here[0], goal) < 0.1
        assert height[0] == pytest.approx(1.6 - z, abs=1e-5)
