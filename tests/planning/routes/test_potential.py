"""Wave fronts against Dijkstra over cells and against the shortest ways there are."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from esplanade.planning import Body, Polygon, Potential, Wave
from esplanade.planning.routes._potential_kernels import direction_at, potential_at
from tests.naive import waves as naive
from tests.naive.floors import Floors
from tests.planning.worlds import holds, lines, open_grid, points

ADULT = Body.adult()
RADIUS_M = 0.25
CELL_M = 0.25
ROOM = [
    ((2.0, 2.0), (4.0, 2.0)),
    ((4.0, 2.0), (4.0, 4.0)),
    ((4.0, 4.0), (2.0, 4.0)),
    ((2.0, 4.0), (2.0, 2.0)),
]


def centres(grid):
    """Every cell's centre, row by row, and its height."""
    ny, nx = grid.layered.ny, grid.layered.nx
    x, y = np.meshgrid((np.arange(nx) + 0.5) * CELL_M, (np.arange(ny) + 0.5) * CELL_M)
    return np.stack([x.ravel(), y.ravel()], axis=1), np.zeros(nx * ny)


@given(lines(0.0, 6.0, 5), st.tuples(st.integers(0, 23), st.integers(0, 23)))
@holds(15, 6)
def test_nf1_is_the_shortest_way_over_cells(walls, goal) -> None:
    grid = open_grid(6.0, walls)
    floors = Floors(grid.layered, grid.barriers, ADULT)
    cell = floors.cells[0, goal[0], goal[1]]
    place = floors.anchor(cell)
    assume(grid.is_free([place], [0], RADIUS_M)[0])
    potential = Potential(grid, place, 0, RADIUS_M, Wave.NF1)
    ways = {
        a: {b: math.dist(floors.anchor(a), floors.anchor(b)) for b in others.values()}
        for a, others in floors.steps().items()
    }
    expected = naive.dijkstra(ways, cell)
    for other in floors.cells.values():
        found = potential_at(potential.values, other, *floors.anchor(other))
        assert found == pytest.approx(expected.get(other, math.inf), abs=1e-4)
    assert potential.reached_cells == len(expected)


@given(lines(1.0, 7.0, 2), points(0.5, 7.5), points(0.5, 7.5))
@holds(12, 4)
def test_sight_is_nearly_the_shortest_way_at_any_angle(walls, start, goal) -> None:
    grid = open_grid(8.0, walls)
    # Cells know obstacles to within half a cell: bounds come from discs that much wider or thinner.
    least = naive.shortest_way(walls, start, goal, max(0.01, RADIUS_M - CELL_M), corners=8)
    most = naive.shortest_way(walls, start, goal, RADIUS_M + CELL_M, corners=8)
    assume(math.isfinite(most))
    found = Potential(grid, goal, 0, RADIUS_M).distance([start], [0])[0]
    assert least * 0.97 - 1e-6 <= found <= most * 1.03 + 2.0 * CELL_M


def test_around_one_wall_sight_is_within_three_percent_and_nf1_within_twelve() -> None:
    wall = ((4.0, 0.0), (4.0, 5.0))
    start, goal = (1.125, 1.125), (6.875, 2.375)
    grid = open_grid(8.0, [wall])
    beyond_the_bounds = ((4.0, -9.0), (4.0, 5.0))
    exact = naive.shortest_way([beyond_the_bounds], start, goal, RADIUS_M)
    sight = Potential(grid, goal, 0, RADIUS_M, Wave.SIGHT).distance([start], [0])[0]
    nf1 = Potential(grid, goal, 0, RADIUS_M, Wave.NF1).distance([start], [0])[0]
    assert abs(sight - exact) < 0.03 * exact
    assert sight < nf1 < 1.12 * exact


def test_in_the_open_sight_is_the_straight_way_from_everywhere() -> None:
    grid = open_grid(8.0)
    goal = (3.3, 5.1)
    positions, heights = centres(grid)
    potential = Potential(grid, goal, 0, RADIUS_M)
    assert potential.distance(positions, heights) == pytest.approx(
        np.hypot(*(positions - goal).T), abs=1e-5
    )
    down = potential.direction(positions, heights)
    assert (positions + down * potential.distance(positions, heights)[:, None]) == pytest.approx(
        np.broadcast_to(goal, positions.shape), abs=1e-4
    )
    assert potential.direction([goal], [0])[0].tolist() == [0.0, 0.0]


@pytest.mark.parametrize("wave", list(Wave))
def test_going_down_leads_to_the_goal_through_free_cells(wave) -> None:
    walls = [((3.0, 0.0), (3.0, 6.0)), ((5.0, 2.0), (5.0, 8.0))]
    grid = open_grid(8.0, walls)
    goal = (7.125, 6.125)
    potential = Potential(grid, goal, 0, RADIUS_M, wave)
    position = np.array([[1.125, 1.125]])
    length = potential.distance(position, [0])[0]
    walked = 0.0
    while potential.distance(position, [0])[0] > 0.2:
        step = 0.1 * potential.direction(position, [0])
        assert np.hypot(*step[0]) > 0.0
        position = position + step
        walked += 0.1
        assert walked < 1.1 * length + 0.5
        assert grid.clearance(position, [0])[0] > RADIUS_M - CELL_M * math.sqrt(0.5)
    assert walked > 0.95 * length - 0.3


@pytest.mark.parametrize("wave", list(Wave))
def test_no_way_leads_out_of_a_closed_room(wave) -> None:
    grid = open_grid(8.0, ROOM)
    potential = Potential(grid, (3.125, 3.125), 0, RADIUS_M, wave)
    assert potential.distance([(6.0, 6.0)], [0])[0] == math.inf
    assert potential.direction([(6.0, 6.0)], [0])[0].tolist() == [0.0, 0.0]
    assert math.isfinite(potential.distance([(2.6, 2.6)], [0])[0])


def test_no_corner_is_cut() -> None:
    blocks = [
        Polygon(points=((1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)), height_m=2.0),
        Polygon(points=((2.0, 2.0), (3.0, 2.0), (3.0, 3.0), (2.0, 3.0)), height_m=2.0),
    ]
    grid = open_grid(4.0, polygons=blocks)
    between = Potential(grid, (2.5, 1.5), 0, 0.1, Wave.NF1)
    assert between.distance([(1.5, 2.5)], [0])[0] > 3.0


def test_a_way_leads_to_a_goal_that_is_free_in_a_cell_whose_centre_is_not() -> None:
    grid = open_grid(8.0, [((1.0, 4.15), (7.0, 4.15))])
    goal = (4.0, 4.41)
    assert grid.is_free([goal], [0], RADIUS_M)[0]
    i, j = (int(v / CELL_M) for v in goal)
    centre = (i + 0.5) * CELL_M, (j + 0.5) * CELL_M
    assert not grid.is_free([centre], [0], RADIUS_M)[0]
    found = Potential(grid, goal, 0, RADIUS_M).distance([(4.0, 7.0), (4.0, 1.0)], [0, 0])
    assert found[0] == pytest.approx(2.59, abs=0.05)
    assert 7.0 < found[1] < 10.0


@pytest.mark.parametrize("shift_m", [0.0, 0.06, 0.12, 0.19])
@pytest.mark.parametrize("away_m", [0.1, 0.23, 0.24, 0.249, 0.25])
def test_a_goal_too_near_a_wall_is_that_of_the_nearest_place_that_is_not(away_m, shift_m) -> None:
    grid = open_grid(8.0, [((4.0 + shift_m, 0.0), (4.0 + shift_m, 8.0))])
    goal = (4.0 + shift_m - away_m, 4.0)
    potential = Potential(grid, goal, 0, 0.25)
    assert grid.is_free([potential.goal], [0], 0.25)[0]
    assert math.dist(potential.goal, goal) <= 0.5
    way = math.dist((1.0, 4.0), potential.goal)
    assert potential.distance([(1.0, 4.0)], [0])[0] == pytest.approx(way, abs=0.01)


def test_who_stands_beside_a_wall_still_knows_the_way() -> None:
    grid = open_grid(8.0, [((4.0, 0.0), (4.0, 8.0))])
    potential = Potential(grid, (1.0, 4.0), 0, 0.5)
    assert not grid.is_free([(3.8, 4.0)], [0], 0.5)[0]
    assert math.isfinite(potential.distance([(3.8, 4.0)], [0])[0])
    assert potential.direction([(3.8, 4.0)], [0])[0, 0] < -0.5


def test_many_look_ups_are_the_single_one_many_times() -> None:
    grid = open_grid(8.0, [((4.0, 0.0), (4.0, 5.0))])
    potential = Potential(grid, (6.0, 1.0), 0, RADIUS_M)
    rng = np.random.default_rng(3)
    positions = rng.uniform(0.0, 8.0, (20, 2))
    heights = np.zeros(20)
    cells = grid.on_ground(positions, heights)[1]
    found = potential.distance(positions, heights), potential.direction(positions, heights)
    for k, (x, y) in enumerate(positions):
        assert found[0][k] == potential_at(potential.values, cells[k], x, y)
        assert tuple(found[1][k]) == direction_at(grid.arrays, potential.values, cells[k], x, y)[:2]
