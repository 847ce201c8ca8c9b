"""Narrow passages on a path: which places are passages, their middles and directions."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.agents._passage_kernels import find_passage, measure_passage
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.routes.potential import Potential
from esplanade.planning.scene.scene import Scene
from tests.planning.worlds import RULES, holds, lines, open_grid, scaled

RADIUS_M = 0.25
NARROW_M = 2.2
WALL_PART = 0.8
RAYS = 8
SIDE_M = 16.0


def _wall(door_m: float, turn: float) -> LayeredGrid:
    """A square, and through its middle a wall at an angle with a doorway in its middle."""
    ux, uy = math.cos(turn), math.sin(turn)
    half = 7.95 / uy
    ends = [(8.0 + s * ux, 8.0 + s * uy) for s in (-half, -door_m / 2, door_m / 2, half)]
    walls = ((ends[0], ends[1]), (ends[2], ends[3]))
    return LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M), walls=walls), 0.25)


def _found(grid, start, goal):
    """The passage on the way between two points, None without one."""
    cell = int(grid.on_ground([start], [0.0])[1][0])
    potential = Potential(grid, goal, 0, RADIUS_M).values
    found, passage = find_passage(grid.arrays, potential, RULES, 0, RADIUS_M, cell, *start)
    return passage if found else None


@given(st.floats(1.0, 2.4), st.floats(-0.6, 0.6), st.floats(2.0, 14.0), st.floats(2.0, 14.0))
@holds(60, 6)
def test_what_is_found_on_the_way_through_a_doorway_is_that_doorway(
    door_m, turn, start_y, goal_y
) -> None:
    grid = _wall(door_m, math.pi / 2 + turn)
    for start_x, goal_x in ((2.0, 14.0), (14.0, 2.0)):
        passage = _found(grid, (start_x, start_y), (goal_x, goal_y))
        if passage is None:  # some doorways are missed: the next test counts how many
            continue
        assert (passage.middle_x, passage.middle_y) == pytest.approx((8.0, 8.0), abs=0.4)
        across = math.copysign(1.0, goal_x - start_x)
        through = (across * math.cos(turn), across * math.sin(turn))
        assert passage.along_x * through[0] + passage.along_y * through[1] > math.cos(0.35)
        assert passage.half_m == pytest.approx(door_m / 2 - RADIUS_M, abs=0.3)


def test_most_doorways_are_found_from_wherever_one_comes() -> None:
    """A line across the path at a slant, or around a corner, may be too long for a narrow place."""
    random = np.random.default_rng(1)
    found = 0
    walls = scaled(30, 4)
    for _ in range(walls):
        grid = _wall(random.uniform(1.0, 1.8), math.pi / 2 + random.uniform(-0.6, 0.6))
        start_y, goal_y = random.uniform(2.0, 14.0, 2)
        found += _found(grid, (2.0, start_y), (14.0, goal_y)) is not None
        found += _found(grid, (14.0, start_y), (2.0, goal_y)) is not None
    assert found >= 1.5 * walls, "of two from each side"


def test_a_doorway_straight_ahead_is_found() -> None:
    grid = _wall(2.0, math.pi / 2)
    for y in (5.0, 7.0, 8.0, 9.0, 11.0):
        assert _found(grid, (3.0, y), (13.0, 8.0)) is not None


def test_wide_gaps_lone_walls_and_open_ground_are_no_passages() -> None:
    assert (
        _found(_wall(NARROW_M + 2 * RADIUS_M + 0.5, math.pi / 2), (2.0, 8.0), (14.0, 8.0)) is None
    )
    lone = Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M), walls=(((8.0, 4.0), (8.0, 8.0)),))
    assert _found(LayeredGrid.from_scene(lone, 0.25), (2.0, 7.0), (14.0, 7.0)) is None
    bare = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M)), 0.25)
    assert _found(bare, (2.0, 8.0), (14.0, 8.0)) is None


def test_a_point_without_room_is_in_no_passage() -> None:
    grid = _wall(2.0, math.pi / 2)
    cell = int(grid.on_ground([(8.0, 3.0)], [0.0])[1][0])
    assert not measure_passage(grid.arrays, RULES, 0, RADIUS_M, cell, 8.0, 3.0)[0]


def _naive_narrowest(grid, x, y, angles):
    """Of lines through a point the shortest from side to side: length, angle, middle."""

    def free_way(angle):
        ux, uy = math.cos(angle), math.sin(angle)
        way = 0.0
        while way < NARROW_M:
            place = (x + way * ux, y + way * uy)
            room = float(grid.clearance([place], [0.0])[0]) - WALL_PART * RADIUS_M
            if room < 0.0:
                return max(0.0, way + max(room, -0.125))
            way += max(room, 0.125)
        return NARROW_M

    ways = [(free_way(angle), free_way(angle + math.pi), angle) for angle in angles]
    ahead, behind, angle = min(ways, key=lambda both: both[0] + both[1])
    aside = 0.5 * (ahead - behind)
    return ahead + behind, angle, (x + aside * math.cos(angle), y + aside * math.sin(angle))


@given(lines(0.0, 8.0, 5), st.floats(0.5, 7.5), st.floats(0.5, 7.5))
@holds(300, 10)
def test_no_more_is_looked_for_than_counts_and_no_less(walls, x, y) -> None:
    grid = open_grid(8.0, walls)
    apart = math.pi / RAYS
    width, angle, middle = _naive_narrowest(grid, x, y, [n * apart for n in range(RAYS)])
    free = grid.clearance([(x, y)], [0.0])[0] >= WALL_PART * RADIUS_M
    expected = bool(free and width < NARROW_M)
    if expected:
        finer = [angle + (n - 2) * 0.25 * apart for n in range(5)]
        width, angle, middle = _naive_narrowest(grid, *middle, finer)
        expected = width < NARROW_M
    cell = int(grid.on_ground([(x, y)], [0.0])[1][0])
    found, passage = measure_passage(grid.arrays, RULES, 0, RADIUS_M, cell, x, y)
    assert found == expected
    if expected:
        assert (passage.middle_x, passage.middle_y) == pytest.approx(middle, abs=1e-6)
        assert 2.0 * (passage.half_m + (1.0 - WALL_PART) * RADIUS_M) == pytest.approx(
            max(width, 2.0 * (1.0 - WALL_PART) * RADIUS_M), abs=1e-6
        )
