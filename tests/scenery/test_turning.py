"""A turned scene is the same scene at another angle."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.scene.mesh_file import read_triangles
from esplanade.planning.scene.scene_file import read_scene
from esplanade.scenery.turning import turned_scene, write_turned
from tests.scenery.test_importing import make
from tests.scenery.worlds import loft, write_building

SCENES = Path(__file__).resolve().parents[2] / "scenes"


def points(part: Any) -> list[tuple[float, float]]:
    """All pairs of coordinates of a scene, without its bounds."""
    if isinstance(part, dict):
        return [point for key, value in part.items() if key != "bounds" for point in points(value)]
    if isinstance(part, list | tuple):
        if len(part) == 2 and isinstance(part[0], float):
            return [(part[0], part[1])]
        return [point for value in part for point in points(value)]
    return []


def full() -> Scene:
    """A scene with every kind of part."""
    return loft(
        doors=[{"name": "gate", "start": [3, 6], "end": [4.5, 6]}],
        walls=[{"start": [8, 0], "end": [8, 1], "offset_m": 3.0, "height_m": 1.1}],
    )


@pytest.mark.parametrize("degrees", [30.0, -17.5, 90.0, 200.0, 360.0])
def test_every_point_keeps_its_distance_from_every_other(degrees: float) -> None:
    before = points(full().model_dump(exclude={"origin_m"}))
    turned = turned_scene(full(), degrees)
    after = points(turned.model_dump(exclude={"origin_m"}))
    fence = 0 if degrees % 90.0 == 0.0 else 4
    assert len(turned.walls) == len(full().walls) + fence
    walls = [wall.model_dump() for wall in turned.walls[: len(full().walls)]]
    after = points({**turned.model_dump(), "walls": walls})
    one, other = np.array(before), np.array(after)
    assert one.shape == other.shape
    lengths = [np.linalg.norm(p[:, None] - p[None], axis=2) for p in (one, other)]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-5)


def test_turned_all_round_it_is_the_same() -> None:
    assert turned_scene(full(), 360.0) == full()
    back = turned_scene(turned_scene(full(), 90.0), -90.0)
    assert back.polygons == full().polygons


def test_a_turned_scene_has_the_same_floors() -> None:
    areas = []
    for scene in (full(), turned_scene(full(), 30.0)):
        grid = LayeredGrid.from_scene(scene, 0.1)
        upper = grid.layered.floors > 2.5
        areas.append(upper.sum() * 0.01)
    assert areas[1] == pytest.approx(areas[0], rel=0.03)


def test_a_mesh_is_turned_with_its_scene(tmp_path: Path) -> None:
    make(write_building(tmp_path), tmp_path / "house.json")
    scene = read_scene(tmp_path / "house.json")
    write_turned(scene, 30.0, tmp_path / "turned.json")
    turned = read_scene(tmp_path / "turned.json")
    assert scene.mesh is not None
    assert turned.mesh == tmp_path / "turned.glb"
    one, other = read_triangles(scene.mesh), read_triangles(turned.mesh)
    middle = np.array([5.0, 4.0])
    for place, before in zip(turned.places, scene.places, strict=True):
        away = np.subtract(place.position, middle) - 0.0
        assert np.hypot(*away) == pytest.approx(
            np.hypot(*np.subtract(before.position, middle)), abs=1e-4
        )
    assert np.hypot(*(one[..., :2] - middle).T) == pytest.approx(
        np.hypot(*(other[..., :2] - middle).T), abs=1e-4
    )


def test_the_gallery_is_shipped_turned_as_the_command_turns_it() -> None:
    shipped = read_scene(SCENES / "gallery_turned.json")
    assert shipped == turned_scene(read_scene(SCENES / "gallery.json"), 30.0).model_copy(
        update={"name": shipped.name}
    )
