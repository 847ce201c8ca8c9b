"""Clearances of kinds of body, in boxes and over all."""

from dataclasses import replace

import numpy as np
import pytest

from esplanade.planning import Body, LayeredGrid, Wall
from esplanade.planning.grid.clearances import (
    cells_within,
    centres_of,
    kind_of,
    write_clearance,
)
from tests.naive.geometry import point_segment_distance
from tests.planning.storeys import grid_of, storeyed

ADULT = Body.adult()


def test_a_kind_is_no_thinner_and_no_shorter_than_its_bodies() -> None:
    for radius_m, height_m in ((0.21, 1.76), (0.249, 1.801), (0.25, 1.8), (0.3, 1.3)):
        kind = kind_of(replace(ADULT, radius_m=radius_m, height_m=height_m, edge_cells=5))
        assert 0.0 <= kind.radius_m - radius_m + 1e-9 < 0.05 + 1e-9
        assert 0.0 <= kind.height_m - height_m + 1e-9 < 0.05 + 1e-9
        assert kind_of(kind) == kind
    assert kind_of(ADULT) == ADULT


@pytest.mark.parametrize(
    "box", [(1.1, 2.0, 4.3, 3.9), (-5.0, 1.0, 0.6, 90.0), (-3.0, -3.0, -1.0, 0.0)]
)
def test_cells_within_a_box_are_those_with_their_centre_in_it(box) -> None:
    grid = LayeredGrid.from_scene(storeyed())
    x, y = centres_of(grid.layered, grid.layered.places).T
    inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
    found = cells_within(grid.layered, box)
    assert sorted(found.tolist()) == np.flatnonzero(inside).tolist()


def test_clearance_is_the_distance_to_what_stops_in_a_box_as_over_all() -> None:
    walls = [((2.0, 1.0), (2.0, 4.0)), ((5.0, 6.0), (7.5, 3.0))]
    grid = grid_of(8.0, walls=[Wall(start=a, end=b) for a, b in walls])
    expected = [
        min(3.0, *(point_segment_distance(centre, a, b) for a, b in walls))
        for centre in centres_of(grid.layered, grid.layered.places).tolist()
    ]
    out = np.empty(len(expected), dtype=np.float32)
    everywhere = np.arange(len(expected))
    write_clearance(grid.arrays, grid.index, ADULT, grid.bounds, everywhere, out)
    assert out == pytest.approx(expected, abs=1e-5)
    box = (1.0, 1.0, 6.0, 5.0)
    cells = cells_within(grid.layered, box)
    out[cells] = -7.0
    write_clearance(grid.arrays, grid.index, ADULT, box, cells, out)
    assert out == pytest.approx(expected, abs=1e-5)
