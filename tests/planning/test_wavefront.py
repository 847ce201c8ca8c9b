"""The potential over floors, against Dijkstra over the same steps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planning import Body
from planning.wavefront import UNREACHED, metres, spread_wave
from tests.naive.floors import Floors, ways_left
from tests.planning.storeys import bodies, box, cluttered, flight, footing, grid_of
from tests.planning.worlds import holds


@given(cluttered(), bodies, st.integers(0, 10**6))
@holds(20, 4)
def test_ways_left_are_the_shortest_over_cells(grid, body, pick) -> None:
    feet = footing(grid, body)
    standing = np.flatnonzero(feet.classes)
    if not len(standing):
        return
    goal = int(standing[pick % len(standing)])
    found = metres(feet, spread_wave(feet, goal))
    expected = np.full(len(found), np.inf)
    for cell, ways in ways_left(
        Floors(grid.layered, grid.barriers, body).steps(), feet.classes, goal
    ).items():
        expected[cell] = ways * grid.cell_m
    assert found == pytest.approx(expected, rel=1e-5)


def test_a_wave_that_stops_at_the_start_knows_the_same_up_to_there() -> None:
    grid = grid_of(6.0, [box(2.0, 0.0, 3.0, 4.0, 2.0)])
    feet = footing(grid, Body.adult())
    goal, start = (
        Floors(grid.layered, grid.barriers, Body.adult()).cells[0, j, 12] for j in (22, 17)
    )
    all_of_it, up_to_there = spread_wave(feet, goal), spread_wave(feet, goal, start)
    near = all_of_it <= all_of_it[start]
    assert np.array_equal(all_of_it[near], up_to_there[near])
    assert (up_to_there == UNREACHED).sum() > (all_of_it == UNREACHED).sum()


def test_the_wave_climbs_stairs_to_the_floor_right_above() -> None:
    upper = box(3.0, 0.0, 6.0, 6.0, 0.25, offset_m=2.5)
    grid = grid_of(6.0, [upper], stairs=[flight((0.0, 3.0), (3.0, 3.0), 2.0, 2.5, 10)])
    cells = Floors(grid.layered, grid.barriers, Body.adult()).cells
    below, above = cells[0, 12, 18], cells[1, 12, 18]
    for body, reaches in ((Body.adult(), True), (Body(step_on_m=0.2), False)):
        feet = footing(grid, body)
        left = metres(feet, spread_wave(feet, above))
        assert math.isfinite(left[below]) == reaches
    assert left[above] == 0.0
