"""The potential over floors, against Dijkstra over the same steps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body
from esplanade.planning.traversal.wavefront import (
    UNREACHED,
    metres,
    number_regions,
    spread_toward,
    spread_wave,
)
from tests.naive.floors import Floors, ways_left
from tests.planning.storeys import bodies, box, cluttered, flight, grid_of, traversability
from tests.planning.worlds import holds


@given(cluttered(), bodies, st.integers(0, 10**6))
@holds(10, 4)
def test_ways_left_are_the_shortest_over_cells(grid, body, pick) -> None:
    feet = traversability(grid, body)
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


@given(cluttered(), bodies, st.integers(0, 10**6))
@holds(20, 4)
def test_a_wave_toward_a_start_is_exact_there_and_on_the_way(grid, body, pick) -> None:
    feet = traversability(grid, body)
    standing = np.flatnonzero(feet.classes)
    if not len(standing):
        return
    random = np.random.default_rng(pick)
    for goal, start in random.choice(standing, (8, 2)):
        all_of_it, toward = spread_wave(feet, goal), spread_toward(feet, goal, start)
        assert (toward >= all_of_it).all()
        cell = start
        assert toward[cell] == all_of_it[cell]
        while cell != goal and toward[cell] != UNREACHED:
            around = [
                int(feet.arrays.links[cell, d]) for d in range(8) if feet.steps[cell] >> d & 1
            ]
            before, cell = cell, min(around, key=lambda other: int(toward[other]))
            assert toward[cell] == all_of_it[cell]
            assert toward[cell] < toward[before]


def test_a_wave_toward_a_start_sees_little_else_in_the_open() -> None:
    feet = traversability(grid_of(16.0), Body.adult())
    cells = {tuple(place): cell for cell, place in enumerate(feet.arrays.places.tolist())}
    left = spread_toward(feet, cells[0, 5, 3], cells[0, 40, 60])
    assert (left != UNREACHED).sum() < 8 * 60


@given(cluttered(), bodies)
@holds(20, 4)
def test_regions_are_what_a_wave_reaches(grid, body) -> None:
    feet = traversability(grid, body)
    regions = number_regions(feet)
    assert np.array_equal(regions >= 0, feet.classes > 0)
    numbers = range(regions.max(initial=-1) + 1)
    for number in numbers:
        members = np.flatnonzero(regions == number)
        assert np.array_equal(np.flatnonzero(spread_wave(feet, members[0]) != UNREACHED), members)


def test_the_wave_climbs_stairs_to_the_floor_right_above() -> None:
    upper = box(3.0, 0.0, 6.0, 6.0, 0.25, offset_m=2.5)
    grid = grid_of(6.0, [upper], stairs=[flight((0.0, 3.0), (3.0, 3.0), 2.0, 2.5, 10)])
    cells = Floors(grid.layered, grid.barriers, Body.adult()).cells
    below, above = cells[0, 12, 18], cells[1, 12, 18]
    for body, reaches in ((Body.adult(), True), (Body(step_on_m=0.2), False)):
        feet = traversability(grid, body)
        left = metres(feet, spread_wave(feet, above))
        assert math.isfinite(left[below]) == reaches
    assert left[above] == 0.0
