"""The scene of a plan: ground, walls and doors of each storey, one above the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, Final

from pydantic import ValidationError

from esplanade.commandline.errors import UsageError
from esplanade.planning import Scene
from esplanade.planning.scene.scene_file import scene_faults
from esplanade.scenery.plans.storey import Line, Point, Storey, library

STOREY_M: Final = 3.2
"""From one floor to the next."""
_SLAB_M: Final = 0.3
_STEPS: Final = 19
"""Steps of a flight between storeys, of 17 cm each."""
_WALL_M: Final = 2.5
_MOST_CORNERS: Final = 500
_LEAST_AREA_M2: Final = 1e-4


def scene_of_plan(
    storeys: Sequence[Storey], name: str, scale: float = 1.0, recentre: bool = False
) -> Scene:
    """The scene of the storeys, the first on the ground.

    Where a storey says what can be walked, all else within the bounds is solid on the ground and
    open air above it.

    Raises
    ------
    UsageError
        It is no scene: too large, or of too many parts.
    """
    boxes = [storey.bounds() for storey in storeys]
    x0, y0 = (scale * min(box[k] for box in boxes) for k in (0, 1))
    x1, y1 = (scale * max(box[k] for box in boxes) for k in (2, 3))
    moved = (round(0.5 * (x0 + x1)), round(0.5 * (y0 + y1))) if recentre else (0, 0)
    bounds = (
        math.floor(x0 - moved[0] + 1e-6),
        math.floor(y0 - moved[1] + 1e-6),
        math.ceil(x1 - moved[0] - 1e-6),
        math.ceil(y1 - moved[1] - 1e-6),
    )
    parts: dict[str, list[Any]] = {
        group: [] for group in ("polygons", "walls", "doors", "places", "stairs")
    }
    mover = _Mover(scale, moved)
    below: Storey | None = None
    for number, storey in enumerate(storeys):
        _add_storey(parts, storey, number, bounds, mover, len(storeys) > 1, _shafts(below, mover))
        if number + 1 < len(storeys):
            parts["stairs"] += [
                {
                    **mover.line(flight),
                    "width_m": width * scale,
                    "bottom_m": number * STOREY_M,
                    "top_m": (number + 1) * STOREY_M,
                    "steps": _STEPS,
                }
                for flight, width in storey.stairs
            ]
        elif storey.stairs:
            storey.remarks.append("its stairs lead to no storey above: they are left out")
        below = storey
    try:
        return Scene.model_validate(
            {"name": name[:64], "bounds": bounds, "origin_m": (*moved, 0.0), **parts}
        )
    except ValidationError as error:
        faults = scene_faults(error)
        more = f" and {len(faults) - 3} others" if len(faults) > 3 else ""
        hint = "; is its unit right? --scale says otherwise" if "may measure" in faults[0] else ""
        raise UsageError(f"it makes no scene: {'; '.join(faults[:3])}{more}{hint}") from None


def _shafts(below: Storey | None, mover: _Mover) -> Any:
    """The openings above the flights of a storey; None without any."""
    if below is None or not below.stairs:
        return None
    shapely = library("shapely", "plans")
    found = []
    for flight, width in below.stairs:
        line = shapely.LineString([mover.point(end) for end in flight])
        found.append(line.buffer(0.5 * width * mover.scale, cap_style="flat"))
    return shapely.union_all(found)


class _Mover:
    """From the coordinates of the plan to those of the scene."""

    def __init__(self, scale: float, moved: tuple[int, int]) -> None:
        self.scale = scale
        self._moved = moved

    def point(self, point: Point) -> Point:
        x, y = (round(self.scale * c - m, 6) for c, m in zip(point, self._moved, strict=True))
        return x, y

    def line(self, line: Line) -> dict[str, Point]:
        return {"start": self.point(line[0]), "end": self.point(line[1])}

    def area(self, area: Any) -> Any:
        shapely = library("shapely", "plans")
        return shapely.transform(area, lambda c: c[:, :2] * self.scale - self._moved)


def _add_storey(
    parts: dict[str, list[Any]],
    storey: Storey,
    number: int,
    bounds: tuple[int, int, int, int],
    mover: _Mover,
    several: bool,
    shafts: Any,
) -> None:
    floor_m = number * STOREY_M
    prefix = f"{storey.name} " if several else ""
    area = None if storey.walkable is None else mover.area(storey.walkable)
    shapely = library("shapely", "plans")
    if area is None and number:
        area = shapely.box(*bounds)
    if number:
        area = area if shafts is None or area is None else area.difference(shafts)
        parts["polygons"] += [
            {"kind": "floor", "offset_m": floor_m - _SLAB_M, "height_m": _SLAB_M, "points": ring}
            for ring in rings_without_holes(area)
        ]
    if area is not None and not number:
        parts["polygons"] += [
            {"kind": "wall", "height_m": _WALL_M, "points": ring}
            for ring in rings_without_holes(shapely.box(*bounds).difference(area))
        ]
    elif area is not None:
        storey.walls += _edges(storey.walkable)
    standing = {"offset_m": floor_m}
    parts["walls"] += [
        {**mover.line(wall), **standing, "height_m": _WALL_M} for wall in storey.walls
    ]
    parts["doors"] += [
        {"name": f"{prefix}{name}"[:64], **mover.line(door), **standing}
        for name, door in storey.doors
    ]
    parts["places"] += [
        {"name": f"{prefix}{name}"[:64], "position": mover.point(point), "z_m": floor_m}
        for name, point in storey.points
    ]


def _edges(area: Any) -> list[Line]:
    """The edges of all rings of an area; None has none."""
    edges: list[Line] = []
    for polygon in getattr(area, "geoms", [area] if area is not None else []):
        for ring in (polygon.exterior, *polygon.interiors):
            points = [(x, y) for x, y, *_ in ring.coords]
            edges += itertools.pairwise(points)
    return edges


def rings_without_holes(area: Any) -> list[list[Point]]:
    """Rings that fill an area together; polygons with holes or many corners are cut in two."""
    shapely = library("shapely", "plans")
    rings: list[list[Point]] = []
    left = list(getattr(area, "geoms", [area]))
    while left:
        polygon = left.pop()
        if polygon.geom_type != "Polygon" or polygon.area < _LEAST_AREA_M2:
            left += list(getattr(polygon, "geoms", []))
            continue
        if not polygon.interiors and len(polygon.exterior.coords) <= _MOST_CORNERS:
            ring = shapely.simplify(polygon.exterior, 1e-6)
            rings.append([(round(x, 6), round(y, 6)) for x, y, *_ in ring.coords[:-1]])
            continue
        x0, y0, x1, y1 = polygon.bounds
        hole = polygon.interiors[0] if polygon.interiors else polygon
        middle = shapely.box(*hole.bounds).centroid
        wide = bool(polygon.interiors) or x1 - x0 > y1 - y0
        halves = (
            (shapely.box(x0, y0, middle.x, y1), shapely.box(middle.x, y0, x1, y1))
            if wide
            else (shapely.box(x0, y0, x1, middle.y), shapely.box(x0, middle.y, x1, y1))
        )
        left += [polygon.intersection(half) for half in halves]
    return rings
