"""Clearance over the ground, look-ups in it, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, Polygon, Scene, Wall
from esplanade.planning.grid._grid_kernels import anchor_at, clearance_many, line_is_clear
from esplanade.planning.ground._geometry_kernels import Placement, crosses_any
from tests.naive.floors import SLACK_M
from tests.naive.geometry import point_segment_distance, segment_distance
from tests.naive.waves import clearance_field
from tests.planning.worlds import UPPER_M, as_rows, holds, lines, open_grid, points, two_floors

CLEARANCE_CAP_M = 3.0
SQUARE = [(1.0, 1.0), (2.5, 1.2), (2.4, 2.6), (0.9, 2.4)]
HOOK = [(3.0, 3.0), (4.7, 3.0), (4.7, 3.5), (3.5, 3.5), (3.5, 4.7), (3.0, 4.7)]


@given(lines(0.0, 5.0, 4), st.lists(st.sampled_from([SQUARE, HOOK]), max_size=2, unique_by=id))
@holds(12, 3)
def test_clearance_is_the_distance_to_the_nearest_obstacle(walls, rings) -> None:
    polygons = [Polygon(points=tuple(ring), height_m=2.0) for ring in rings]
    grid = open_grid(5.0, walls, polygons)
    edges = [*walls]
    for ring in rings:
        edges += zip(ring, ring[1:] + ring[:1], strict=True)
    expected = clearance_field(edges, rings, grid.bounds, grid.cell_m, CLEARANCE_CAP_M)
    assert grid.arrays.flat
    assert as_rows(grid, grid.arrays.clearance[0]) == pytest.approx(expected, abs=1e-5)


@given(lines(0.0, 5.0, 4), points(0.0, 5.0))
@example([], (5.0, 5.0))
@example([], (4.95, 2.5))
@holds(60, 20)
def test_between_centres_clearance_is_off_by_less_than_a_cells_diagonal(walls, p) -> None:
    grid = open_grid(5.0, walls)
    found = grid.clearance([p], [0])[0]
    exact = min([CLEARANCE_CAP_M, *(point_segment_distance(p, *wall) for wall in walls)])
    assert abs(found - exact) <= grid.cell_m * math.sqrt(0.5)


@given(lines(0.0, 5.0, 3), points(0.2, 4.8), points(0.2, 4.8))
@holds(100, 30)
def test_a_clear_line_keeps_off_walls_and_a_hidden_one_does_not(walls, a, b) -> None:
    grid = open_grid(5.0, walls)
    room = min([math.inf, *(segment_distance(a, b, *wall) for wall in walls)])
    cell = grid.on_ground([a], [0.0])[1][0]
    clear = line_is_clear(grid.arrays, 0, cell, *a, *b, 0.4)
    assert not (clear and room < 0.4 - grid.cell_m)
    assert not (not clear and room > 0.4 + grid.cell_m)


def test_outside_the_bounds_nothing_is_free() -> None:
    grid = open_grid(4.0)
    outside = [(-0.01, 2.0), (2.0, 4.01), (9.0, 9.0)]
    assert grid.clearance(outside, [0, 0, 0]).tolist() == [-math.inf] * 3
    assert not grid.is_free(outside, [0, 0, 0], 0.0).any()
    assert grid.is_free([(0.0, 0.0), (4.0, 4.0)], [0, 0], 0.2).all()


def test_the_nearest_free_place_is_the_place_itself_or_beside_the_obstacle() -> None:
    block = Polygon(points=((3.0, 3.0), (5.0, 3.0), (5.0, 5.0), (3.0, 5.0)), height_m=2.0)
    grid = open_grid(8.0, polygons=[block])
    assert grid.nearest_free((1.0, 1.0), 0, 0.25) == (1.0, 1.0)
    beside = grid.nearest_free((3.2, 4.0), 0, 0.25)
    assert beside is not None
    assert 2.25 <= beside[0] <= 2.75 + SLACK_M
    assert abs(beside[1] - 4.0) <= grid.cell_m


def test_a_place_deep_inside_a_building_is_moved_beside_it_and_not_onto_its_roof() -> None:
    block = Polygon(points=((3.0, 3.0), (6.0, 3.0), (6.0, 6.0), (3.0, 6.0)), height_m=2.0)
    scene = Scene.open_space((0.0, 0.0, 9.0, 9.0), polygons=[block])
    with_roof = LayeredGrid.from_scene(scene)
    assert np.nanmax(with_roof.layered.floors) == 2.0
    for grid in (with_roof, open_grid(9.0, polygons=[block])):
        beside = grid.nearest_free((4.0, 4.5), 0.0, 0.25)
        assert beside is not None
        assert 2.25 <= beside[0] <= 2.75 + SLACK_M
        assert grid.floor_at(beside, 0.0) == 0.0
    for height_m in (2.0, 7.0):
        assert with_roof.nearest_free((4.0, 4.5), height_m, 0.25) == (4.0, 4.5)
    assert with_roof.nearest_free((1.0, 1.0), 2.0, 0.25) == (1.0, 1.0)


def test_a_full_world_has_no_free_place() -> None:
    ring = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
    water = Polygon(points=ring, height_m=2.0, kind="water")
    assert open_grid(2.0, polygons=[water]).nearest_free((1.0, 1.0), 0, 0.25) is None
    roofed = open_grid(2.0, polygons=[Polygon(points=ring, height_m=2.0)])
    assert roofed.floor_at((1.0, 1.0), 0.0) == 2.0
    assert roofed.nearest_free((1.0, 1.0), 0.0, 0.25) == (1.0, 1.0), "where there is nothing lower"


def test_the_floor_that_is_meant_is_the_one_nearest_in_height() -> None:
    grid = two_floors()
    assert grid.layers == 2
    where = [(4.0, 4.0)] * 5
    cells = grid.on_ground(where, [0.0, 1.6, 1.7, 3.3, 99.0])[1]
    assert grid.layered.places["layer"][cells].tolist() == [0, 0, 1, 1, 1]
    assert [grid.layer_at((4.0, 4.0), z) for z in (-5.0, 1.0, 2.0)] == [0, 0, 1]
    assert grid.floor_at((4.0, 4.0), 2.5) == pytest.approx(UPPER_M)


def test_walls_count_on_the_floor_that_they_stand_on() -> None:
    wall = Wall(start=(4.0, 0.0), end=(4.0, 8.0), height_m=2.5)
    above = wall.model_copy(update={"offset_m": UPPER_M})
    ring = ((0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0))
    slab = Polygon(points=ring, offset_m=3.0, height_m=0.3, kind="floor")
    for walls, hindered in (((wall,), 0.0), ((above,), UPPER_M)):
        scene = Scene(bounds=(0.0, 0.0, 8.0, 8.0), polygons=(slab,), walls=walls)
        grid = LayeredGrid.from_scene(scene)
        for z_m in (0.0, UPPER_M):
            room = grid.clearance([(3.125, 4.125)], [z_m])[0]
            assert room == pytest.approx(0.875 if z_m == hindered else CLEARANCE_CAP_M, abs=1e-5)


def test_bodies_have_clearances_of_their_own() -> None:
    low = Polygon(
        points=((3.0, 0.0), (5.0, 0.0), (5.0, 8.0), (3.0, 8.0)), offset_m=1.5, height_m=0.3
    )
    step = Wall(start=(6.0, 0.0), end=(6.0, 8.0), height_m=0.45)
    scene = Scene(bounds=(0.0, 0.0, 8.0, 8.0), polygons=(low,), walls=(step,))
    grid = LayeredGrid.from_scene(scene)
    adult, child = Body.adult(), Body.child()
    under, beside = [(4.125, 4.125)], [(5.625, 4.125)]
    assert not grid.is_free([(3.125, 4.125)], [0.0], 0.25, adult)[0]
    # A child could put a leg over the step, so that its disc may reach beyond all but 13 cm.
    beyond = child.radius_m - 0.13
    assert grid.clearance(under, [0.0], child)[0] == pytest.approx(1.875 + beyond, abs=1e-5)
    assert grid.clearance(beside, [0.0], child)[0] == pytest.approx(0.375 + beyond, abs=1e-5)
    assert grid.clearance(beside, [0.0], adult)[0] == pytest.approx(0.625, abs=1e-5)
    assert grid.row_of(child) == grid.row_of(Body.child()) != grid.row_of(adult)


def test_a_grid_covers_bounds_that_are_no_multiple_of_a_cell() -> None:
    grid = LayeredGrid.from_scene(Scene.open_space((-1.0, 0.5, 1.1, 1.3)), 0.25)
    assert (grid.layered.ny, grid.layered.nx) == (4, 9)
    assert np.isfinite(grid.layered.floors).sum() == 36
    assert grid.bounds == (-1.0, 0.5, 1.1, 1.3)
    assert grid.layers == 1


@pytest.mark.parametrize("cell_m", [0.0, 0.04, 2.1, math.nan])
def test_cells_have_a_sensible_size(cell_m) -> None:
    with pytest.raises(ValueError, match="cell_m"):
        LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 4.0, 4.0)), cell_m)


def test_positions_and_heights_are_checked() -> None:
    grid = open_grid(4.0)
    with pytest.raises(ValueError, match="finite"):
        grid.clearance([(math.nan, 1.0)], [0])
    with pytest.raises(ValueError, match="heights must be finite"):
        grid.clearance([(1.0, 1.0)], [math.inf])
    with pytest.raises(ValueError, match="1 positions but 2 heights"):
        grid.clearance([(1.0, 1.0)], [0, 0])
    assert grid.clearance(np.zeros((0, 2)), []).shape == (0,)


def plain_nearest_free(grid, position, height, clearance_m, body):
    """`LayeredGrid.nearest_free` over whole arrays, cell by cell in order of distance."""
    row = grid.row_of(body)
    floors = grid.layered.floors
    anchors = np.array([anchor_at(grid.arrays, row, cell) for cell in range(len(floors))])
    clear, at_anchor = grid.arrays.clearance[row], np.empty(len(floors))
    clearance_many(grid.arrays, row, np.arange(len(floors)), anchors, at_anchor)
    fits = np.isfinite(floors) & ((clear >= clearance_m) | (at_anchor >= clearance_m - SLACK_M))
    floor = grid.floor_at(position, height)
    free_here = grid.is_free([position], [height], clearance_m, body)[0]
    apart = np.abs(floors - height)
    for near_m in (0.5 * body.height_m, math.inf):
        if free_here and floor - height < near_m:
            return position
        cells = np.flatnonzero(fits & (apart < near_m))
        if not len(cells):
            continue
        away = np.hypot(*(anchors[cells] - position).T) + apart[cells]
        placement = Placement(floor, floor, body.height_m, body.step_on_m, body.leg_length_m)
        for k in np.argsort(away, kind="stable"):
            x, y = anchors[cells[k]].tolist()
            if away[k] < 1.0 and not crosses_any(grid.index, placement, *position, x, y):
                return x, y
        x, y = anchors[cells[away.argmin()]].tolist()
        return x, y
    return None


@given(lines(0.0, 5.0, 4), st.lists(st.sampled_from([SQUARE, HOOK]), max_size=2, unique_by=id))
@holds(30, 8)
def test_the_nearest_free_place_is_that_of_the_plain_search(walls, rings) -> None:
    grid = open_grid(5.0, walls, [Polygon(points=tuple(ring), height_m=2.0) for ring in rings])
    for x, y in np.random.default_rng(1).uniform(-0.5, 5.5, (20, 2)).tolist():
        for clearance_m in (0.25, 0.6):
            expected = plain_nearest_free(grid, (x, y), 0.0, clearance_m, Body.adult())
            assert grid.nearest_free((x, y), 0.0, clearance_m) == expected
