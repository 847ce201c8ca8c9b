from pathlib import Path

import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.planning import LayeredGrid, Polygon, Ramp, Scene, Stairs
from esplanade.planning.scene.scene_file import read_scene
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
