import math

import numpy as np
import pytest

from esplanade.planning import Portal
from esplanade.planning.scene.portal_areas import NO_PORTAL, portals_at

STAR = [
    (
        10 + (5 if k % 2 else 2) * math.cos(0.2 * math.pi * k),
        10 + (5 if k % 2 else 2) * math.sin(0.2 * math.pi * k),
    )
    for k in range(10)
]
"""A ring with five dents, none of whose edges lies along an axis."""


def portal(points: list[tuple[float, float]], z_m: float = 0.0, name: str = "gate") -> Portal:
    return Portal(name=name, points=tuple(points), z_m=z_m)


def test_places_lie_in_a_portal_as_they_do_in_a_polygon_of_shapely() -> None:
    shapely = pytest.importorskip("shapely")
    places = np.random.default_rng(4).uniform(3.0, 17.0, (2000, 2))
    found = portals_at([portal(STAR)], places, np.zeros(len(places)))
    wanted = shapely.contains_xy(shapely.Polygon(STAR), places[:, 0], places[:, 1])
    assert np.array_equal(found == 0, wanted)
    assert 100 < wanted.sum() < 1900


def test_only_places_at_the_height_of_a_portal_lie_in_it() -> None:
    places = np.full((4, 2), 10.0)
    heights = np.array([0.0, 2.1, 3.0, 3.9])
    found = portals_at([portal(STAR, 3.0)], places, heights)
    assert found.tolist() == [NO_PORTAL, 0, 0, 0]


def test_of_portals_that_overlap_the_first_counts() -> None:
    square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
    beside = [(3.0, 1.0), (9.0, 1.0), (9.0, 2.0), (3.0, 2.0)]
    places = np.array([[1.0, 1.5], [3.5, 1.5], [8.0, 1.5], [8.0, 3.0]])
    both = [portal(square), portal(beside)]
    assert portals_at(both, places, np.zeros(4)).tolist() == [0, 0, 1, NO_PORTAL]
    assert portals_at(both[::-1], places, np.zeros(4)).tolist() == [1, 0, 0, NO_PORTAL]


def test_without_portals_no_place_lies_in_one() -> None:
    assert portals_at([], np.zeros((3, 2)), np.zeros(3)).tolist() == [NO_PORTAL] * 3


def test_those_who_come_out_stand_at_the_arrival_or_in_the_middle() -> None:
    points = ((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0))
    assert Portal(name="a", points=points, z_m=3.0).arrival_place == (2.0, 1.0, 3.0)
    assert Portal(name="a", points=points, arrival=(5.0, 6.0)).arrival_place == (5.0, 6.0, 0.0)
