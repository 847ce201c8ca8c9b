from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.actors.locomotion.footsteps.ground import Ground, solid_arrays
from esplanade.planning import LayeredGrid, Polygon, Ramp, Scene, Stairs
from esplanade.planning.scene.scene_file import read_scene
from tests.naive.footsteps.ground import Ground as NaiveGround
from tests.server.worlds import write_mesh_world

BOUNDS = (-5.0, -5.0, 10.0, 10.0)
FLIGHT = Stairs(start=(0.0, 0.0), end=(3.0, 0.0), width_m=2.0, top_m=1.75, steps=10)
FOOT = np.array([0.18])


def ground(*, polygons: tuple[Polygon, ...] = (), stairs: tuple[Stairs, ...] = ()) -> Ground:
    scene = Scene(name="ground", bounds=BOUNDS, polygons=polygons, stairs=stairs)
    return Ground(scene, LayeredGrid.from_scene(scene))


def box(x0: float, x1: float, **rest: object) -> Polygon:
    return Polygon(points=((x0, -1.0), (x1, -1.0), (x1, 1.0), (x0, 1.0)), **rest)  # type: ignore[arg-type]


def height(of: Ground, x: float, near_m: float, y: float = 0.0) -> float:
    return float(of.height(np.array([[x, y]]), np.array([near_m]))[0])


def settled(of: Ground, x: float, z: float, heading: float = 0.0) -> tuple[list[float], bool]:
    footprints, found = of.settle(np.array([[x, 0.3, z, heading]]), FOOT)
    return footprints[0].tolist(), bool(found[0])


def test_level_ground_is_not_looked_at() -> None:
    flat = ground()
    assert flat.flat
    assert height(flat, 3.0, 7.0) == 0.0
    assert settled(flat, 3.0, 7.0) == ([3.0, 0.3, 0.0, 0.0], True)


@pytest.mark.parametrize("tread", range(10))
def test_treads_are_exact(tread: int) -> None:
    flight = ground(stairs=(FLIGHT,))
    for inside in (0.001, 0.15, 0.299):
        found = height(flight, 0.3 * tread + inside, 0.175 * tread)
        assert found == pytest.approx(0.175 * (tread + 1))
    assert height(flight, -0.001, 0.1) == 0.0
    assert height(flight, 0.1, 0.1, y=1.01) == 0.0


@pytest.mark.parametrize("shift", np.linspace(0.013, 0.287, 8))
@pytest.mark.parametrize("heading", [0.0, np.pi])
def test_feet_come_to_lie_on_one_tread(shift: float, heading: float) -> None:
    flight = ground(stairs=(FLIGHT,))
    (x, _, z, _), found = settled(flight, 1.2 + shift, 0.8, heading)
    assert found
    assert abs(x - 1.2 - shift) <= 0.2 + 1e-9
    ends = np.array([x, x + 0.85 * 0.18 * np.cos(heading)])
    np.testing.assert_allclose(np.floor(ends / 0.3 + 1e-9) * 0.175 + 0.175, z, atol=1e-9)


def test_of_floors_above_one_another_the_near_one_counts() -> None:
    gallery = ground(polygons=(box(0.0, 4.0, offset_m=2.5, height_m=0.3, kind="floor"),))
    assert height(gallery, 2.0, 0.2) == 0.0
    assert height(gallery, 2.0, 2.7) == pytest.approx(2.8)
    assert np.isnan(height(gallery, 2.0, 1.4))


def test_ramps_rise_and_feet_lie_on_their_middle() -> None:
    slope = box(0.0, 4.0, height_m=0.4, kind="floor", ramp=Ramp(start=(0.0, 0.0), end=(4.0, 0.0)))
    up = ground(polygons=(slope,))
    assert height(up, 1.0, 0.2) == pytest.approx(0.1)
    (_, _, z, _), found = settled(up, 1.0, 0.1)
    assert found
    assert z == pytest.approx(0.1 + 0.5 * 0.85 * 0.018)


def test_there_is_no_ground_in_walls_and_over_edges() -> None:
    scene = ground(
        polygons=(
            box(0.0, 1.0, height_m=2.0, kind="wall"),
            box(3.0, 4.0, height_m=1.5, kind="floor"),
        )
    )
    assert np.isnan(height(scene, 0.5, 0.0))
    assert np.isnan(height(scene, 2.5, 1.5))
    assert height(scene, 3.5, 1.3) == pytest.approx(1.5)
    assert settled(scene, 0.5, 0.0) == ([0.5, 0.3, 0.0, 0.0], False)


def test_of_meshes_the_cells_are_known(tmp_path: Path) -> None:
    scene = read_scene(write_mesh_world(tmp_path))
    house = Ground(scene, LayeredGrid.from_scene(scene))
    assert height(house, 2.0, 0.1, y=-5.0) == pytest.approx(0.0, abs=1e-3)
    assert height(house, 8.0, 2.9, y=-5.0) == pytest.approx(3.0, abs=1e-3)
    assert np.isnan(height(house, 8.0, 1.5, y=-5.0))


def some_scene(random: np.random.Generator) -> Scene:
    """Flights of stairs, slabs, walls and ramps at all angles, in and over one another."""
    polygons = []
    for kind in random.choice(["floor", "building", "wall", "furniture"], 25):
        x, y, angle = random.uniform(0.0, 10.0), random.uniform(0.0, 10.0), random.uniform(0.0, 6.3)
        turns = angle + np.sort(random.uniform(0.0, 2.0 * np.pi, random.integers(3, 8)))
        ring = np.stack([x + 1.5 * np.cos(turns), y + 1.5 * np.sin(turns)], axis=1).clip(0.0, 10.0)
        if len(np.unique(ring, axis=0)) < len(ring):
            continue
        height_m = float(random.uniform(0.05, 1.5))
        start, end = ((x, y), (x + 0.7, y + 0.4))
        ramp = Ramp(start=start, end=end) if random.random() < 0.3 else None
        polygons.append(
            Polygon.model_construct(
                points=tuple(map(tuple, ring.tolist())),
                height_m=height_m,
                offset_m=float(random.choice([0.0, 0.0, 0.8])),
                ramp=ramp,
                kind=str(kind),
            )
        )
    flight = Stairs(start=(2.0, 2.0), end=(5.0, 4.0), width_m=2.0, top_m=1.75, steps=10)
    return Scene.model_construct(
        name="heap", bounds=(0.0, 0.0, 10.0, 10.0), polygons=tuple(polygons), stairs=(flight,),
        mesh=None,
    )  # fmt: skip


@given(st.integers(0, 2**32 - 1))
def test_heights_and_settled_feet_are_those_of_the_plain_twin(seed: int) -> None:
    random = np.random.default_rng(seed)
    scene = some_scene(random)
    grid = LayeredGrid.from_scene(Scene(bounds=scene.bounds, stairs=scene.stairs))
    here, plain = Ground(scene, grid), NaiveGround(scene, grid)
    points = random.uniform(-1.0, 11.0, (200, 2))
    near_m = random.uniform(-0.5, 2.0, 200)
    np.testing.assert_array_equal(here.height(points, near_m), plain.height(points, near_m))
    feet = np.column_stack([points, near_m, random.uniform(-9.0, 9.0, 200)])
    foot_m = random.uniform(0.15, 0.2, 200)
    footprints, found = here.settle(feet, foot_m)
    expected, there = plain.settle(feet, foot_m)
    np.testing.assert_array_equal(found, there)
    np.testing.assert_allclose(footprints, expected, atol=1e-9)


def test_cells_are_those_of_the_plain_twin(tmp_path: Path) -> None:
    scene = read_scene(write_mesh_world(tmp_path))
    grid = LayeredGrid.from_scene(scene)
    random = np.random.default_rng(3)
    points = np.column_stack([random.uniform(-1.0, 11.0, 500), random.uniform(-11.0, 1.0, 500)])
    near_m = random.uniform(-0.5, 3.5, 500)
    found = Ground(scene, grid).height(points, near_m)
    assert np.isfinite(found).any()
    np.testing.assert_array_equal(found, NaiveGround(scene, grid).height(points, near_m))


def test_many_large_solids_are_indexed_in_bounded_memory() -> None:
    sizes = np.linspace(50.0, 400.0, 3000)
    slabs = [box(-size, size, height_m=0.1, kind="floor") for size in sizes.tolist()]
    wide = [
        slab.model_copy(update={"points": tuple((x, 100.0 * y) for x, y in slab.points)})
        for slab in slabs
    ]
    solids = ground().arrays.solids
    assert solids.most == 0
    index = solid_arrays(wide)
    assert len(index.members) <= 1 << 22
    assert len(index.first) <= (1 << 17) + 1
    assert index.most == 3000
