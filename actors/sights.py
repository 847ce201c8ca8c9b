"""The sight at a place: the thing that stands nearest to it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Polygon, Scene
from esplanade.planning.scene.heights import SAME_FLOOR_M

Point = tuple[float, float, float]

SEEN_WITHIN_M = 6.0
"""A thing further away than this does not belong to the place."""


def sight_at(scene: Scene, place: Point) -> Point | None:
    """Middle (x, y, z) of the thing nearest to a place, metres; None where nothing is near.

    Floors are no sights, nor are things on another floor. Cost O(corners of the scene).
    """
    nearest, sight = SEEN_WITHIN_M, None
    for polygon in scene.polygons:
        if polygon.kind == "floor" or abs(polygon.offset_m - place[2]) >= SAME_FLOOR_M:
            continue
        corners = np.array(polygon.points)
        away_m = _distance(corners, place[:2])
        if away_m < nearest:
            nearest, sight = away_m, _middle(polygon, corners)
    return sight


def _distance(corners: NDArray[np.float64], point: tuple[float, float]) -> float:
    """Distance from a point to the outline of a polygon, (N, 2)."""
    along = np.roll(corners, -1, axis=0) - corners
    apart = np.asarray(point) - corners
    share = np.clip((apart * along).sum(1) / (along * along).sum(1), 0.0, 1.0)
    return float(np.hypot(*(apart - share[:, None] * along).T).min())


def _middle(polygon: Polygon, corners: NDArray[np.float64]) -> Point:
    x, y = corners.mean(axis=0).tolist()
    return x, y, polygon.offset_m + polygon.height_m / 2.0
