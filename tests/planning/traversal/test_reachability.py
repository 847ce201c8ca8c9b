"""Reachability between cells, against the long way."""

import numpy as np
from hypothesis import given

from esplanade.planning import Body, Wall
from esplanade.planning.traversal.reachability import reachable_from
from tests.naive.floors import Floors
from tests.planning.storeys import bodies, box, cluttered, grid_of, traversability
from tests.planning.worlds import holds


def reached(grid, body, layer, j, i):
    """Rows and columns, on any layer, that a body gets to from a cell."""
    floors = Floors(grid.layered, grid.barriers, body)
    cells = reachable_from(
        grid.layered, traversability(grid, body).steps, floors.cells[layer, j, i]
    )
    return {tuple(place) for place in grid.layered.places[cells].tolist()}


@given(cluttered(), bodies)
@holds(15, 5)
def test_steps_are_those_of_the_long_way(grid, body) -> None:
    found = traversability(grid, body).steps
    expected = np.zeros_like(found)
    for cell, ways in Floors(grid.layered, grid.barriers, body).steps().items():
        for d in ways:
            expected[cell] |= 1 << d
    assert np.array_equal(found, expected)


@given(cluttered(), bodies)
@holds(40, 5)
def test_steps_lead_both_ways(grid, body) -> None:
    found, links = traversability(grid, body).steps, grid.layered.links
    for d in range(8):
        cells = np.flatnonzero(found >> d & 1)
        assert (found[links[cells, d]] >> (d + 4) % 8 & 1).all()


def test_a_step_higher_than_step_on_is_for_the_tall_only() -> None:
    grid = grid_of(4.0, [box(2.0, 0.0, 4.0, 4.0, 0.45)])
    assert (0, 8, 12) in reached(grid, Body.adult(), 0, 8, 2)
    assert (0, 8, 12) not in reached(grid, Body.child(), 0, 8, 2)


def test_room_of_just_the_height_is_enough() -> None:
    grid = grid_of(4.0, [box(1.0, 0.0, 3.0, 4.0, 0.25, offset_m=1.8)])
    assert (0, 8, 14) in reached(grid, Body.adult(), 0, 8, 2)
    assert (0, 8, 14) not in reached(grid, Body(height_m=1.81), 0, 8, 2)


def test_nobody_steps_through_a_wall_between_two_cells() -> None:
    grid = grid_of(4.0, walls=[Wall(start=(2.0, 0.0), end=(2.0, 4.0), height_m=2.0)])
    assert all(i < 8 for _, _, i in reached(grid, Body.adult(), 0, 8, 2))
    low = grid_of(4.0, walls=[Wall(start=(2.0, 0.0), end=(2.0, 4.0), height_m=0.5)])
    assert (0, 8, 14) in reached(low, Body.adult(), 0, 8, 2)
    assert (0, 8, 14) not in reached(low, Body.child(), 0, 8, 2)
