"""Standing surfaces of scenes: against their naive twin, and the layers they are grouped in."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Place, Polygon, Ramp, Scene, Spawn, Stairs
from esplanade.planning.ground.surfaces import Surfaces, surfaces_of_scene
from tests.naive import surfaces as naive
from tests.planning.storeys import box
from tests.planning.worlds import holds

BOUNDS = (0.0, 0.0, 6.0, 5.0)
ODD_M = 0.29137
"""A cell whose centres lie on no edge, where either side would be right."""


def columns_of(surfaces: Surfaces) -> dict[tuple[int, int], naive.Column]:
    found: dict[tuple[int, int], naive.Column] = {
        (j, i): [] for j in range(surfaces.ny) for i in range(surfaces.nx)
    }
    for j, i, floor, ceiling in zip(
        surfaces.rows, surfaces.columns, surfaces.floors, surfaces.ceilings, strict=True
    ):
        found[int(j), int(i)].append((float(floor), float(ceiling)))
    return found


def _array(column: naive.Column) -> np.ndarray:
    return np.array(column).reshape(-1, 2)


def numbered(surfaces: Surfaces) -> list[tuple[int, int, int]]:
    """(row, column, number from below) of every surface."""
    names: list[tuple[int, int, int]] = []
    for j, i in zip(surfaces.rows.tolist(), surfaces.columns.tolist(), strict=True):
        number = names[-1][2] + 1 if names and names[-1][:2] == (j, i) else 0
        names.append((j, i, number))
    return names


def links_of(surfaces: Surfaces) -> set[tuple[tuple[int, int, int], int]]:
    names = numbered(surfaces)
    return {(names[s], d) for s, d in zip(*np.nonzero(surfaces.links >= 0), strict=True)}


@st.composite
def anyhow(draw) -> Scene:
    """Boxes, slabs, ramps and water over and in one another."""
    sixteenths = st.integers(0, 64).map(lambda v: v / 16)
    polygons = []
    for _ in range(draw(st.integers(0, 5))):
        x, y = draw(sixteenths), draw(sixteenths)
        w, d = draw(sixteenths) + 0.5, draw(sixteenths) + 0.5
        height = draw(st.sampled_from([0.125, 0.5, 1.0, 2.5]))
        ramp = Ramp(start=(x, y), end=(x + w, y)) if draw(st.booleans()) else None
        offset = draw(st.sampled_from([0.0, 0.0, 1.25, 2.0]))
        kind = draw(st.sampled_from(["floor", "building", "plant"]))
        ring = ((x, y), (x + w, y), (x + 0.75 * w, y + d), (x, y + d))
        polygons.append(
            Polygon(points=ring, height_m=height, offset_m=offset, ramp=ramp, kind=kind)
        )
    return Scene(bounds=BOUNDS, polygons=tuple(polygons))


@holds(60, 5)
@given(anyhow())
def test_surfaces_and_links_are_those_of_the_twin(scene) -> None:
    surfaces = surfaces_of_scene(scene, ODD_M)
    expected = naive.columns_of_scene(scene, ODD_M)
    found = columns_of(surfaces)
    assert found.keys() == expected.keys()
    for cell, column in expected.items():
        np.testing.assert_allclose(_array(found[cell]), _array(column), atol=1e-4)
    assert links_of(surfaces) == naive.links(found)


@holds(30, 3)
@given(anyhow())
def test_no_layer_overlaps_itself(scene) -> None:
    surfaces = surfaces_of_scene(scene, ODD_M)
    keys = set(zip(surfaces.layers, surfaces.rows, surfaces.columns, strict=True))
    assert len(keys) == len(surfaces)
    assert set(surfaces.layers.tolist()) <= set(range(surfaces.layer_count))


def test_slabs_are_layers_in_order_of_height() -> None:
    slabs = [box(1, 1, 4, 4, 0.2, offset) for offset in (5.8, 2.8)]
    surfaces = surfaces_of_scene(Scene(bounds=BOUNDS, polygons=tuple(slabs)))
    assert surfaces.layer_count == 3
    for layer, height in enumerate((0.0, 3.0, 6.0)):
        assert set(surfaces.floors[surfaces.layers == layer].tolist()) == {height}
    below = (surfaces.layers == 1) & (surfaces.floors == 3.0)
    assert surfaces.ceilings[below] == pytest.approx(5.8)


def test_what_stands_on_the_ground_belongs_to_it() -> None:
    seat = box(1, 1, 2, 2, 0.05, 0.4)
    surfaces = surfaces_of_scene(Scene(bounds=BOUNDS, polygons=(seat,)))
    assert surfaces.layer_count == 1
    assert surfaces.floors.max() == pytest.approx(0.45)


def test_stairs_lead_from_layer_to_layer() -> None:
    slab = box(3, 0, 6, 5, 0.2, 1.8)
    stairs = Stairs(start=(0.5, 2.5), end=(3.0, 2.5), width_m=1.5, top_m=2.0, steps=8)
    scene = Scene(bounds=BOUNDS, polygons=(slab,), stairs=(stairs,))
    surfaces = surfaces_of_scene(scene)
    assert surfaces.layer_count == 2
    upper = np.flatnonzero(surfaces.layers == 1)
    lower = surfaces.links[upper]
    down = lower[(lower >= 0) & (surfaces.layers[lower] == 0)]
    assert len(down)
    assert surfaces.floors[down] == pytest.approx(2.0)
    assert all(1.5 <= (row + 0.5) * 0.25 <= 3.5 for row in surfaces.rows[down])


def test_a_ramp_rises_evenly_between_its_ends() -> None:
    ramp = Ramp(start=(1.0, 0.0), end=(5.0, 0.0), start_height_m=0.4)
    top = box(0, 0, 6, 5, 2.0).model_copy(update={"ramp": ramp})
    surfaces = surfaces_of_scene(Scene(bounds=BOUNDS, polygons=(top,)))
    x = (surfaces.columns + 0.5) * 0.25
    assert surfaces.floors == pytest.approx(0.4 + 1.6 * np.clip((x - 1.0) / 4.0, 0.0, 1.0))


def test_roofs_go_if_someone_comes_from_somewhere() -> None:
    house = box(1, 1, 3, 3, 3.0)
    bare = Scene(bounds=BOUNDS, polygons=(house,))
    assert surfaces_of_scene(bare).floors.max() == 3.0
    peopled = bare.model_copy(update={"spawns": (Spawn(position=(5.0, 4.0)),)})
    surfaces = surfaces_of_scene(peopled)
    assert surfaces.floors.max() == 0.0
    assert (surfaces.links < len(surfaces)).all()
    assert links_of(surfaces) == naive.links(columns_of(surfaces))
    on_top = Place(name="roof", position=(2.0, 2.0), z_m=3.0)
    assert surfaces_of_scene(peopled.model_copy(update={"places": (on_top,)})).floors.max() == 3.0


def test_a_spawn_over_a_hole_counts_for_the_floor_nearest_to_it() -> None:
    pond = box(1, 1, 3, 3, 0.2).model_copy(update={"kind": "water"})
    scene = Scene(bounds=BOUNDS, polygons=(pond,), spawns=(Spawn(position=(2.0, 2.0)),))
    surfaces = surfaces_of_scene(scene)
    assert len(surfaces) == 20 * 24 - 8 * 8
    assert set(surfaces.floors.tolist()) == {0.0}


def test_low_passages_are_floors_only_for_someone() -> None:
    for offset, floors in ((0.9, {1.1}), (1.1, {0.0, 1.3})):
        scene = Scene(bounds=(0.0, 0.0, 2.0, 2.0), polygons=(box(0, 0, 2, 2, 0.2, offset),))
        found = {round(float(z), 3) for z in surfaces_of_scene(scene).floors}
        assert found == floors


@pytest.mark.parametrize("cell_m", [0.01, 3.0, math.nan])
def test_cells_have_a_size(cell_m) -> None:
    with pytest.raises(ValueError, match="cell_m must lie between"):
        surfaces_of_scene(Scene(bounds=BOUNDS), cell_m)


def test_cells_so_small_that_they_are_too_many_are_refused() -> None:
    with pytest.raises(
        ValueError, match=r"cell_m must be 0.098 m or more over 640 x 640 m, got 0.05"
    ):
        surfaces_of_scene(Scene(bounds=(0.0, 0.0, 640.0, 640.0)), 0.05)
