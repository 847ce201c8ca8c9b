"""Random pairs of points on the ground, and the comparison of the answers to them."""

import numpy as np
import pytest
from benchmarks._pairs import (
    Answer,
    Finders,
    finders_of,
    ground_points,
    last_reached,
    length_ratios,
    pairs_of,
    spread,
)

SQUARE = np.array(
    [[[0, 0, 0], [4, 0, 0], [4, 4, 0]], [[0, 0, 0], [4, 4, 0], [0, 4, 0]]], dtype=float
)


def answer(*points: tuple[float, float, float]) -> Answer:
    return Answer((True, True), np.array(points, dtype=float).reshape(-1, 3), 1.0)


def test_points_cover_the_ground_evenly() -> None:
    points = ground_points(SQUARE, 4000, np.random.default_rng(0))
    assert points.shape == (4000, 3)
    assert points[:, 2].max() == points[:, 2].min() == 0.0
    quarters = np.histogram2d(points[:, 0], points[:, 1], bins=2, range=[(0, 4), (0, 4)])[0]
    assert quarters.sum() == 4000
    assert abs(quarters - 1000).max() < 120


def test_walls_ceilings_and_steep_slopes_are_no_ground() -> None:
    wall = [[9, 0, 0], [9, 4, 0], [9, 4, 4]]
    steep = [[20, 0, 0], [21, 0, 1.2], [20, 4, 0]]
    gentle = [[30, 0, 0], [31, 0, 0.8], [30, 4, 0]]
    mesh = np.array([SQUARE[0, ::-1].tolist(), wall, steep, gentle])
    points = ground_points(mesh, 50, np.random.default_rng(0))
    assert points[:, 0].min() >= 30.0


def test_mesh_on_its_head_is_told_of() -> None:
    with pytest.raises(ValueError, match="another axis up"):
        ground_points(SQUARE[:, ::-1], 5, np.random.default_rng(0))


def test_pairs_join_different_points_of_the_ground() -> None:
    points = np.arange(30.0).reshape(10, 3)
    known = np.arange(10) % 2 == 0
    pairs = pairs_of(points, known, 200, np.random.default_rng(0))
    assert pairs.shape == (200, 2, 3)
    assert np.isin(pairs[..., 0], points[known, 0]).all()
    assert (pairs[:, 0] != pairs[:, 1]).all()
    again = pairs_of(points, known, 200, np.random.default_rng(0))
    assert np.array_equal(pairs, again)


def test_no_pairs_without_ground() -> None:
    with pytest.raises(ValueError, match="1 of 3 points"):
        pairs_of(np.zeros((3, 3)), np.array([True, False, False]), 5, np.random.default_rng(0))


@pytest.mark.parametrize(
    ("ours", "theirs", "finders"),
    [
        (True, True, Finders.BOTH),
        (False, False, Finders.NEITHER),
        (True, False, Finders.ONLY_OURS),
        (False, True, Finders.ONLY_THEIRS),
    ],
)
def test_verdict(ours, theirs, finders) -> None:
    path = answer((0, 0, 0), (5, 0, 0))
    assert finders_of(path if ours else answer(), path if theirs else answer()) is finders


def test_ratios_are_of_ways_both_found_and_long_enough() -> None:
    bent, straight = answer((0, 0, 0), (3, 4, 7), (6, 0, 0)), answer((0, 0, 0), (6, 0, 0))
    short = answer((0, 0, 0), (1, 0, 0))
    ours, theirs = [bent, bent, short, straight], [straight, answer(), short, straight]
    assert length_ratios(ours, theirs).tolist() == pytest.approx([10 / 6, 1.0])


def test_last_point_reached_is_found_by_few_questions() -> None:
    asked = []

    def reaches(point: np.ndarray) -> bool:
        asked.append(point)
        return bool(point[1] < 3.05)

    last = last_reached(np.array([[0, 0, 0], [10, 0, 0], [10, 20, 2]], dtype=float), reaches)
    assert last[0] == pytest.approx(10.0)
    assert 2.9 < last[1] < 3.05
    assert len(asked) < 12


def test_spread_of_nothing_is_nothing() -> None:
    assert spread([]) == {"p5": None, "p50": None, "p95": None}
    assert spread(np.arange(101.0)) == {"p5": 5.0, "p50": 50.0, "p95": 95.0}
