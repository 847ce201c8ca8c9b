"""Lines of sight that others allow, held against the distances of shapely."""

import numpy as np
from shapely import LineString, MultiLineString, Point

from esplanade.planning.grid._grid_kernels import spread_allowed
from esplanade.planning.routes._potential_kernels import spread_beside
from tests.planning.worlds import open_grid, scaled

SIDE_M = 10.0
RADIUS_M = 0.25
CLOSE_M = 1e-5
"""Distances of cells are kept in single precision."""


def test_a_line_that_another_allows_is_clear() -> None:
    random = np.random.default_rng(5)
    allowed = 0
    for _ in range(scaled(30, 6)):
        ends = random.uniform(0.5, SIDE_M - 0.5, (4, 2, 2))
        barriers = MultiLineString(list(ends))
        grid = open_grid(SIDE_M, [(tuple(a), tuple(b)) for a, b in ends.tolist()])
        places, waypoints = random.uniform(0.5, SIDE_M - 0.5, (2, 400, 2))
        cells = grid.on_ground(places, np.zeros(len(places)))[1].tolist()
        besides = places + random.uniform(-0.5, 0.5, (400, 2))
        for cell, place, waypoint, beside in zip(
            cells, places.tolist(), waypoints.tolist(), besides.tolist(), strict=True
        ):
            spread = spread_allowed(grid.arrays, 0, cell, *place, *waypoint, RADIUS_M)
            room_m = barriers.distance(Point(place)) - RADIUS_M
            if spread >= 0.0 and spread_beside(spread, room_m, *place, *waypoint, *beside) >= 0.0:
                allowed += 1
                room_m = barriers.distance(LineString([beside, waypoint]))
                assert room_m >= RADIUS_M - CLOSE_M
    assert allowed >= scaled(2000, 300)


def test_in_the_open_a_line_allows_those_beside_it_and_near_a_wall_none() -> None:
    grid = open_grid(SIDE_M, [((0.0, 8.0), (SIDE_M, 8.0))])
    far, waypoint, near = (2.0, 2.0), (8.0, 4.0), (2.0, 7.75)
    cells = grid.on_ground(np.array([far, near]), np.zeros(2))[1].tolist()
    assert spread_allowed(grid.arrays, 0, cells[0], *far, *waypoint, RADIUS_M) > 0.1
    assert spread_allowed(grid.arrays, 0, cells[1], *near, 8.0, 7.75, RADIUS_M) < 0.02
    assert spread_allowed(grid.arrays, 0, cells[0], *far, 8.0, 9.0, RADIUS_M) < 0.0
