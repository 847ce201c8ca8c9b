"""What is drawn of a scene: each layer as one body finds it, and a path between two points."""

import numpy as np
import pytest

from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal.stability import Stability
from esplanade.scenery.pictures import LayerView
from esplanade.scenery.values import Where
from esplanade.scenery.views import layer_views
from tests.scenery.worlds import loft


def views(
    start: Where | None = None, goal: Where | None = None, body: Body | None = None, **changes
) -> list[LayerView]:
    return layer_views(loft(**changes), 0.25, body or Body.adult(), start, goal)


def test_every_layer_has_its_floors_and_names() -> None:
    lower, upper = views()
    assert lower.floors.shape == upper.floors.shape == (32, 48)
    assert lower.floors[16, 4] == 0.0
    assert upper.floors[16, 40] == pytest.approx(3.0)
    assert np.isnan(upper.floors[16, 4])
    assert {mark.name for mark in lower.marks} == {"spawn 0", "below", "den"}
    assert {mark.name for mark in upper.marks} == {"loft"}


def test_what_does_not_exist_is_told_from_what_is_not_reached() -> None:
    lower, upper = views()
    den = (29, 14)
    assert not lower.reachable[den]
    assert lower.classes[den] == Stability.STABLE
    assert np.isinf(lower.distance[den])
    assert upper.classes[16, 4] == -1
    assert np.isnan(upper.distance[16, 4])


def test_the_path_goes_from_the_spawn_to_the_farthest_place() -> None:
    lower, upper = views()
    assert lower.path[0] == pytest.approx((1.0, 2.0))
    assert lower.path[-1] == pytest.approx((10.0, 4.0))
    assert lower.path_layers[0] == 0
    assert lower.path_layers[-1] == 1
    assert lower.way.endswith(" m")
    assert upper.distance[16, 40] < 0.5
    assert np.array_equal(lower.path, upper.path)


def test_the_ends_are_places_or_points() -> None:
    lower, _ = views("below", (2.0, 4.0, 0.0))
    assert lower.path[0] == pytest.approx((10.0, 4.0))
    assert lower.path[-1] == pytest.approx((2.0, 4.0))
    assert set(lower.path_layers) == {0}


def test_without_a_way_the_view_says_so() -> None:
    lower, _ = views(goal="den")
    assert lower.way == "no way"
    assert len(lower.path) == 0
    assert views(goal="den", body=Body.child())[0].way.endswith(" m")


def test_walls_are_those_that_stop_this_body_on_this_layer() -> None:
    rail = {"start": [8, 3.5], "end": [8, 8], "offset_m": 3.0, "height_m": 1.1}
    lower, upper = views(walls=[rail])
    on_rail = [8.0, 3.5, 8.0, 8.0]
    assert on_rail in upper.walls.tolist()
    assert on_rail not in lower.walls.tolist()


@pytest.mark.parametrize(
    ("start", "goal", "message"),
    [
        ("moon", None, "--from: no place named 'moon'; the scene has: loft, below, den"),
        (None, (6.0, 1.0, 9.0), r"--to: this body cannot stand near \(6, 1, 9\)"),
        ((99.0, 1.0, 0.0), None, r"--from: this body cannot stand near"),
    ],
)
def test_ends_that_are_none_are_refused(
    start: Where | None, goal: Where | None, message: str
) -> None:
    with pytest.raises(UsageError, match=message):
        views(start, goal)


def test_a_body_that_cannot_come_in_is_refused() -> None:
    with pytest.raises(UsageError, match="cannot stand at any spawn"):
        views(spawns=[{"position": [6, 6.25], "radius_m": 0}])
