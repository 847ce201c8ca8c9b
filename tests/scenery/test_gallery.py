"""The gallery: two floors on which all bodies reach all places but the children's den."""

import itertools
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import LayeredPath, PathStatus, find_path
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.scene_file import read_scene
from esplanade.scenery.inventory import take_inventory

FILE = Path(__file__).resolve().parents[2] / "scenes" / "gallery.json"
UPPER_M = 3.5


@cache
def gallery() -> Scene:
    return read_scene(FILE)


@cache
def grid() -> LayeredGrid:
    return LayeredGrid.from_scene(gallery(), 0.25)


def path_summary(start: str, goal: str, body: Body) -> LayeredPath:
    ends = [gallery().place(name) for name in (start, goal)]
    first, last = ((*end.position, end.z_m) for end in ends)
    return find_path(grid(), first, last, body=body)


def test_it_has_two_floors_and_everything_in_them() -> None:
    found = take_inventory(gallery(), 0.25)
    assert found.faults == ()
    assert len(found.layers) == 2
    assert found.reach["adult"].places_missed == ("children's den",)
    assert found.reach["child"].places_missed == ()
    assert {spawn.z_m for spawn in gallery().spawns} == {0.0, UPPER_M}
    assert len(gallery().doors) == 2


def test_an_adult_walks_between_all_other_places() -> None:
    names = [place.name for place in gallery().places if place.name != "children's den"]
    assert len(names) >= 12
    missed = [
        pair
        for pair in itertools.pairwise((*names, names[0]))
        if path_summary(*pair, Body.adult()).status is not PathStatus.FOUND
    ]
    assert missed == []


@pytest.mark.parametrize("body", [Body.adult(), Body.child()], ids=["adult", "child"])
def test_the_bridge_leads_over_the_passage(body: Body) -> None:
    path = path_summary("under the bridge", "bridge", body)
    assert path.status is PathStatus.FOUND
    assert path.length_m > 15.0
    assert np.allclose(path.points[[0, -1], :2], [20.0, 12.5])
    assert path.points[-1, 2] - path.points[0, 2] == pytest.approx(UPPER_M)


def test_bodies_that_cannot_climb_steps_take_the_ramp() -> None:
    wheels = Body(radius_m=0.35, height_m=1.4, step_on_m=0.04, leg_length_m=0.5)
    path = path_summary("forecourt", "terrace", wheels)
    assert path.status is PathStatus.FOUND
    rises = np.diff(path.points[:, 2])
    steps = np.hypot(*np.diff(path.points[:, :2], axis=0).T)
    assert (path.points[1:][rises > 0.01, 1] > 27.0).all()
    assert path.points[:, 2].max() == pytest.approx(UPPER_M, abs=0.01)
    assert steps[rises > 0.01].sum() > 25.0


def test_stairs_and_ramp_are_comfortable() -> None:
    for flight in gallery().stairs:
        length = float(np.hypot(*np.subtract(flight.end, flight.start)))
        assert (flight.top_m - flight.bottom_m) / flight.steps <= 0.19
        assert length / flight.steps == pytest.approx(0.30)
        assert flight.width_m == 2.0
    ramps = [polygon for polygon in gallery().polygons if polygon.ramp]
    assert len(ramps) == 2
    for polygon in ramps:
        assert polygon.ramp is not None
        length = float(np.hypot(*np.subtract(polygon.ramp.end, polygon.ramp.start)))
        assert (polygon.height_m - polygon.ramp.start_height_m) / length <= 1 / 8


def test_main_edges_lie_on_edges_of_cells() -> None:
    corners = [
        coordinate
        for polygon in gallery().polygons
        if polygon.kind in {"floor", "wall"}
        for point in polygon.points
        for coordinate in point
    ]
    assert np.allclose(np.array(corners) % 0.25, 0.0)
