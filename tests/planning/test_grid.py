"""Clearance over the ground, look-ups in it, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planning import LayeredGrid, Polygon, Scene
from planning._grid_kernels import line_is_clear
from planning.grid import CLEARANCE_CAP_M
from tests.naive.geometry import point_segment_distance, segment_distance
from tests.naive.waves import clearance_field
from tests.planning.worlds import holds, lines, open_grid, points

SQUARE = [(1.0, 1.0), (2.5, 1.2), (2.4, 2.6), (0.9, 2.4)]
HOOK = [(3.0, 3.0), (5.0, 3.0), (5.0, 3.5), (3.5, 3.5), (3.5, 5.0), (3.0, 5.0)]


@given(lines(0.0, 5.0, 4), st.lists(st.sampled_from([SQUARE, HOOK]), max_size=2, unique_by=id))
@holds(12, 3)
def test_clearance_is_the_distance_to_the_nearest_obstacle(walls, rings) -> None:
    polygons = [Polygon(points=tuple(ring), height_m=2.0) for ring in rings]
    grid = open_grid(5.0, walls, polygons)
    edges = [*walls]
    for ring in rings:
        edges += zip(ring, ring[1:] + ring[:1], strict=True)
    expected = clearance_field(edges, rings, grid.bounds, grid.cell_m, CLEARANCE_CAP_M)
    assert grid.arrays.clearance[0] == pytest.approx(expected, abs=1e-5)


@given(lines(0.0, 5.0, 4), points(0.3, 4.7))
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
    clear = line_is_clear(grid.arrays, 0, *a, *b, 0.4)
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
    assert 2.25 <= beside[0] <= 2.75
    assert abs(beside[1] - 4.0) <= grid.cell_m


def test_a_full_world_has_no_free_place() -> None:
    block = Polygon(points=((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)), height_m=2.0)
    assert open_grid(2.0, polygons=[block]).nearest_free((1.0, 1.0), 0, 0.25) is None


def test_a_grid_covers_bounds_that_are_no_multiple_of_a_cell() -> None:
    grid = LayeredGrid.from_scene(Scene.open_space((-1.0, 0.5, 1.1, 1.3)), 0.25)
    assert grid.arrays.clearance.shape == (1, 4, 9)
    assert grid.bounds == (-1.0, 0.5, 1.1, 1.3)
    assert grid.layers == 1


@pytest.mark.parametrize("cell_m", [0.0, 0.04, 2.1, math.nan])
def test_cells_have_a_sensible_size(cell_m) -> None:
    with pytest.raises(ValueError, match="cell_m"):
        LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 4.0, 4.0)), cell_m)


def test_positions_and_layers_are_checked() -> None:
    grid = open_grid(4.0)
    with pytest.raises(ValueError, match="finite"):
        grid.clearance([(math.nan, 1.0)], [0])
    with pytest.raises(ValueError, match="layers must lie in 0"):
        grid.clearance([(1.0, 1.0)], [1])
    with pytest.raises(ValueError, match="1 positions but 2 layers"):
        grid.clearance([(1.0, 1.0)], [0, 0])
    assert grid.clearance(np.zeros((0, 2)), []).shape == (0,)
