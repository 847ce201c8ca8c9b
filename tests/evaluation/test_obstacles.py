"""Distances from walls and circles agree with a dense sampling."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.evaluation.obstacles import (
    ObstacleSet,
    point_segment_distances,
    segment_segment_distances,
)
from esplanade.recordings import Obstacles

coordinate = st.floats(-4.0, 4.0).map(lambda value: round(value, 2))
point = st.tuples(coordinate, coordinate)


def test_circles_are_exact_and_negative_inside() -> None:
    obstacles = ObstacleSet(Obstacles(circles=((1.0, 1.0, 0.5),)))
    assert obstacles.distance(np.array([1.0, 3.0])) == 1.5
    assert obstacles.distance(np.array([1.0, 1.2])) == pytest.approx(-0.3)
    assert obstacles.outline.shape == (8, 2, 2)


def test_without_obstacles_everything_is_far() -> None:
    obstacles = ObstacleSet(Obstacles())
    assert obstacles.distance(np.zeros(2)) == np.inf
    assert obstacles.outline.shape == (0, 2, 2)


def dense(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    return np.asarray(start + np.linspace(0.0, 1.0, 201)[:, None] * (end - start))


@given(a=point, b=point, c=point, d=point)
def test_distances_are_those_of_a_dense_sampling(
    a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]
) -> None:
    start, end = np.array(a), np.array(b)
    wall = np.array([[c, d]])
    on_wall = dense(*wall[0])
    step_m = 0.5 * float(np.hypot(*(wall[0, 1] - wall[0, 0]))) / 200 + 1e-9
    naive = np.hypot(*(on_wall - start).T).min()
    assert naive - step_m <= point_segment_distances(start, wall)[0] <= naive + 1e-9

    line = dense(start, end)
    naive = np.hypot(*np.moveaxis(line[:, None] - on_wall[None], -1, 0)).min()
    step_m += 0.5 * float(np.hypot(*(end - start))) / 200
    assert naive - step_m <= segment_segment_distances(start, end, wall)[0] <= naive + 1e-9
