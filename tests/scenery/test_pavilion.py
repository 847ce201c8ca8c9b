"""The pavilion: a world of a mesh, two floors around a stair that winds over itself."""

import itertools
import runpy
from functools import cache
from pathlib import Path

import pytest

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import PathStatus, find_path
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.scene_file import read_scene
from esplanade.scenery.inventory import take_inventory

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "scenes" / "pavilion.json"


@cache
def scene() -> Scene:
    return read_scene(FILE)


@cache
def grid() -> LayeredGrid:
    return LayeredGrid.from_scene(scene())


def test_the_mesh_is_the_one_that_the_tool_builds() -> None:
    tool = runpy.run_path(str(ROOT / "tools" / "build_pavilion.py"))
    assert scene().mesh == tool["OUT"]
    assert tool["OUT"].read_text() == tool["pavilion"]().text()


def test_everyone_gets_everywhere() -> None:
    found = take_inventory(scene(), 0.25)
    assert found.faults == ()
    assert [reach.places_missed for reach in found.reach.values()] == [(), ()]


def test_it_has_two_storeys() -> None:
    starts = [(*spawn.position, spawn.z_m) for spawn in scene().spawns]
    assert storeys_of(grid(), reached_from(grid(), starts)) == pytest.approx((0.3, 3.8))


@pytest.mark.parametrize("body", [Body.adult(), Body.child()], ids=["adult", "child"])
def test_the_spiral_stair_leads_from_floor_to_floor(body: Body) -> None:
    places = [scene().place(name) for name in ("under the stair", "north balcony", "terrace")]
    ends = [(*place.position, place.z_m) for place in places]
    for start, goal in itertools.pairwise(ends):
        path = find_path(grid(), start, goal, body=body)
        assert path.status is PathStatus.FOUND
        assert abs(path.points[0, 2] - path.points[-1, 2]) == pytest.approx(3.5, abs=0.01)
        assert path.length_m > 10.0
