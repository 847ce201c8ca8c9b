"""Storeys are counted where ground lies above ground."""

import numpy as np
import pytest

from esplanade.planning import Body, LayeredGrid, Polygon, Scene
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from tests.planning.storeys import box, storeyed
from tests.planning.worlds import UPPER_M

START = (1.0, 1.0, 0.0)


def floor(x0: float, y0: float, x1: float, y1: float, offset_m: float) -> Polygon:
    slab = box(x0, y0, x1, y1, 0.2, offset_m=offset_m)
    return slab.model_copy(update={"kind": "floor"})


def test_a_floor_above_the_ground_is_a_storey() -> None:
    grid = LayeredGrid.from_scene(storeyed())
    assert storeys_of(grid, reached_from(grid, [START])) == pytest.approx((0.0, UPPER_M))


def test_ground_without_any_above_it_is_one_storey_however_it_rises() -> None:
    terraces = [
        box(5.0 * k, 0.0, 5.0 * k + 5.0, 12.0, 2.0 * k).model_copy(update={"kind": "floor"})
        for k in (1, 2)
    ]
    grid = LayeredGrid.from_scene(Scene(bounds=(0.0, 0.0, 15.0, 12.0), polygons=tuple(terraces)))
    everywhere = np.isfinite(grid.layered.floors)
    assert storeys_of(grid, everywhere) == pytest.approx((2.0,))


def test_a_landing_is_no_storey() -> None:
    grid = LayeredGrid.from_scene(storeyed(polygons=[floor(1.0, 9.0, 3.0, 11.0, 5.8)]))
    everywhere = np.isfinite(grid.layered.floors)
    assert storeys_of(grid, everywhere) == pytest.approx((0.0, UPPER_M))


def test_what_nobody_gets_to_is_no_storey() -> None:
    roofed = storeyed(polygons=[floor(8.0, 0.0, 16.0, 12.0, 6.0)])
    grid = LayeredGrid.from_scene(roofed.model_copy(update={"stairs": ()}))
    reached = reached_from(grid, [START], Body.child())
    assert storeys_of(grid, reached) == pytest.approx((0.0,))
    assert storeys_of(grid, np.zeros_like(reached)) == (0.0,)


def test_without_a_place_to_start_from_all_ground_counts() -> None:
    grid = LayeredGrid.from_scene(storeyed())
    assert reached_from(grid, []).all()
