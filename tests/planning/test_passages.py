"""Narrow places on the way: what is one, where its middle is, and which way it leads."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planning._passage_kernels import NARROW_M, PASSAGE, find_passage, measure_passage
from planning.grid import LayeredGrid
from planning.scene import Scene
from tests.planning.worlds import holds

RADIUS_M = 0.25
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
    guide = grid.potential(goal, 0, RADIUS_M).guide
    out = np.zeros(PASSAGE)
    found = find_passage(grid.arrays, guide, 0, RADIUS_M, cell, *start, out)
    return out if found else None


@given(st.floats(1.0, 2.4), st.floats(-0.6, 0.6), st.floats(2.0, 14.0), st.floats(2.0, 14.0))
@holds(60, 6)
def test_a_doorway_is_found_from_wherever_one_comes(door_m, turn, start_y, goal_y) -> None:
    grid = _wall(door_m, math.pi / 2 + turn)
    for start_x, goal_x in ((2.0, 14.0), (14.0, 2.0)):
        passage = _found(grid, (start_x, start_y), (goal_x, goal_y))
        if passage is None:  # it lies around a corner
            assert max(abs(start_y - 8.0), abs(goal_y - 8.0)) > 2.0
            continue
        assert passage[:2] == pytest.approx([8.0, 8.0], abs=0.4)
        across = math.copysign(1.0, goal_x - start_x)
        through = (across * math.cos(turn), across * math.sin(turn))
        assert passage[2] * through[0] + passage[3] * through[1] > math.cos(0.35)
        assert passage[4] == pytest.approx(door_m / 2 - RADIUS_M, abs=0.3)


def test_who_sees_a_doorway_straight_ahead_finds_it() -> None:
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
    assert not measure_passage(grid.arrays, 0, RADIUS_M, cell, 8.0, 3.0, np.zeros(PASSAGE))
