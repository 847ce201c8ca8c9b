"""Checks of avatars' positions against the shapes of the scene, independent of the planner."""

from __future__ import annotations

import itertools
import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.obstacles import point_segment_distances
from esplanade.planning import Polygon, Scene

Points = NDArray[np.float64]
"""Positions (N, 3): x, y and the height of the feet, metres."""
Flags = NDArray[np.bool_]

STEP_ON_M: Final = 0.6
HEAD_M: Final = 1.75
"""The height of a body of 1.80 m, less the rounding of snapshots."""
UNCLIMBED_M: Final = 1.2
"""Solids that cannot be stood on obstruct up to at least this height, however low they are."""

AROUND_M: Final = 0.13
"""A floor is searched for within half a cell, since heights are those of cells of 0.25 m."""
LEVEL_M: Final = 0.04
"""Feet this near to a floor stand on it: snapshots are in centimetres, and ramps rise within a
cell."""
IN_WALL_M: Final = 0.03
"""A centre this near to a wall is inside it."""
_FAR_M: Final = 3.0
"""Larger clearances count as this."""


def unsupported(scene: Scene, points: Points) -> Flags:
    """Whether each avatar stands on no floor, or beyond the bounds, bool (N,)."""
    x0, y0, x1, y1 = scene.bounds
    stands = np.zeros(len(points), dtype=np.bool_)
    carrying = [solid for solid in scene.solids() if solid.carries]
    for dx, dy in [(i * AROUND_M, j * AROUND_M) for i in (-1, 0, 1) for j in (-1, 0, 1)]:
        x, y, z = (points + np.array([dx, dy, 0.0])).T
        on_ground = (np.abs(z) <= LEVEL_M) & (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)
        stands |= on_ground
        for solid in carrying:
            near = np.flatnonzero(~stands & _boxed(solid, x, y))
            near = near[_encloses(solid, x[near], y[near])]
            stands[near] |= np.abs(_top(solid, x[near], y[near]) - z[near]) <= LEVEL_M
    return ~stands


def inside(scene: Scene, points: Points) -> Flags:
    """Whether each avatar is inside a solid or a wall between step height and head, bool (N,)."""
    found = np.zeros(len(points), dtype=np.bool_)
    x, y, z = points.T
    for solid in scene.solids():
        near = np.flatnonzero(~found & _boxed(solid, x, y))
        near = near[_encloses(solid, x[near], y[near])]
        top = _top(solid, x[near], y[near])
        found[near] |= _reaches(solid.offset_m, top, z[near])
    for wall in scene.walls:
        away = _distance(points, wall.start, wall.end)
        touched = away <= IN_WALL_M
        found |= touched & _reaches(wall.offset_m, wall.offset_m + wall.height_m, z)
    return found


def clearances(scene: Scene, points: Points) -> NDArray[np.float64]:
    """The distances of centres from obstacles, float64 (N,), metres, at most 3 m."""
    least = np.full(len(points), _FAR_M)
    x, y, z = points.T
    for solid in scene.solids():
        near = np.flatnonzero(_boxed(solid, x, y, least.max()))
        if not len(near):
            continue
        low = np.array([solid.top_at(*corner) for corner in solid.points]).min()
        near = near[_reaches(solid.offset_m, _stopping(solid, low), z[near])]
        ring = (*solid.points, solid.points[0])
        for start, end in itertools.pairwise(ring):
            least[near] = np.minimum(least[near], _distance(points[near], start, end))
    for wall in scene.walls:
        stops = _reaches(wall.offset_m, wall.offset_m + wall.height_m, z)
        away = _distance(points, wall.start, wall.end)
        least[stops] = np.minimum(least[stops], away[stops])
    return least


def _reaches(
    bottom: float, top: float | NDArray[np.float64], z: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether something from bottom to top obstructs bodies with their feet at z, bool (N,)."""
    return np.asarray((bottom < z + HEAD_M) & (top > z + STEP_ON_M + LEVEL_M))


def _stopping(solid: Polygon, top: float) -> float:
    return top if solid.carries else max(top, solid.offset_m + UNCLIMBED_M)


def _top(solid: Polygon, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """The height of the top of a solid at N points, (N,), metres.

    It is `Polygon.top_at` for solids that can be stood on; others obstruct up to `_stopping`.
    """
    top = solid.offset_m + solid.height_m
    if solid.ramp is None:
        return np.full(len(x), _stopping(solid, top))
    (ax, ay), (bx, by) = solid.ramp.start, solid.ramp.end
    along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / math.dist((ax, ay), (bx, by)) ** 2
    low = solid.offset_m + solid.ramp.start_height_m
    return np.asarray(low + np.clip(along, 0.0, 1.0) * (top - low))


def _boxed(
    solid: Polygon, x: NDArray[np.float64], y: NDArray[np.float64], margin_m: float = 0.0
) -> NDArray[np.bool_]:
    xs, ys = zip(*solid.points, strict=True)
    return np.asarray(
        (x >= min(xs) - margin_m)
        & (x <= max(xs) + margin_m)
        & (y >= min(ys) - margin_m)
        & (y <= max(ys) + margin_m)
    )


def _encloses(solid: Polygon, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether the ring encloses each of N points, bool (N,), by the crossings of a ray east."""
    odd = np.zeros(len(x), dtype=np.bool_)
    ring = (*solid.points, solid.points[0])
    for (ax, ay), (bx, by) in itertools.pairwise(ring):
        if ay != by:
            crossing = (ax - bx) * (y - by) / (ay - by) + bx
            odd ^= ((by > y) != (ay > y)) & (x < crossing)
    return odd


def _distance(
    points: Points, start: tuple[float, float], end: tuple[float, float]
) -> NDArray[np.float64]:
    """The distances on the map of points (N, 3) from a segment, (N,), metres."""
    return point_segment_distances(points[:, :2], np.array([[start, end]]))
