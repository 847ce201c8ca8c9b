"""Well-known text and GeoJSON: polygons are where one can walk, lines are walls or doors."""

from __future__ import annotations

import json
import math
import re
from typing import Any, Final

from esplanade.files.text import decoded
from esplanade.scenery.plans.storey import Storey, library

METRES_A_DEGREE: Final = 111_319.49
MAX_VALUES: Final = 3_000_000
STAIRS: Final = ("stairs", "stair", "steps", "staircase")
_WIDTH_M: Final = 1.5
_WRONG: Final = (AttributeError, KeyError, TypeError, IndexError, ValueError)
_MOST_DEGREES: Final = 0.02
"""Plans that measure less and lie within the degrees of the earth are degrees, as GeoJSON says."""


def read_wkt(data: bytes, name: str) -> Storey:
    """The storey of a text with one or more geometries, each in a line or over several."""
    shapely = library("shapely", "plans")
    text = " ".join(
        line
        for line in decoded(data, eight_bit=True).text.split("\n")
        if not line.lstrip().startswith("#")
    )
    storey = Storey(name)
    areas: list[Any] = []
    for number, part in enumerate(_geometries(text), 1):
        try:
            geometry = shapely.from_wkt(part)
        except shapely.errors.GEOSException as error:
            raise ValueError(f"geometry {number}: {error}") from None
        _take(geometry, {}, storey, areas)
    storey.walkable = shapely.union_all(areas) if areas else None
    return storey


def _geometries(text: str) -> list[str]:
    """The geometries of a text, each with its brackets."""
    found, depth, start = [], 0, 0
    for bracket in re.finditer(r"[()]", text):
        place = bracket.start()
        if bracket.group() == "(":
            depth += 1
        else:
            depth -= 1
            if depth == 0:
                part = text[start : place + 1].strip(" ;,\t")
                found.append(part.partition(";")[2] if part.upper().startswith("SRID") else part)
                start = place + 1
    if depth or text[start:].strip(" ;,\t"):
        raise ValueError("a bracket of it is not closed, or its end is no geometry")
    return found


def read_geojson(data: bytes, name: str) -> Storey:
    """The storey of a GeoJSON file; coordinates in degrees become metres around its middle."""
    shapely = library("shapely", "plans")
    geometry_of = library("shapely.geometry", "plans").shape
    if sum(data.count(mark) for mark in (b",", b"[", b"{")) > MAX_VALUES:
        raise ValueError(f"it has more than {MAX_VALUES} values")
    try:
        content = json.loads(decoded(data).text)
    except RecursionError:
        raise ValueError("its brackets are too deep") from None
    features = content.get("features", [content]) if isinstance(content, dict) else []
    if not isinstance(features, list):
        raise ValueError("its features are no list")  # noqa: TRY004
    storey = Storey(name)
    read = []
    for number, feature in enumerate(features):
        try:
            own = feature.get("geometry", feature) if "type" in feature else None
            if own is not None:
                read.append((geometry_of(own), feature.get("properties") or {}))
        except (*_WRONG, shapely.errors.ShapelyError) as error:
            raise ValueError(f"features.{number}: it is no geometry: {error}") from None
    box = shapely.total_bounds([geometry for geometry, _ in read])
    x0, y0, x1, y1 = box.tolist()
    within = abs(x0) <= 180 and abs(x1) <= 180 and abs(y0) <= 90 and abs(y1) <= 90
    if within and max(x1 - x0, y1 - y0) < _MOST_DEGREES:
        x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
        scales = METRES_A_DEGREE * math.cos(math.radians(y)), METRES_A_DEGREE
        read = [
            (shapely.transform(geometry, lambda c: (c[:, :2] - (x, y)) * scales), properties)
            for geometry, properties in read
        ]
        storey.remarks.append(
            f"its coordinates are degrees; ({x:.6f}, {y:.6f}) becomes the origin, in metres"
        )
    areas: list[Any] = []
    for geometry, properties in read:
        _take(geometry, properties, storey, areas)
    storey.walkable = shapely.union_all(areas) if areas else None
    return storey


def _take_polygon(geometry: Any, kind: str, storey: Storey, areas: list[Any]) -> None:
    if not geometry.is_valid:
        raise ValueError(f"a polygon crosses itself near {geometry.centroid.wkt}")
    if kind in ("obstacle", "wall", "building", "furniture", "solid"):
        for ring in (geometry.exterior, *geometry.interiors):
            storey.add_path([(x, y) for x, y, *_ in ring.coords])
        return
    areas.append(geometry)
    if kind in STAIRS:
        storey.remarks.append(
            "an area of stairs is taken as level: a line from foot to head is a flight"
        )


def _width(properties: Any) -> float:
    """The width of a flight, metres."""
    try:
        width = float(properties.get("width_m", properties.get("width", _WIDTH_M)))
    except (TypeError, ValueError):
        return _WIDTH_M
    return width if 0.3 <= width <= 100.0 else _WIDTH_M


def _take(geometry: Any, properties: Any, storey: Storey, areas: list[Any]) -> None:
    """Add a geometry to a storey by its type, and by `kind`, `type` or `class` of it."""
    kind = next(
        (str(properties[k]).lower() for k in ("kind", "type", "class") if k in properties), ""
    )
    name = str(properties.get("name", ""))
    match geometry.geom_type:
        case "Polygon":
            _take_polygon(geometry, kind, storey, areas)
        case "LineString" | "LinearRing":
            points = [(x, y) for x, y, *_ in geometry.coords]
            if kind in STAIRS:
                storey.stairs.append(((points[0], points[-1]), _width(properties)))
            elif kind == "door":
                number = len(storey.doors) + 1
                storey.doors.append((name or f"door {number}", (points[0], points[-1])))
            else:
                storey.add_path(points)
        case "Point":
            storey.points.append(
                (name or f"place {len(storey.points) + 1}", geometry.coords[0][:2])
            )
        case _:
            for part in geometry.geoms:
                _take(part, properties, storey, areas)
