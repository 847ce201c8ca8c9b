"""Openings in walls: exact cases, invariants, and the recorded walls."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.recordings import (
    Crowd,
    Track,
    Wall,
    open_doorways,
    read_crowd,
    read_walls,
    walls_beside,
)
from tests.recordings.data import recorded

Point = tuple[float, float]
WALL: Wall = ((0.0, 0.0), (10.0, 0.0))


def crowd_of(*paths: Sequence[Point]) -> Crowd:
    tracks = [
        Track(str(i), np.arange(len(path), dtype=np.float64), np.array(path, dtype=np.float64))
        for i, path in enumerate(paths)
    ]
    return Crowd("synthetic", tuple(tracks))


def distance_m(point: Point, start: Point, end: Point) -> float:
    """The naive distance from a point to a segment."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    square = dx * dx + dy * dy
    u = ((point[0] - start[0]) * dx + (point[1] - start[1]) * dy) / square if square else 0.0
    u = min(1.0, max(0.0, u))
    return math.dist(point, (start[0] + u * dx, start[1] + u * dy))


def distance_to_crowd_m(point: Point, crowd: Crowd) -> float:
    return min(
        distance_m(point, (a[0], a[1]), (b[0], b[1]))
        for track in crowd.tracks
        for a, b in zip(track.positions[:-1], track.positions[1:], strict=True)
    )


def points_on(wall: Wall, count: int) -> list[Point]:
    (x0, y0), (x1, y1) = wall
    return [(x0 + u * (x1 - x0), y0 + u * (y1 - y0)) for u in np.linspace(0.0, 1.0, count)]


def assert_walls(walls: list[Wall], expected: list[Wall]) -> None:
    assert len(walls) == len(expected)
    np.testing.assert_allclose(np.array(walls), np.array(expected), atol=1e-9)


def test_a_path_straight_through_leaves_a_doorway_of_the_width() -> None:
    walls = open_doorways([WALL], crowd_of([(4, -3), (4, 3)]), width_m=1.0)
    assert_walls(walls, [((0, 0), (3.5, 0)), ((4.5, 0), (10, 0))])


def test_a_wall_that_nobody_comes_near_stays_as_it_is() -> None:
    walls = open_doorways([WALL], crowd_of([(4, 3), (4, 0.51)]), width_m=1.0)
    assert walls == [WALL]


def test_a_path_that_ends_close_by_opens_only_what_its_disc_reaches() -> None:
    walls = open_doorways([WALL], crowd_of([(4, 3), (4, 0.3)]), width_m=1.0)
    assert_walls(walls, [((0, 0), (3.6, 0)), ((4.4, 0), (10, 0))])


def test_a_path_along_the_wall_opens_all_of_it() -> None:
    assert open_doorways([WALL], crowd_of([(-1, 0.2), (11, 0.2)]), width_m=1.0) == []


def test_openings_that_overlap_become_one_and_slivers_go() -> None:
    crowd = crowd_of([(4, -3), (4, 3)], [(4.8, -3), (4.8, 3)], [(5.82, -3), (5.82, 3)])
    walls = open_doorways([WALL], crowd, width_m=1.0)
    assert_walls(walls, [((0, 0), (3.5, 0)), ((6.32, 0), (10, 0))])


def test_the_end_of_a_wall_is_cut_where_somebody_cuts_the_corner() -> None:
    walls = open_doorways([WALL], crowd_of([(10, -3), (10, 3)]), width_m=0.6)
    assert_walls(walls, [((0, 0), (9.7, 0))])


def test_someone_who_only_stood_in_the_wall_is_free_too() -> None:
    walls = open_doorways([WALL], crowd_of([(2, 0)], [(7, 0), (7, 0)]), width_m=1.0)
    assert_walls(walls, [((0, 0), (1.5, 0)), ((2.5, 0), (6.5, 0)), ((7.5, 0), (10, 0))])


@pytest.mark.parametrize("width_m", [0.0, -1.0, math.nan, math.inf])
def test_a_width_that_is_none_is_refused(width_m: float) -> None:
    with pytest.raises(ValueError, match="width_m"):
        open_doorways([WALL], crowd_of([(0, 0), (1, 1)]), width_m=width_m)


coordinate = st.floats(-5.0, 5.0).map(lambda value: round(value, 2))
point = st.tuples(coordinate, coordinate)
path = st.lists(point, min_size=2, max_size=5)
wall = st.tuples(point, point).filter(lambda ends: math.dist(*ends) > 0.01)


@given(walls=st.lists(wall, max_size=3), paths=st.lists(path, min_size=1, max_size=3))
def test_every_path_is_free_and_nothing_else_is_gone(
    walls: list[Wall], paths: list[list[Point]]
) -> None:
    width_m = 0.8
    crowd = crowd_of(*paths)
    opened = open_doorways(walls, crowd, width_m=width_m)
    for rest in opened:
        for place in points_on(rest, 17):
            assert distance_to_crowd_m(place, crowd) >= width_m / 2 - 1e-6
    for before in walls:
        for place in points_on(before, 17):
            gap_m = min((distance_m(place, *rest) for rest in opened), default=math.inf)
            near_m = distance_to_crowd_m(place, crowd)
            # Slivers may be removed too, so a removed point may also be within a sliver of a path.
            assert gap_m < 1e-6 or near_m < width_m / 2 + 0.05 or math.dist(*before) < 0.05


@pytest.mark.parametrize(("name", "touched"), [("eth", False), ("hotel", True), ("zara1", True)])
def test_recorded_people_have_their_way_among_recorded_walls(name: str, touched: bool) -> None:
    """In hotel one person leans on the kiosk; in zara1 one cuts a corner of the shop front."""
    csv_path: Path = recorded(name)
    crowd = read_crowd(csv_path)
    walls_path = walls_beside(csv_path)
    assert walls_path is not None
    walls = read_walls(walls_path)
    opened = open_doorways(walls, crowd, width_m=0.5)
    assert (opened != walls) is touched
    length_m = sum(math.dist(*wall) for wall in walls)
    assert sum(math.dist(*wall) for wall in opened) > 0.7 * length_m
    nearest_m = min(
        distance_to_crowd_m(place, crowd) for rest in opened for place in points_on(rest, 3)
    )
    assert nearest_m >= 0.25 - 1e-6
