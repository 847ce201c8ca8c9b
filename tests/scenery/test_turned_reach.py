"""`scene check` on turned scenes: its answers are those of the plan, and of the unturned scene."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, Place, Scene, Spawn
from esplanade.scenery.reach import reach_of
from esplanade.scenery.turning import turned_scene
from tests.planning.turned import doorways, expected, flight, radii, turns
from tests.planning.worlds import holds
from tests.scenery.worlds import loft

Point3 = tuple[float, float, float]


def reaches(scene: Scene, start: Point3, goal: Point3, radius_m: float) -> bool:
    """Whether the check finds a way from a spawn to a place."""
    spawn = Spawn(position=start[:2], z_m=start[2], radius_m=0.0)
    place = Place(name="goal", position=goal[:2], z_m=goal[2])
    checked = scene.model_copy(update={"spawns": (spawn,), "places": (place,)})
    grid = LayeredGrid.from_scene(checked)
    return not reach_of(grid, checked, Body(radius_m=radius_m)).places_missed


@given(doorways())
@holds(120, 2)
def test_places_behind_doors_are_reached_as_the_plan_says(example) -> None:
    scene, obstacles, start, goal, radius_m = example
    way = expected(obstacles, start, goal, radius_m)
    assert reaches(scene, (*start, 0.0), (*goal, 0.0), radius_m) == way
    assert reaches(scene, (*goal, 0.0), (*start, 0.0), radius_m) == way


@given(turns, radii, st.sampled_from([-0.06, 0.1, 0.4]))
@holds(60, 1)
def test_places_upstairs_are_reached_if_the_flight_is_wide_enough(turned, radius_m, wider) -> None:
    scene = flight(turned, 2.0 * radius_m + wider)
    foot, top = (*turned.at(-2.5, 0.0), 0.0), (*turned.at(2.4, 0.0), 1.6)
    assert reaches(scene, foot, top, radius_m) == (wider > 0.0)
    assert reaches(scene, top, foot, radius_m) == (wider > 0.0)


@pytest.mark.parametrize("body", [Body.adult(), Body.child()], ids=["adult", "child"])
@given(degrees=st.integers(1, 359))
@holds(25, 1)
def test_a_turned_scene_has_the_places_that_it_had(body, degrees) -> None:
    scene = loft()
    turned = turned_scene(scene, degrees)
    before = reach_of(LayeredGrid.from_scene(scene), scene, body)
    after = reach_of(LayeredGrid.from_scene(turned), turned, body)
    assert after.places_missed == before.places_missed
    assert after.spawns_blocked == before.spawns_blocked
