"""Scenes made of meshes can be read and walked, whatever the axes and units of the file."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.commandline.errors import UsageError
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import PathStatus, find_path
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.scene_file import read_scene
from esplanade.scenery.importing import import_mesh
from tests.scenery.worlds import write_building

Told = list[tuple[str, float]]


def make(source: Path, target: Path, reports: Told | None = None, **changes: Any) -> Scene:
    options: dict[str, Any] = {
        "up": "y",
        "metres_a_unit": 1.0,
        "cell_m": 0.25,
        "name": None,
        "spawn": None,
        "places": 6,
        "report": lambda activity, share: (reports if reports is not None else []).append(
            (activity, share)
        ),
    }
    return import_mesh(source, target, **{**options, **changes}).scene


def test_a_mesh_becomes_a_world_of_two_floors(tmp_path: Path) -> None:
    reports: Told = []
    target = tmp_path / "house.json"
    make(write_building(tmp_path), target, reports, name="House")
    scene = read_scene(target)
    assert scene.name == "House"
    assert scene.mesh == tmp_path / "house.glb"
    assert scene.bounds == (0.0, 0.0, 10.0, 8.0)
    assert len(scene.places) == 6
    assert {round(place.z_m, 1) for place in scene.places} >= {0.0, 2.4}
    shares = [share for _, share in reports]
    assert shares == sorted(shares)
    assert shares[-1] < 1.0


def test_every_place_can_be_walked_to(tmp_path: Path) -> None:
    target = tmp_path / "house.json"
    make(write_building(tmp_path), target)
    scene = read_scene(target)
    grid = LayeredGrid.from_scene(scene, 0.25)
    (spawn,) = scene.spawns
    for place in scene.places:
        start, goal = (*spawn.position, spawn.z_m), (*place.position, place.z_m)
        assert find_path(grid, start, goal, body=Body.adult()).status is PathStatus.FOUND


def test_z_up_makes_the_same_world(tmp_path: Path) -> None:
    worlds = []
    for up in ("y", "z"):
        target = tmp_path / f"{up}.json"
        worlds.append(make(write_building(tmp_path, z_up=up == "z"), target, up=up, name="same"))
    first, second = (json.loads((tmp_path / f"{up}.json").read_text()) for up in ("y", "z"))
    assert first.pop("mesh") == "y.glb"
    assert second.pop("mesh") == "z.glb"
    assert first == second


def test_units_can_be_scaled(tmp_path: Path) -> None:
    scene = make(write_building(tmp_path), tmp_path / "big.json", metres_a_unit=1.5)
    assert scene.bounds == (0.0, 0.0, 15.0, 12.0)


def test_the_spawn_that_is_asked_for_is_taken(tmp_path: Path) -> None:
    scene = make(write_building(tmp_path), tmp_path / "a.json", spawn=(9.0, 7.0, 2.4), places=0)
    assert np.hypot(*np.subtract(scene.spawns[0].position, (9.0, 7.0))) < 0.25
    assert scene.spawns[0].z_m == pytest.approx(2.4)
    assert scene.places == ()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"spawn": (9.0, 7.0, 9.0)}, "--spawn: an adult cannot stand there"),
        ({"metres_a_unit": 1000.0}, "--up and --scale"),
    ],
)
def test_impossible_imports_are_refused_and_leave_no_files(
    tmp_path: Path, changes: dict[str, Any], message: str
) -> None:
    target = tmp_path / "house.json"
    with pytest.raises(UsageError, match=message):
        make(write_building(tmp_path), target, **changes)
    assert not target.exists()
    assert not target.with_suffix(".glb").exists()


@pytest.mark.parametrize("text", ["", "nonsense\n", "v 1 2 3\nf 1 2 9\n"])
def test_broken_meshes_are_refused(tmp_path: Path, text: str) -> None:
    source = tmp_path / "broken.obj"
    source.write_text(text)
    with pytest.raises(UsageError, match=r"broken|house"):
        make(source, tmp_path / "house.json")


def test_names_in_a_mesh_may_be_in_any_encoding(tmp_path: Path) -> None:
    source = tmp_path / "house.obj"
    source.write_bytes(b"o caf\xe9\n" + write_building(tmp_path).read_bytes())
    assert make(source, tmp_path / "cafe.json").spawns


def test_a_mesh_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"none\.obj"):
        make(tmp_path / "none.obj", tmp_path / "house.json")


def test_a_mesh_far_away_is_moved_and_the_scene_says_by_how_much(tmp_path: Path) -> None:
    source = tmp_path / "utm.obj"
    lines = []
    for line in write_building(tmp_path).read_text().splitlines():
        if line.startswith("v "):
            x, y, z = map(float, line.split()[1:])
            line = f"v {x + 411_000.5} {y + 90.0} {z - 5_650_000.0}"  # noqa: PLW2901
        lines.append(line)
    source.write_text("\n".join(lines))
    target = tmp_path / "utm.json"
    with pytest.raises(UsageError, match=r"utm\.obj: it lies .*--recentre"):
        make(source, target)
    made = make(source, target, recentre=True)
    assert made.origin_m == (411_006.0, 5_650_004.0, 90.0)
    read = read_scene(target)
    assert read.origin_m == made.origin_m
    assert read.places == made.places


def test_a_mesh_is_not_written_over_by_another_form_of_it(tmp_path: Path) -> None:
    make(write_building(tmp_path), tmp_path / "house.json")
    kept = tmp_path / "house.glb"
    before = kept.read_bytes()
    with pytest.raises(UsageError, match="written over"):
        make(kept, tmp_path / "house.json", up="z")
    assert kept.read_bytes() == before
    make(kept, tmp_path / "house.json")
    assert read_scene(tmp_path / "house.json").places
