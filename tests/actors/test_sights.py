"""The sights that there are to see at a place."""

import pytest

from esplanade.actors.sights import SEEN_WITHIN_M, sight_at
from esplanade.planning import Polygon, Scene
from tests.actors.worlds import block

FIELD = (0.0, 0.0, 40.0, 40.0)


def scene(*polygons: Polygon) -> Scene:
    return Scene(bounds=FIELD, polygons=polygons)


def test_the_nearest_thing_is_seen_at_its_middle() -> None:
    house, hut = block(10.0, 10.0, 20.0, 16.0), block(24.0, 10.0, 26.0, 12.0)
    assert sight_at(scene(house, hut), (15.0, 8.0, 0.0)) == pytest.approx((15.0, 13.0, 1.5))
    assert sight_at(scene(house, hut), (23.0, 11.0, 0.0)) == pytest.approx((25.0, 11.0, 1.5))


def test_the_side_of_a_thing_counts_not_its_corners_or_its_middle() -> None:
    wide, hut = block(0.0, 10.0, 40.0, 16.0), block(20.0, 3.0, 21.0, 4.0)
    assert sight_at(scene(wide, hut), (20.5, 8.0, 0.0)) == pytest.approx((20.0, 13.0, 1.5))


def test_what_is_far_away_is_not_seen() -> None:
    house = block(10.0, 10.0, 20.0, 16.0)
    assert sight_at(scene(house), (15.0, 9.5 - SEEN_WITHIN_M, 0.0)) is None
    assert sight_at(scene(), (15.0, 9.0, 0.0)) is None


def test_floors_and_what_stands_on_other_floors_are_no_sights() -> None:
    house = block(10.0, 10.0, 20.0, 16.0)
    floor = house.model_copy(update={"kind": "floor"})
    above = house.model_copy(update={"offset_m": 3.5})
    assert sight_at(scene(floor, above), (15.0, 8.0, 0.0)) is None
    assert sight_at(scene(floor, above), (15.0, 8.0, 3.5)) == pytest.approx((15.0, 13.0, 5.0))
