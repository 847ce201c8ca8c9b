"""A real house, imported with the default options, can be walked at once."""

import os
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.planning import LayeredGrid
from esplanade.planning.routes.find_path import PathStatus, find_path
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from esplanade.planning.scene.scene_file import read_scene

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
HOUSE = Path(os.environ.get("ESPLANADE_RECORDINGS", DATA)) / "meshes" / "duplex.obj"


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if not HOUSE.is_file():
        pytest.skip("the house meshes/duplex.obj is absent; set ESPLANADE_RECORDINGS to its folder")
    target = tmp_path_factory.mktemp("worlds") / "duplex.json"
    assert main(["scene", "import", str(HOUSE), "--out", str(target)]) == 0
    return target


def test_both_floors_of_one_flat_are_found_and_named(imported: Path) -> None:
    scene = read_scene(imported)
    names = [place.name for place in scene.places]
    assert len(set(names)) == len(names) == 8
    assert any(name.startswith("ground floor, ") for name in names)
    assert any(name.startswith("floor 1, ") for name in names)
    (spawn,) = scene.spawns
    grid = LayeredGrid.from_scene(scene)
    reached = reached_from(grid, [(*spawn.position, spawn.z_m)])
    assert storeys_of(grid, reached) == pytest.approx((0.02, 3.12), abs=0.01)


def test_from_the_spawn_there_is_a_way_to_every_place(imported: Path) -> None:
    scene = read_scene(imported)
    grid = LayeredGrid.from_scene(scene)
    (spawn,) = scene.spawns
    start = (*spawn.position, spawn.z_m)
    found = [find_path(grid, start, (*place.position, place.z_m)) for place in scene.places]
    assert {path.status for path in found} == {PathStatus.FOUND}


def test_it_passes_the_check(imported: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scene", "check", str(imported)]) == 0
    assert "8 places" in capsys.readouterr().out
