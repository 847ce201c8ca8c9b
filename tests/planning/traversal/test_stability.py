"""The five classes, against the long way and in scenes where they can be told."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given

from esplanade.planning import Body, Polygon, Ramp, Wall
from esplanade.planning.traversal.stability import Stability, touched_cells
from tests.naive.floors import Floors
from tests.planning.storeys import bodies, box, cluttered, flight, grid_of, traversability
from tests.planning.worlds import holds


def class_at(grid, body, x, y, z=0.0):
    """The class of the cell that holds a point."""
    floors = Floors(grid.layered, grid.barriers, body)
    j, i = int(y / grid.cell_m), int(x / grid.cell_m)
    cells = [cell for (_, jj, ii), cell in floors.cells.items() if (jj, ii) == (j, i)]
    cell = min(cells, key=lambda c: abs(floors.floor(c) - z))
    return Stability(int(traversability(grid, body).classes[cell]))


@given(cluttered(), bodies)
@holds(40, 5)
def test_classes_are_those_of_the_long_way(grid, body) -> None:
    found = traversability(grid, body).classes
    floors = Floors(grid.layered, grid.barriers, body)
    expected = np.zeros_like(found)
    for cell in floors.cells.values():
        expected[cell] = floors.classify(cell)
    assert np.array_equal(found, expected)


@pytest.mark.parametrize(
    ("radius_m", "cells"), [(0.1, 0), (0.125, 0), (0.2, 8), (0.25, 8), (0.4, 20)]
)
def test_a_disc_touches_the_cells_it_overlaps(radius_m, cells) -> None:
    offsets = touched_cells(radius_m, 0.25)
    assert len(offsets) == cells
    assert all(
        math.hypot(*(max(0.0, abs(v) - 0.5) for v in offset)) * 0.25 < radius_m
        for offset in offsets.tolist()
    )


def test_open_ground_is_stable_up_to_its_bounds() -> None:
    grid = grid_of(4.0)
    assert (traversability(grid, Body.adult()).classes == Stability.STABLE).all()


def test_beside_a_step_one_is_unstable_and_beside_a_block_forbidden() -> None:
    low = grid_of(4.0, [box(2.0, 0.0, 4.0, 4.0, 0.5)])
    high = grid_of(4.0, [box(2.0, 0.0, 4.0, 4.0, 1.1)])
    adult = Body.adult()
    for x in (1.8, 2.2):
        assert class_at(low, adult, x, 2.0) == Stability.UNSTABLE
        assert class_at(high, adult, x, 2.0) == Stability.FORBIDDEN
    for grid in (low, high):
        assert class_at(grid, adult, 1.6, 2.0) == Stability.STABLE
        assert class_at(grid, adult, 2.4, 2.0) == Stability.STABLE


def test_leg_length_tells_an_edge_from_an_obstacle() -> None:
    grid = grid_of(4.0, [box(2.0, 0.0, 4.0, 4.0, 0.75)])
    assert class_at(grid, Body.adult(), 1.8, 2.0) == Stability.UNSTABLE
    broad = dataclasses.replace(Body.child(), radius_m=0.3)
    assert class_at(grid, broad, 1.8, 2.0) == Stability.FORBIDDEN
    assert class_at(grid, Body.child(), 1.8, 2.0) == Stability.STABLE, "it fits into the cell"


def test_where_stairs_meet_the_floor_above_the_way_is_up_and_down() -> None:
    """Fig. 5: treads belong to the ground's layer, the upper floor has a layer of its own."""
    upper = box(3.0, 0.0, 6.0, 6.0, 0.25, offset_m=2.5)
    grid = grid_of(6.0, [upper], stairs=[flight((0.0, 3.0), (3.0, 3.0), 2.0, 2.5, 10)])
    adult = Body.adult()
    assert grid.layered.pages.shape[0] == 2
    assert class_at(grid, adult, 2.9, 3.0, 2.5) == Stability.UP_STAIR
    assert class_at(grid, adult, 3.1, 3.0, 2.75) == Stability.DOWN_STAIR
    assert class_at(grid, adult, 1.6, 3.0, 1.25) == Stability.UNSTABLE
    assert class_at(grid, adult, 4.6, 3.0, 2.75) == Stability.STABLE
    assert class_at(grid, adult, 4.6, 3.0, 0.0) == Stability.STABLE


def test_a_drop_is_forbidden_even_where_stairs_end() -> None:
    upper = box(3.0, 0.0, 6.0, 6.0, 0.25, offset_m=2.5)
    grid = grid_of(6.0, [upper], stairs=[flight((0.0, 3.0), (3.0, 3.0), 2.0, 2.5, 10)])
    assert class_at(grid, Body.adult(), 2.9, 2.1, 2.5) == Stability.FORBIDDEN
    assert class_at(grid, Body.adult(), 3.1, 1.6, 2.75) == Stability.FORBIDDEN


def test_a_gentle_ramp_is_flat_and_a_thin_wall_is_an_obstacle() -> None:
    ring = ((1.0, 0.0), (7.0, 0.0), (7.0, 8.0), (1.0, 8.0))
    ramp = Polygon(points=ring, height_m=1.0, ramp=Ramp(start=(1.0, 4.0), end=(7.0, 4.0)))
    grid = grid_of(8.0, [ramp], walls=[Wall(start=(4.0, 0.0), end=(4.0, 2.0), height_m=3.0)])
    assert class_at(grid, Body.adult(), 3.0, 4.0, 0.4) == Stability.STABLE
    assert class_at(grid, Body.adult(), 4.1, 1.0, 0.5) == Stability.FORBIDDEN


def test_under_a_low_ceiling_there_is_no_place_for_a_head() -> None:
    grid = grid_of(4.0, [box(2.0, 0.0, 4.0, 4.0, 0.25, offset_m=1.5)])
    for x in (1.8, 2.2, 3.0):
        assert class_at(grid, Body.adult(), x, 2.0) == Stability.FORBIDDEN
        assert class_at(grid, Body.child(), x, 2.0) == Stability.STABLE
