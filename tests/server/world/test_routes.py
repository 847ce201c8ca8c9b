import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from esplanade.planning import Polygon, Scene
from esplanade.server.world.routes import Point, Route, find_route
from tests.server.worlds import ROOM, grid_of

COURTYARD = Scene.open_space(
    (0.0, 0.0, 20.0, 20.0),
    walls=[
        ((8.0, 8.0), (12.0, 8.0)),
        ((12.0, 8.0), (12.0, 12.0)),
        ((12.0, 12.0), (8.0, 12.0)),
        ((8.0, 12.0), (8.0, 8.0)),
    ],
)
"""Free ground inside walls without a door."""


def length_m(start: Point, way: Route) -> float:
    ends = [start, *way]
    return sum(math.dist(a[:2], b[:2]) for a, b in pairwise(ends))


def test_where_nothing_stands_between_the_way_is_straight() -> None:
    goal = (8.0, 9.0, 0)
    assert find_route(grid_of(ROOM), (3.0, 3.0, 0), goal, 0.25) == (goal,)


def test_around_a_wall_the_way_is_short_and_has_few_legs() -> None:
    start, goal = (8.0, 5.0, 0), (12.0, 5.0, 0)
    way = find_route(grid_of(ROOM), start, goal, 0.25)
    assert way is not None
    assert way[-1] == goal
    assert len(way) <= 10
    corner = (10.0, 15.25)
    shortest_m = math.dist(start[:2], corner) + math.dist(corner, goal[:2])
    assert shortest_m <= length_m(start, way) <= 1.05 * shortest_m


def test_a_goal_inside_a_wall_is_moved_to_free_ground() -> None:
    way = find_route(grid_of(ROOM), (3.0, 3.0, 0), (9.95, 5.0, 0), 0.25)
    assert way is not None
    x, y, _ = way[-1]
    assert 9.4 < x <= 9.75
    assert y == pytest.approx(5.0, abs=0.3)


def test_closed_rooms_are_out_of_reach() -> None:
    assert find_route(grid_of(COURTYARD), (3.0, 3.0, 0.0), (10.0, 10.0, 0.0), 0.25) is None


def test_a_height_that_no_floor_has_means_the_nearest() -> None:
    way = find_route(grid_of(COURTYARD), (2.0, 3.0, 0.0), (3.0, 3.0, 1.0), 0.25)
    assert way == ((3.0, 3.0, 0.0),)


def test_there_is_no_way_into_a_world_of_stone() -> None:
    stone = Polygon(
        points=((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)), height_m=3.0, kind="water"
    )
    grid = grid_of(Scene.open_space((0.0, 0.0, 4.0, 4.0), polygons=[stone]))
    assert find_route(grid, (1.0, 1.0, 0), (3.0, 3.0, 0), 0.25) is None


inside = st.floats(0.5, 19.5)


@settings(max_examples=25, deadline=None)
@given(start=st.tuples(inside, inside), goal=st.tuples(inside, inside))
def test_no_leg_of_a_way_meets_a_wall(
    start: tuple[float, float], goal: tuple[float, float]
) -> None:
    grid = grid_of(ROOM)
    free = grid.nearest_free(start, 0, 0.25)
    assert free is not None
    way = find_route(grid, (*free, 0), (*goal, 0), 0.25)
    assert way is not None
    here = np.array([free])
    for x, y, z in way:
        here, _ = grid.walk(here, [z], np.array([[x, y]]) - here, 0.2)
        assert math.dist(here[0], (x, y)) < 0.3
