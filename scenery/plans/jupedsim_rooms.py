"""Storeys of the rooms of JuPedSim: parts of rooms whose walls and openings close around them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from esplanade.scenery.plans.storey import Line, Point, Slope, Storey, library

_GRID_M: Final = 1e-4
"""Ends of lines that are closer together than this are one."""
_LEVEL: Final = 0.01
"""Planes that slope less are level."""
_SAME_LEVEL_M: Final = 0.05
_RECTANGLE: Final = 0.98


Key = tuple[str, str]
"""Numbers of a room, and of a part in it."""


class Opening(NamedTuple):
    """A crossing between parts of a room, or a transition between rooms, which is a door."""

    name: str
    line: Line
    is_door: bool
    between: frozenset[Key]
    """The parts of rooms that the file names; empty without."""


@dataclass
class RoomPart:
    """A part of a room: its plane, A, B and C of z = A x + B y + C, and the lines around it."""

    plane: tuple[float, float, float]
    is_stairs: bool
    key: Key = ("", "")
    walls: list[Line] = field(default_factory=list)
    obstacles: list[Line] = field(default_factory=list)

    @property
    def is_level(self) -> bool:
        """Whether its plane does not slope."""
        return math.hypot(*self.plane[:2]) < _LEVEL

    def height_at(self, point: Point) -> float:
        """The height of its plane at a point, metres."""
        a, b, c = self.plane
        return a * point[0] + b * point[1] + c


def storeys_of_parts(
    name: str, parts: Sequence[RoomPart], openings: Sequence[Opening]
) -> Storey | None:
    """The lowest storey of the parts, with those above it; None if some part does not close."""
    areas = [_area_of(part, openings) for part in parts]
    if not parts or any(area is None for area in areas):
        return None
    slopes = [_slope_of(p, a) for p, a in zip(parts, areas, strict=True) if not p.is_level]
    bottoms = [slope.bottom_m for slope in slopes]
    heights = _levels([part.plane[2] for part in parts if part.is_level])
    if not heights or min(bottoms, default=math.inf) < heights[0] - _SAME_LEVEL_M:
        heights = _levels([*heights, *bottoms[:1], min(bottoms)])
    # Planes are written with a few digits: slopes end at the floors that they lead to.
    slopes = [
        slope._replace(
            bottom_m=_snapped(slope.bottom_m, heights), top_m=_snapped(slope.top_m, heights)
        )
        for slope in slopes
    ]
    shapely = library("shapely", "plans")
    storeys: list[Storey] = []
    for height in heights:
        label = f"{height:g} m" if storeys else name
        level = [
            area
            for part, area in zip(parts, areas, strict=True)
            if part.is_level and abs(part.plane[2] - height) <= _SAME_LEVEL_M
        ]
        walkable = shapely.union_all(level) if level else shapely.Polygon()
        storeys.append(Storey(label, walkable, height_m=height, edged=False))
    for part in parts:
        for wall in part.walls + part.obstacles:
            _nearest(storeys, min(part.height_at(end) for end in wall)).walls.append(wall)
    for opening in openings:
        if opening.is_door:
            height = _height_of(opening, parts, areas)
            _nearest(storeys, height).doors.append((opening.name, opening.line))
    storeys[0].slopes = slopes
    storeys[0].above = storeys[1:]
    return storeys[0]


def _levels(heights: list[float]) -> list[float]:
    found: list[float] = []
    for height in sorted(heights):
        if not found or height - found[-1] > _SAME_LEVEL_M:
            found.append(height)
    return found


def _snapped(height: float, levels: list[float]) -> float:
    nearest = min(levels, key=lambda level: abs(level - height))
    return nearest if abs(nearest - height) <= _SAME_LEVEL_M else height


def _nearest(storeys: list[Storey], height: float) -> Storey:
    return min(storeys, key=lambda storey: abs((storey.height_m or 0.0) - height))


def _area_of(part: RoomPart, openings: Sequence[Opening]) -> Any:
    """The area that walls and openings enclose; None where they do not."""
    shapely = library("shapely", "plans")
    ends = {_rounded(end) for wall in part.walls for end in wall}
    lines = part.walls + [
        each.line
        for each in openings
        if (
            part.key in each.between
            if each.between
            else all(_rounded(e) in ends for e in each.line)
        )
    ]
    area = _enclosed(shapely, lines)
    if area is None:
        return None
    return area.difference(_enclosed(shapely, part.obstacles) or shapely.Polygon())


def _enclosed(shapely: Any, lines: list[Line]) -> Any:
    if not lines:
        return None
    drawn = shapely.set_precision(shapely.MultiLineString(lines), _GRID_M)
    faces = shapely.polygonize([shapely.union_all([drawn])])
    area = shapely.union_all(list(faces.geoms))
    return area if area.area > _GRID_M else None


def _rounded(point: Point) -> tuple[int, int]:
    return round(point[0] / _GRID_M), round(point[1] / _GRID_M)


def _height_of(opening: Opening, parts: Sequence[RoomPart], areas: Sequence[Any]) -> float:
    """The height of the lowest part that an opening is at."""
    shapely = library("shapely", "plans")
    (ax, ay), (bx, by) = opening.line
    middle = 0.5 * (ax + bx), 0.5 * (ay + by)
    point = shapely.Point(middle)
    beside = [
        part.height_at(middle)
        for part, area in zip(parts, areas, strict=True)
        if area.distance(point) < 10.0 * _GRID_M
    ]
    return min(beside, default=0.0)


def _slope_of(part: RoomPart, area: Any) -> Slope:
    """The slope of a part; stairs have a width if they fill a rectangle that rises lengthwise."""
    east, north, _ = part.plane
    steep = math.hypot(east, north)
    along = east / steep, north / steep
    corners = [(x, y) for x, y, *_ in area.convex_hull.exterior.coords]
    reach = [x * along[0] + y * along[1] for x, y in corners]
    aside = [y * along[0] - x * along[1] for x, y in corners]
    low, high = min(reach), max(reach)
    left, right = min(aside), max(aside)
    middle = 0.5 * (left + right)
    ends = [(s * along[0] - middle * along[1], s * along[1] + middle * along[0]) for s in (low, high)]  # noqa: E501  # fmt: skip
    fills = area.area >= _RECTANGLE * (high - low) * (right - left)
    return Slope(
        area,
        ends[0],
        ends[1],
        part.height_at(ends[0]),
        part.height_at(ends[1]),
        right - left if part.is_stairs and fills else 0.0,
    )
