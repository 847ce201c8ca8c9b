"""The triangles of a scene, for planners that read nothing else."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from benchmarks._pairs import Floats

from esplanade.planning import Polygon, Scene

Corner = tuple[float, float, float]


def triangles_of(scene: Scene) -> Floats:
    """The ground, the sides and tops of all solids, and the walls: (T, 3, 3), metres, z up.

    Rings must be convex. Tops on which nobody may stand are left out.
    """
    x0, y0, x1, y1 = scene.bounds
    faces = _fan([(x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)])
    for solid in scene.solids():
        faces += _prism(solid)
    for wall in scene.walls:
        low, high = wall.offset_m, wall.offset_m + wall.height_m
        faces += _upright(wall.start, wall.end, (low, low), (high, high))
    return np.array(faces, dtype=np.float64)


def _prism(solid: Polygon) -> list[list[Corner]]:
    ring = list(solid.points)
    if _twice_area(ring) < 0.0:
        ring.reverse()
    tops = [solid.top_at(x, y) for x, y in ring]
    low = solid.offset_m
    faces = _fan([(x, y, z) for (x, y), z in zip(ring, tops, strict=True)])
    faces = faces if solid.carries else []
    for k in range(len(ring)):
        faces += _upright(ring[k - 1], ring[k], (low, low), (tops[k - 1], tops[k]))
    return faces


def _fan(corners: Sequence[Corner]) -> list[list[Corner]]:
    return [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]


def _upright(
    a: tuple[float, float],
    b: tuple[float, float],
    low: tuple[float, float],
    high: tuple[float, float],
) -> list[list[Corner]]:
    return _fan([(*a, low[0]), (*b, low[1]), (*b, high[1]), (*a, high[0])])


def _twice_area(ring: Sequence[tuple[float, float]]) -> float:
    return sum(
        ax * by - ay * bx for (ax, ay), (bx, by) in zip(ring, [*ring[1:], ring[0]], strict=True)
    )
