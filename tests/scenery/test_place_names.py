"""Places are named after where they are."""

import numpy as np
import pytest

from esplanade.scenery.place_names import PlaceNamer

POINTS = np.array([[x, y, 0.0] for x in (0.0, 30.0) for y in (-30.0, 0.0)])


@pytest.mark.parametrize(
    ("point", "name"),
    [
        ((15.0, -15.0, 0.0), "middle"),
        ((15.0, -1.0, 0.0), "north"),
        ((29.0, -1.0, 0.0), "north-east"),
        ((29.0, -14.0, 0.0), "east"),
        ((1.0, -29.0, 0.0), "south-west"),
    ],
)
def test_on_one_floor_the_direction_is_enough(point: tuple[float, float, float], name: str) -> None:
    assert PlaceNamer(POINTS, (0.0,)).name_of(point) == name


@pytest.mark.parametrize(
    ("z", "name"),
    [(0.1, "ground floor, west"), (1.3, "ground floor, west"), (3.2, "floor 1, west")],
)
def test_of_several_floors_the_nearest_is_said(z: float, name: str) -> None:
    assert PlaceNamer(POINTS, (0.0, 3.0)).name_of((2.0, -15.0, z)) == name


def test_ground_of_one_point_has_a_middle() -> None:
    assert PlaceNamer(POINTS[:1], (0.0,)).name_of((0.0, -30.0, 0.0)) == "middle"
