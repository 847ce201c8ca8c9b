"""Reachability: a den for children, rooms without an entrance, spawns without room."""

import pytest

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.scene.bodies import Body
from esplanade.scenery.reach import cell_near, largest_region, reach_of
from tests.scenery.worlds import LOFT, loft


def grid_of(scene: Scene) -> LayeredGrid:
    return LayeredGrid.from_scene(scene, 0.25)


def test_an_adult_gets_everywhere_but_into_the_den() -> None:
    scene = loft()
    reach = reach_of(grid_of(scene), scene, Body.adult())
    assert reach.places_missed == ("den",)
    assert reach.spawns_blocked == ()
    assert 0.6 < reach.standing < 0.95
    assert 0.7 < reach.reached < 0.95


def test_a_child_gets_everywhere() -> None:
    scene = loft()
    reach = reach_of(grid_of(scene), scene, Body.child())
    assert reach.places_missed == ()
    assert reach.reached == pytest.approx(1.0, abs=0.01)


def test_high_steps_are_for_long_legs() -> None:
    scene = loft(stairs=[{**LOFT["stairs"][0], "steps": 7}])
    grid = grid_of(scene)
    assert "loft" in reach_of(grid, scene, Body.child()).places_missed
    assert "loft" not in reach_of(grid, scene, Body.adult()).places_missed


def test_a_spawn_in_a_wall_is_blocked() -> None:
    scene = loft(spawns=[{"position": [6, 6.25], "radius_m": 0}, {"position": [1, 2]}])
    reach = reach_of(grid_of(scene), scene, Body.adult())
    assert reach.spawns_blocked == ("spawns.0",)
    assert reach.places_missed == ("den",)


def test_with_all_spawns_blocked_nothing_is_reached() -> None:
    scene = loft(spawns=[{"position": [6, 6.25], "radius_m": 0}])
    reach = reach_of(grid_of(scene), scene, Body.adult())
    assert reach.reached == 0.0
    assert reach.places_missed == ("loft", "below", "den")


def test_without_spawns_one_begins_in_the_largest_region() -> None:
    scene = loft(spawns=[])
    reach = reach_of(grid_of(scene), scene, Body.adult())
    assert reach.places_missed == ("den",)
    assert reach.reached > 0.7


def test_the_largest_region_hangs_together_and_is_the_largest() -> None:
    scene = Scene(bounds=(0, 0, 10, 4), polygons=(), walls=({"start": (7, 0), "end": (7, 4)},))  # type: ignore[arg-type]
    grid = grid_of(scene)
    region = largest_region(grid.traversability.of(Body.adult()))
    columns = grid.layered.places["column"][region]
    assert columns.max() < 7 / 0.25
    assert 0.9 < region.sum() / (16 * 28) <= 1.0


def test_a_point_means_the_floor_that_is_near() -> None:
    grid = grid_of(loft())
    traversability = grid.traversability.of(Body.adult())
    upper, lower = (cell_near(traversability, (10.0, 4.0, z), 0.5) for z in (3.4, 0.3))
    assert grid.layered.floors[upper] == pytest.approx(3.0)
    assert grid.layered.floors[lower] == 0.0
    assert cell_near(traversability, (10.0, 4.0, 1.5), 0.5) == -1
    above, below = grid.layered.places[[upper, lower]].tolist()
    assert above[1:] == below[1:]
