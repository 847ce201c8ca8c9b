"""Tiles of cells: what is where, and that links lead both ways."""

import numpy as np
from hypothesis import given

from esplanade.planning import Scene
from esplanade.planning.ground.layered import cell_index, cell_near, cell_of
from esplanade.planning.ground.surfaces import surfaces_of_scene
from tests.planning.ground.test_surfaces import ODD_M, anyhow
from tests.planning.storeys import box
from tests.planning.worlds import holds


@holds(30, 3)
@given(anyhow())
def test_every_surface_is_found_in_its_cell(scene) -> None:
    surfaces = surfaces_of_scene(scene, ODD_M)
    arrays = surfaces.layered()
    cells = [
        cell_index(arrays, int(layer), int(j), int(i))
        for layer, j, i in zip(surfaces.layers, surfaces.rows, surfaces.columns, strict=True)
    ]
    assert len(set(cells)) == len(cells)
    assert min(cells) >= 0
    np.testing.assert_array_equal(arrays.floors[cells], surfaces.floors)
    np.testing.assert_array_equal(arrays.ceilings[cells], surfaces.ceilings)
    places = arrays.places[cells]
    np.testing.assert_array_equal(places["layer"], surfaces.layers)
    np.testing.assert_array_equal(places["row"], surfaces.rows)
    np.testing.assert_array_equal(places["column"], surfaces.columns)
    expected = np.where(surfaces.links >= 0, np.array(cells)[surfaces.links], -1)
    np.testing.assert_array_equal(arrays.links[cells], expected)
    holes = np.setdiff1d(np.arange(len(arrays.floors)), cells)
    assert np.isnan(arrays.floors[holes]).all()
    assert (arrays.links[holes] == -1).all()


@holds(30, 3)
@given(anyhow())
def test_links_lead_both_ways(scene) -> None:
    links = surfaces_of_scene(scene, ODD_M).layered().links
    for d in range(8):
        cells = np.flatnonzero(links[:, d] >= 0)
        np.testing.assert_array_equal(links[links[cells, d], (d + 4) % 8], cells)


def test_memory_grows_with_floors_not_with_the_box() -> None:
    slab = box(40, 40, 42, 42, 0.2, 3.0)
    ground = surfaces_of_scene(Scene(bounds=(0.0, 0.0, 64.0, 64.0))).layered()
    both = surfaces_of_scene(Scene(bounds=(0.0, 0.0, 64.0, 64.0), polygons=(slab,))).layered()
    assert both.pages.shape == (2, 32, 32)
    assert len(both.floors) - len(ground.floors) == 8 * 8


def test_points_have_cells() -> None:
    scene = Scene(bounds=(1.0, 2.0, 4.1, 5.0), polygons=(box(2, 3, 3, 4, 0.2, 2.8),))
    arrays = surfaces_of_scene(scene).layered()
    assert arrays.places[cell_of(arrays, 0, 1.0, 2.0)].tolist() == (0, 0, 0)
    assert arrays.places[cell_of(arrays, 0, 4.1, 5.0)].tolist() == (0, 11, 12)
    assert arrays.places[cell_of(arrays, 1, 2.3, 3.1)].tolist() == (1, 4, 5)
    for layer, x, y in ((0, 0.9, 3.0), (0, 2.0, 5.1), (1, 1.5, 2.5), (2, 2.5, 3.5), (-1, 2, 3)):
        assert cell_of(arrays, layer, x, y) == -1
    assert cell_index(arrays, 0, 12, 0) == -1
    assert arrays.places["layer"][cell_near(arrays, 2.5, 3.5, 1.4)] == 0
    assert arrays.places["layer"][cell_near(arrays, 2.5, 3.5, 1.6)] == 1
    assert arrays.places["layer"][cell_near(arrays, 1.5, 2.5, 9.0)] == 0
    assert cell_near(arrays, 9.0, 9.0, 0.0) == -1
