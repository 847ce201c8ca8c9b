"""Walking routes: waves that stop early and are shared, and the walk down them."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from esplanade.planning import Body, Door, LayeredGrid, Potential, Scene, Wall, Wave
from esplanade.planning.grid._grid_kernels import anchor_at
from esplanade.planning.grid._walking_kernels import GroundArrays
from esplanade.planning.routes import _descending_kernels as kernels
from esplanade.planning.routes.walking_route import (
    STEP_M,
    TURN_COS,
    Point,
    Route,
    RouteSearch,
    SharedWaves,
    leads_straight,
)
from esplanade.planning.routes.wave_front import NO_TARGETS, WaveFront
from tests.naive.descent import descend
from tests.planning.storeys import storeyed
from tests.planning.worlds import UPPER_M, holds, lines, open_grid, points

RADIUS_M = 0.25
ADULT = Body.adult()
GATED = Scene(
    bounds=(0.0, 0.0, 12.0, 9.0),
    walls=(Wall(start=(6.0, 0.0), end=(6.0, 3.0)), Wall(start=(6.0, 5.0), end=(6.0, 8.0))),
    doors=(Door(name="gate", start=(6.0, 3.0), end=(6.0, 5.0)),),
)


def wave_of(grid: LayeredGrid, goal: Point) -> WaveFront:
    cell = grid.cell_at(goal[:2], goal[2])
    return WaveFront(grid, goal[:2], cell, RADIUS_M, Wave.SIGHT, ADULT)


def route_of(waves: SharedWaves, start: Point, goal: Point) -> Route | None:
    search = RouteSearch(waves, start, goal, RADIUS_M)
    while not search.advance():
        pass
    return search.route


def length_m(start: Point, route: Route) -> float:
    return sum(math.dist(a[:2], b[:2]) for a, b in pairwise([start, *route]))


@given(lines(0.5, 7.5, 4), points(0.3, 7.7), points(0.3, 7.7), st.integers(1, 60))
@holds(25, 6)
def test_a_wave_that_stops_early_is_the_whole_one_as_far_as_it_goes(walls, start, goal, most):
    grid = open_grid(8.0, walls)
    assume(grid.is_free([start, goal], [0, 0], RADIUS_M).all())
    whole, part = wave_of(grid, (*goal, 0.0)), wave_of(grid, (*goal, 0.0))
    assert whole.grow(NO_TARGETS)
    target = np.array([grid.cell_at(start, 0.0)])
    while not part.grow(target, 0.5, most):
        pass
    assert part.reached_cells <= whole.reached_cells
    assert part.settled[target[0]] == whole.settled[target[0]]
    settled = part.settled == 1
    assert np.array_equal(part.values[settled], whole.values[settled])
    left = Potential(grid, goal, 0.0, RADIUS_M).values
    assert np.array_equal(left[settled], part.values[settled])


def test_a_wave_to_a_start_nearby_reaches_few_cells() -> None:
    grid = open_grid(40.0)
    wave = wave_of(grid, (20.0, 20.0, 0.0))
    assert wave.grow(np.array([grid.cell_at((23.0, 20.0), 0.0)]), 1.0)
    assert wave.reached_cells < 0.05 * len(grid.layered.floors)


@given(lines(0.5, 7.5, 4), points(0.3, 7.7), points(0.3, 7.7))
@holds(25, 6)
def test_the_compiled_walk_is_the_plain_one(walls, start, goal) -> None:
    grid = open_grid(8.0, walls)
    assume(grid.is_free([start, goal], [0, 0], RADIUS_M).all())
    wave = wave_of(grid, (*goal, 0.0))
    wave.grow(NO_TARGETS)
    cell, corners = grid.cell_at(start, 0.0), np.empty((200, 3))
    toward = anchor_at(grid.arrays, grid.row_of(ADULT), cell)
    count = kernels.descend(
        GroundArrays(grid.arrays, grid.index),
        grid.row_of(ADULT),
        ADULT.height_m,
        ADULT.step_on_m,
        ADULT.leg_length_m,
        RADIUS_M,
        wave.values,
        wave.settled,
        cell,
        start,
        toward,
        (*goal, 0.0),
        STEP_M,
        TURN_COS,
        corners,
    )
    plain = descend(
        grid, wave, (*start, 0.0), toward, (*goal, 0.0), RADIUS_M, STEP_M, TURN_COS, 200
    )
    assert (count < 0) == (plain is None)
    if plain is not None:
        assert corners[:count] == pytest.approx(np.array(plain).reshape(-1, 3), abs=1e-5)


def test_the_compiled_walk_climbs_stairs_as_the_plain_one_does() -> None:
    grid = LayeredGrid.from_scene(storeyed())
    start, goal = (12.0, 6.0, 0.0), (12.0, 6.0, UPPER_M)
    wave = wave_of(grid, goal)
    wave.grow(NO_TARGETS)
    route = route_of(SharedWaves(grid), start, goal)
    cell = grid.cell_at(start[:2], 0.0)
    toward = anchor_at(grid.arrays, grid.row_of(ADULT), cell)
    plain = descend(grid, wave, start, toward, goal, RADIUS_M, STEP_M, TURN_COS, 1000)
    assert route is not None
    assert plain is not None
    corners = np.array([*plain, goal])
    kept = [int(np.abs(corners - corner).sum(axis=1).argmin()) for corner in route]
    assert kept == sorted(set(kept))  # those that a straight walk passes by are left out
    assert kept[-1] == len(plain)
    assert route == pytest.approx(corners[kept], abs=0.01)


def test_no_corner_of_a_route_can_be_left_out() -> None:
    grid = LayeredGrid.from_scene(storeyed())
    start, goal = (12.0, 6.0, 0.0), (12.0, 6.0, UPPER_M)
    route = route_of(SharedWaves(grid), start, goal)
    assert route is not None
    points = [start, *route]
    assert len(points) > 3
    for before, after in zip(points, points[2:], strict=False):
        assert not leads_straight(grid, before, after, RADIUS_M)


@given(lines(0.5, 7.5, 4), points(0.3, 7.7), points(0.3, 7.7))
@holds(25, 6)
def test_a_route_is_as_long_as_the_whole_potential_says(walls, start, goal) -> None:
    grid = open_grid(8.0, walls)
    assume(grid.is_free([start, goal], [0, 0], RADIUS_M).all())
    cell = grid.cell_at(start, 0.0)
    assume(grid.arrays.clearance[0, cell] >= RADIUS_M)
    left_m = Potential(grid, goal, 0.0, RADIUS_M).distance([start], [0.0])[0]
    route = route_of(SharedWaves(grid), (*start, 0.0), (*goal, 0.0))
    assert (route is not None) <= math.isfinite(left_m)
    if route is not None:
        assert length_m((*start, 0.0), route) <= 1.03 * left_m + 2.0 * grid.cell_m


@pytest.mark.parametrize("x", [5.8, 5.85, 5.9])
def test_who_stands_too_close_to_a_wall_finds_a_way_out_on_their_side(x: float) -> None:
    grid = LayeredGrid.from_scene(GATED)
    start, goal = (x, 1.5, 0.0), (8.0, 1.5, 0.0)
    assert not grid.is_free([start[:2]], [0.0], RADIUS_M)[0]
    route = route_of(SharedWaves(grid), start, goal)
    assert route is not None
    assert length_m(start, route) < 6.5
    assert max(y for _, y, _ in route) > 3.0


def test_a_wave_serves_all_who_go_to_one_cell_until_a_door_moves() -> None:
    grid = LayeredGrid.from_scene(GATED)
    waves = SharedWaves(grid)
    goals = [(8.05, 1.5, 0.0), (8.1, 1.55, 0.0)]
    starts = [(4.0, 1.0, 0.0), (2.0, 2.0, 0.0)]
    for start, goal in zip(starts, goals, strict=True):
        route = route_of(waves, start, goal)
        assert route is not None
        assert route[-1] == goal
        alone = route_of(SharedWaves(grid), start, goal)
        assert alone is not None
        assert length_m(start, route) == pytest.approx(length_m(start, alone), abs=0.2)
    assert len(waves) == 1
    grid.set_door("gate", False)
    route = route_of(waves, starts[0], goals[0])
    assert route is not None
    assert max(y for _, y, _ in route) > 8.0, "around the upper end of the wall"


def test_few_waves_are_kept() -> None:
    grid = LayeredGrid.from_scene(GATED)
    waves = SharedWaves(grid)
    for k in range(40):
        assert route_of(waves, (4.0, 1.0, 0.0), (7.0 + 0.1 * k, 1.5, 0.0)) is not None
    assert len(waves) <= 16
