"""The scene of a plan: ground, walls and doors of each storey, one above the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

from pydantic import ValidationError

from esplanade.commandline.errors import UsageError
from esplanade.planning import Scene
from esplanade.planning.scene.scene_file import scene_faults
from esplanade.scenery.plans.storey import Line, Point, Slope, Storey, library

STOREY_M: Final = 3.2
"""From one floor to the next."""
_SLAB_M: Final = 0.3
_STEPS: Final = 19
"""Steps of a flight between storeys, of 17 cm each."""
_STEP_M: Final = 0.17
_HEADROOM_M: Final = 2.0
_WALL_M: Final = 2.5
_LONGEST_NAME: Final = 64
_MOST_CORNERS: Final = 500
_LEAST_AREA_M2: Final = 1e-4


def scene_of_plan(
    storeys: Sequence[Storey], name: str, scale: float = 1.0, recentre: bool = False
) -> Scene:
    """The scene of the storeys, the first on the ground.

    Where a storey says what can be walked, all else within the bounds is solid on the ground and
    open air above it. Storeys are as high as they say, the lowest at 0, else one above the other.

    Raises
    ------
    UsageError
        It is no scene: too large, or of too many parts.
    """
    storeys = [each for storey in storeys for each in (storey, *storey.above)]
    heights = _heights(storeys, scale)
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
    mover = _Mover(scale, moved, heights[0] if storeys[0].height_m is not None else 0.0)
    slopes = [slope for storey in storeys for slope in storey.slopes]
    below: Storey | None = None
    for number, storey in enumerate(storeys):
        floor_m = heights[number] - mover.lowest_m
        place = _Place(number, floor_m, bounds, len(storeys) > 1)
        sloping = _sloping(slopes, floor_m, mover)
        _add_storey(parts, storey, place, mover, _shafts(below, mover), sloping)
        if number + 1 < len(storeys):
            parts["stairs"] += [
                {
                    **mover.line(flight),
                    "width_m": width * scale,
                    "bottom_m": floor_m,
                    "top_m": heights[number + 1] - mover.lowest_m,
                    "steps": _STEPS,
                }
                for flight, width in storey.stairs
            ]
        elif storey.stairs:
            storey.remarks.append("its stairs lead to no storey above: they are left out")
        below = storey
    for slope in slopes:
        _add_slope(parts, slope, mover)
    try:
        return Scene.model_validate(
            {
                "name": name[:_LONGEST_NAME],
                "bounds": bounds,
                "origin_m": (*moved, mover.lowest_m),
                **parts,
            }
        )
    except ValidationError as error:
        faults = scene_faults(error)
        more = f" and {len(faults) - 3} others" if len(faults) > 3 else ""
        hint = (
            "; is its unit right? --unit or --scale say otherwise"
            if "may measure" in faults[0]
            else ""
        )
        raise UsageError(f"it makes no scene: {'; '.join(faults[:3])}{more}{hint}") from None


def _heights(storeys: Sequence[Storey], scale: float) -> list[float]:
    """The heights of the floors, metres."""
    return [
        number * STOREY_M if storey.height_m is None else storey.height_m * scale
        for number, storey in enumerate(storeys)
    ]


def _sloping(slopes: Sequence[Slope], floor_m: float, mover: _Mover) -> Any:
    """The area that slopes take of a floor, for they rise from it or through it; None without."""
    shapely = library("shapely", "plans")
    taken = [
        mover.area(slope.area)
        for slope in slopes
        if mover.height(slope.bottom_m) < floor_m + _WALL_M
        and mover.height(slope.top_m) > floor_m - _HEADROOM_M
    ]
    return shapely.union_all(taken) if taken else None


def _add_slope(parts: dict[str, list[Any]], slope: Slope, mover: _Mover) -> None:
    """Add a flight of stairs, or a solid whose top is a ramp."""
    bottom_m, top_m = mover.height(slope.bottom_m), mover.height(slope.top_m)
    line = mover.line((slope.low, slope.high))
    if slope.width_m:
        steps = max(1, min(500, round((top_m - bottom_m) / _STEP_M)))
        width = slope.width_m * mover.scale
        flight = {"width_m": width, "bottom_m": bottom_m, "top_m": top_m, "steps": steps}
        parts["stairs"].append({**line, **flight})
        return
    under_m = max(0.0, bottom_m - _SLAB_M)
    ramp = {**line, "start_height_m": bottom_m - under_m}
    parts["polygons"] += [
        {"kind": "floor", "offset_m": under_m, "height_m": top_m - under_m, "points": ring,
         "ramp": ramp}
        for ring in rings_without_holes(mover.area(slope.area))
    ]  # fmt: skip


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

    def __init__(self, scale: float, moved: tuple[int, int], lowest_m: float) -> None:
        self.scale = scale
        self.lowest_m = lowest_m
        self._moved = moved

    def height(self, z: float) -> float:
        return round(z * self.scale - self.lowest_m, 6)

    def point(self, point: Point) -> Point:
        x, y = (round(self.scale * c - m, 6) for c, m in zip(point, self._moved, strict=True))
        return x, y

    def line(self, line: Line) -> dict[str, Point]:
        return {"start": self.point(line[0]), "end": self.point(line[1])}

    def area(self, area: Any) -> Any:
        shapely = library("shapely", "plans")
        return shapely.transform(area, lambda c: c[:, :2] * self.scale - self._moved)


class _Place(NamedTuple):
    """Where a storey is in the scene."""

    number: int
    floor_m: float
    bounds: tuple[int, int, int, int]
    several: bool


def _add_storey(
    parts: dict[str, list[Any]],
    storey: Storey,
    place: _Place,
    mover: _Mover,
    shafts: Any,
    sloping: Any,
) -> None:
    number, floor_m, bounds, several = place
    prefix = f"{storey.name} " if several else ""
    area = None if storey.walkable is None else mover.area(storey.walkable)
    shapely = library("shapely", "plans")
    if area is None and number:
        area = shapely.box(*bounds)
    if number:
        for opening in (shafts, sloping):
            area = area if opening is None or area is None else area.difference(opening)
        parts["polygons"] += [
            {"kind": "floor", "offset_m": floor_m - _SLAB_M, "height_m": _SLAB_M, "points": ring}
            for ring in rings_without_holes(area)
        ]
    if area is not None and not number:
        solid = shapely.box(*bounds).difference(area)
        parts["polygons"] += [
            {"kind": "wall", "height_m": _WALL_M, "points": ring}
            for ring in rings_without_holes(solid if sloping is None else solid.difference(sloping))
        ]
    elif area is not None and storey.edged:
        storey.walls += _edges(storey.walkable)
    standing = {"offset_m": floor_m}
    parts["walls"] += [
        {**mover.line(wall), **standing, "height_m": _WALL_M} for wall in storey.walls
    ]
    parts["doors"] += [
        {"name": name, **mover.line(door), **standing}
        for name, (_, door) in zip(_names(prefix, storey.doors), storey.doors, strict=True)
    ]
    parts["places"] += [
        {"name": name, "position": mover.point(point), "z_m": floor_m}
        for name, (_, point) in zip(_names(prefix, storey.points), storey.points, strict=True)
    ]


def _names(prefix: str, named: Sequence[tuple[str, Any]]) -> list[str]:
    """Names that differ: where a plan has one twice, the later ones are numbered."""
    found: dict[str, None] = {}
    for name, _ in named:
        own = f"{prefix}{name}"[:_LONGEST_NAME]
        number = 2
        while own in found:
            own = f"{f'{prefix}{name}'[: _LONGEST_NAME - 6]} {number}"
            number += 1
        found[own] = None
    return list(found)


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
