"""Steps of meshes with steep sides, over which some columns of cells have no floor."""

import math
from pathlib import Path

import numpy as np
import pytest

from esplanade.planning import Body, LayeredGrid, PathStatus, find_path
from esplanade.planning.routes.walking_route import RouteSearch, SharedWaves

MOVE_M, RADIUS_M = 0.07, 0.25
RISE_M = 0.3
ROOF_M = 4.0
SLANT_M = 0.2
"""Length of the step's side on the map: 56 degrees steep, so that it carries nobody."""


def step(
    path: Path, shift_m: float, degrees: float, rise_m: float = RISE_M, slant_m: float = SLANT_M
) -> LayeredGrid:
    """Two floors below a roof, with a step from one up to the other at x = 3, moved and turned."""
    bands = ((0.0, 0.0), (3.0, 0.0), (3.0 + slant_m, rise_m), (6.0, rise_m))
    ends = [(x, y, z) for x, z in (*bands, (0.0, ROOF_M), (6.0, ROOF_M)) for y in (0.0, 4.0)]
    corners = (turned(*end, shift_m, degrees) for end in ends)
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    for first in (1, 3, 5, 9):
        lines += [f"f {first} {first + 2} {first + 1}", f"f {first + 1} {first + 2} {first + 3}"]
    path.write_text("\n".join(lines))
    return LayeredGrid.from_mesh(path, 0.25, "z")


def turned(x: float, y: float, z: float, shift_m: float, degrees: float):
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return x * cos - y * sin + shift_m, x * sin + y * cos, z


@pytest.mark.parametrize("degrees", [0.0, 27.0, 45.0])
@pytest.mark.parametrize("shift_m", [0.0, 0.05, 0.1, 0.15, 0.2])
def test_people_walk_over_a_step_with_a_steep_side(tmp_path, shift_m, degrees) -> None:
    grid = step(tmp_path / "step.obj", shift_m, degrees)
    below = turned(1.5, 2.0, 0.0, shift_m, degrees)
    above = turned(4.5, 2.2, RISE_M, shift_m, degrees)
    for start, goal in ((below, above), (above, below)):
        assert find_path(grid, start, goal).status is PathStatus.FOUND
        search = RouteSearch(SharedWaves(grid), start, goal, RADIUS_M)
        while not search.advance():
            pass
        assert search.route is not None
        (x, y, z), moves = start, 0
        for corner in search.route:
            while (left := math.dist((x, y), corner[:2])) > 1e-6 and moves < 80:
                share = min(1.0, MOVE_M / left)
                ahead = (share * (corner[0] - x), share * (corner[1] - y))
                places, heights = grid.walk([(x, y)], [z], [ahead], RADIUS_M)
                (x, y), z, moves = places[0].tolist(), float(heights[0]), moves + 1
                assert min(abs(z), abs(z - RISE_M)) < 0.01
        assert np.allclose((x, y, z), goal, atol=0.01)


def test_a_roof_over_a_gap_is_not_the_floor_that_somebody_stands_on(tmp_path) -> None:
    grid = step(tmp_path / "step.obj", 0.0, 0.0, rise_m=0.55, slant_m=0.5)
    gap = (3.125, 2.0)  # the centre of a column over the step's side, which is two columns wide
    assert grid.floor_at(gap, 0.0) == pytest.approx(0.0)
    assert grid.floor_at(gap, ROOF_M) == pytest.approx(ROOF_M)


def test_a_body_that_is_too_small_for_a_step_gets_up_no_steep_side(tmp_path) -> None:
    grid = step(tmp_path / "step.obj", 0.0, 0.0)
    small = Body(radius_m=0.2, step_on_m=0.25, leg_length_m=0.6)
    assert find_path(grid, (1.5, 2.0, 0.0), (4.5, 2.0, RISE_M), small).status is PathStatus.NO_WAY
