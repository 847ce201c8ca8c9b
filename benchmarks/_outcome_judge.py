"""A judge of trips that knows geometry alone: shapely says where discs fit and what is joined."""

from __future__ import annotations

from collections.abc import Sequence

from shapely import Geometry, LineString, Point, box, difference, union_all
from shapely.geometry.base import BaseGeometry

from esplanade.planning import Scene

PLACE_M = 0.02
"""Discs may be this much too near: cells tell where walls are to within less."""


class Judge:
    """Tells where discs fit among walls and bodies, and whether ways lead from place to place."""

    def __init__(self, scene: Scene, radius_m: float) -> None:
        solid = [LineString([wall.start, wall.end]) for wall in scene.walls]
        x0, y0, x1, y1 = scene.bounds
        self._radius_m = radius_m
        self._static: BaseGeometry = difference(
            box(x0, y0, x1, y1).buffer(-radius_m + PLACE_M),
            union_all([each.buffer(radius_m - PLACE_M) for each in solid]),
        )

    def room(self, bodies: Sequence[tuple[float, float, float]], room_m: float = 0.0) -> Geometry:
        """Where a centre may be among bodies x, y, radius, with some room to each."""
        reach = self._radius_m + room_m
        return difference(
            self._static, union_all([Point(x, y).buffer(r + reach, 32) for x, y, r in bodies])
        )

    def leads(
        self,
        start: tuple[float, float],
        goal: tuple[float, float],
        within_m: float,
        bodies: Sequence[tuple[float, float, float]] = (),
        room_m: float = 0.0,
    ) -> bool:
        """Whether a way leads from a start to within some metres of a goal, clear of bodies."""
        room, near = self.room(bodies, room_m), Point(goal).buffer(within_m)
        here = Point(start)
        parts = list(getattr(room, "geoms", [room]))
        nearest = min(parts, key=here.distance, default=None)
        return nearest is not None and bool(nearest.intersects(near))

    def fits(
        self,
        goal: tuple[float, float],
        within_m: float,
        bodies: Sequence[tuple[float, float, float]],
        room_m: float = 0.0,
    ) -> bool:
        """Whether there is a place within some metres of a goal, clear of bodies."""
        return bool(self.room(bodies, room_m).intersects(Point(goal).buffer(within_m)))
