"""Well-known text and GeoJSON: polygons are where one can walk, lines are walls or doors."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from typing import Any, Final

from esplanade.files.text import decoded
from esplanade.scenery.plans.storey import Storey, library

METRES_A_DEGREE: Final = 111_319.49
MAX_VALUES: Final = 3_000_000
STAIRS: Final = ("stairs", "stair", "steps", "staircase")
_WIDTH_M: Final = 1.5
_WRONG: Final = (AttributeError, KeyError, TypeError, IndexError, ValueError)
_MOST_DEGREES: Final = 0.5
"""Plans that measure less and lie within the degrees of the earth are degrees, as GeoJSON says."""
_GLOBE: Final = ("4326", "CRS84")
"""Systems of longitudes and latitudes end so."""
_MERCATOR: Final = ("3857", "900913")
_EARTH_M: Final = 6_378_137.0
_PARTS: Final = re.compile(r"([A-Za-z]{4,})|(?<=\()[^()]+(?=\))")
"""Names of geometries, and the points in the innermost brackets."""
_SYSTEM: Final = re.compile(r"SRID\s*=\s*(\d+)\s*;\s*", re.IGNORECASE)
_EMPTY: Final = re.compile(r"\b[A-Z]+(?:\s+(?:Z|M|ZM))?\s+EMPTY\b(?!\s*[,)])", re.IGNORECASE)
_SOLID: Final = ("obstacle", "wall", "building", "furniture", "solid", "pillar", "column", "hole")
_FLOORS: Final = ("", "floor", "area", "room", "zone", "walkable", "ground", "corridor", "hall")
_WALLS: Final = ("", "window", "fence", "railing", "barrier")
_MOST_REMARKS: Final = 12


def read_wkt(data: bytes, name: str) -> Storey:
    """The storey of a text with one or more geometries, each in a line or over several."""
    shapely = library("shapely", "plans")
    text = " ".join(
        line
        for line in decoded(data, eight_bit=True).text.split("\n")
        if not line.lstrip().startswith(("#", "--", "//"))
    )
    read: list[tuple[Any, Any]] = []
    systems: set[str] = set()
    for number, (system, part) in enumerate(_geometries(text), 1):
        systems.add(system)
        try:
            geometry = shapely.from_wkt(_with_closed_rings(part))
        except shapely.errors.GEOSException as error:
            raise ValueError(f"geometry {number}: {error}") from None
        read.append((geometry, {}))
    if len(systems) > 1:
        raise ValueError(
            f"its geometries have different systems: SRID {', '.join(sorted(systems))}"
        )
    return _storey_of(name, read, next(iter(systems), ""))


def _with_closed_rings(geometry: str) -> str:
    """A geometry in which the rings of polygons come back to their first points."""
    kind = ""

    def closed(found: re.Match[str]) -> str:
        nonlocal kind
        if found[1]:
            kind = found[1].upper()
            return found[0]
        first, _, rest = found[0].partition(",")
        is_open = "," in rest and first.split() != rest.rpartition(",")[2].split()
        return f"{found[0]}, {first}" if is_open and kind.endswith("POLYGON") else found[0]

    return _PARTS.sub(closed, geometry)


def _geometries(text: str) -> list[tuple[str, str]]:
    """The geometries of a text, each with the SRID before it and with its brackets."""
    found: list[tuple[str, str]] = []
    depth, start = 0, 0
    text = _EMPTY.sub(" ", text)
    for bracket in re.finditer(r"[()]", text):
        place = bracket.start()
        if bracket.group() == "(":
            depth += 1
        else:
            depth -= 1
            if depth == 0:
                part = text[start : place + 1].strip(" ;,\t")
                system = _SYSTEM.match(part)
                found.append((system[1], part[system.end() :]) if system else ("", part))
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
        content = json.loads(decoded(data, eight_bit=True).text)
    except RecursionError:
        raise ValueError("its brackets are too deep") from None
    features = content.get("features", [content]) if isinstance(content, dict) else []
    if not isinstance(features, list):
        raise ValueError("its features are no list")  # noqa: TRY004
    read = []
    for number, feature in enumerate(features):
        try:
            own = feature.get("geometry", feature) if "type" in feature else None
            if own is not None:
                read.append((geometry_of(own), feature.get("properties") or {}))
        except (*_WRONG, shapely.errors.ShapelyError) as error:
            raise ValueError(f"features.{number}: it is no geometry: {error}") from None
    return _storey_of(name, read, _system_of(content))


def _system_of(content: Any) -> str:
    """The name of the system of coordinates; empty where the file names none."""
    system = content.get("crs") if isinstance(content, dict) else None
    known = system.get("properties") if isinstance(system, dict) else None
    return str(known.get("name", "")) if isinstance(known, dict) else ""


def _storey_of(name: str, read: list[tuple[Any, Any]], system: str) -> Storey:
    """The storey of geometries with their properties, made metres as their system wants it."""
    shapely = library("shapely", "plans")
    storey = Storey(name)
    x0, y0, x1, y1 = shapely.total_bounds([geometry for geometry, _ in read]).tolist()
    within = abs(x0) <= 180 and abs(x1) <= 180 and abs(y0) <= 90 and abs(y1) <= 90
    small = max(x1 - x0, y1 - y0) < _MOST_DEGREES
    x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    middle, scales = (0.0, 0.0), (1.0, 1.0)
    if system.endswith(_GLOBE) or (not system and within and small):
        middle = x, y
        scales = METRES_A_DEGREE * math.cos(math.radians(y)), METRES_A_DEGREE
        storey.remarks.append(
            f"its coordinates are degrees; ({x:.6f}, {y:.6f}) becomes the origin, in metres"
        )
    elif system.endswith(_MERCATOR) and math.isfinite(y):
        share = 1.0 / math.cosh(y / _EARTH_M)
        scales = share, share
        storey.remarks.append(f"its system is Web Mercator: a unit is {share:.4f} m there")
    elif system:
        storey.remarks.append(f"its system of coordinates is {system:.60}: taken for metres")
    if scales != (1.0, 1.0):
        read = [
            (shapely.transform(geometry, lambda c: (c[:, :2] - middle) * scales), properties)
            for geometry, properties in read
        ]
    areas: list[Any] = []
    unknown: Counter[str] = Counter()
    for geometry, properties in read:
        _take(geometry, properties, storey, areas, unknown)
    storey.walkable = shapely.union_all(areas) if areas else None
    storey.remarks += [f"{count} {what}" for what, count in unknown.items()][:_MOST_REMARKS]
    return storey


def _take_polygon(
    geometry: Any, kind: str, storey: Storey, areas: list[Any], unknown: Counter[str]
) -> None:
    if not all(map(math.isfinite, geometry.bounds)) and not geometry.is_empty:
        raise ValueError("a corner of a polygon is not finite")
    if not geometry.is_valid:
        raise ValueError(f"a polygon crosses itself near {geometry.centroid.wkt}")
    if geometry.is_empty:
        return
    if kind in _SOLID:
        for ring in (geometry.exterior, *geometry.interiors):
            storey.add_path([(x, y) for x, y, *_ in ring.coords])
        return
    areas.append(geometry)
    if kind not in (*_FLOORS, *STAIRS):
        unknown[f"polygons of kind {kind!r:.40} are taken for floors"] += 1
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


def _take(
    geometry: Any, properties: Any, storey: Storey, areas: list[Any], unknown: Counter[str]
) -> None:
    """Add a geometry to a storey by its type, and by `kind`, `type` or `class` of it."""
    kind = next(
        (str(properties[k]).lower() for k in ("kind", "type", "class") if k in properties), ""
    )
    name = str(properties.get("name", ""))
    match geometry.geom_type:
        case "Polygon":
            _take_polygon(geometry, kind, storey, areas, unknown)
        case "LineString" | "LinearRing" if not geometry.is_empty:
            points = [(x, y) for x, y, *_ in geometry.coords]
            if kind in STAIRS:
                storey.stairs.append(((points[0], points[-1]), _width(properties)))
            elif kind == "door":
                number = len(storey.doors) + 1
                storey.doors.append((name or f"door {number}", (points[0], points[-1])))
            else:
                storey.add_path(points)
                if kind not in (*_WALLS, *_SOLID):
                    unknown[f"lines of kind {kind!r:.40} are taken for walls"] += 1
        case "Point" if not geometry.is_empty:
            storey.points.append(
                (name or f"place {len(storey.points) + 1}", geometry.coords[0][:2])
            )
        case _:
            for part in getattr(geometry, "geoms", ()):
                _take(part, properties, storey, areas, unknown)
