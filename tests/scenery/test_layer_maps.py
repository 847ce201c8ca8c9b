"""The maps of a scene: each layer for one body, and a path between two points."""

import numpy as np
import pytest

from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal.stability import Stability
from esplanade.scenery.layer_maps import layer_maps
from esplanade.scenery.pictures import LayerMap
from esplanade.scenery.values import Where
from tests.scenery.worlds import loft


def maps(
    start: Where | None = None, goal: Where | None = None, body: Body | None = None, **changes
) -> list[LayerMap]:
    return layer_maps(loft(**changes), 0.25, body or Body.adult(), start, goal)


def test_every_layer_has_its_floors_and_names() -> None:
    lower, upper = maps()
    assert lower.floors.shape == upper.floors.shape == (32, 48)
    assert lower.floors[16, 4] == 0.0
    assert upper.floors[16, 40] == pytest.approx(3.0)
    assert np.isnan(upper.floors[16, 4])
    assert {marker.name for marker in lower.markers} == {"spawn 0", "below", "den"}
    assert {marker.name for marker in upper.markers} == {"loft"}


def test_absent_floors_differ_from_floors_that_are_not_reached() -> None:
    lower, upper = maps()
    den = (29, 14)
    assert not lower.reachable[den]
    assert lower.classes[den] == Stability.STABLE
    assert np.isinf(lower.distance[den])
    assert upper.classes[16, 4] == -1
    assert np.isnan(upper.distance[16, 4])


def test_the_path_goes_from_the_spawn_to_the_farthest_place() -> None:
    lower, upper = maps()
    assert lower.path[0] == pytest.approx((1.0, 2.0))
    assert lower.path[-1] == pytest.approx((10.0, 4.0))
    assert lower.path_layers[0] == 0
    assert lower.path_layers[-1] == 1
    assert lower.path_summary.endswith(" m")
    assert upper.distance[16, 40] < 0.5
    assert np.array_equal(lower.path, upper.path)


def test_the_ends_are_places_or_points() -> None:
    lower, _ = maps("below", (2.0, 4.0, 0.0))
    assert lower.path[0] == pytest.approx((10.0, 4.0))
    assert lower.path[-1] == pytest.approx((2.0, 4.0))
    assert set(lower.path_layers) == {0}


def test_without_a_way_the_view_says_so() -> None:
    lower, _ = maps(goal="den")
    assert lower.path_summary == "no way"
    assert len(lower.path) == 0
    assert maps(goal="den", body=Body.child())[0].path_summary.endswith(" m")


def test_walls_are_those_that_stop_this_body_on_this_layer() -> None:
    rail = {"start": [8, 3.5], "end": [8, 8], "offset_m": 3.0, "height_m": 1.1}
    lower, upper = maps(walls=[rail])
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
        maps(start, goal)


def test_a_body_that_cannot_come_in_is_refused() -> None:
    with pytest.raises(UsageError, match="cannot stand at any spawn"):
        maps(spawns=[{"position": [6, 6.25], "radius_m": 0}])
