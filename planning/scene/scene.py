"""A scene and its parts, read from JSON and checked before anything uses them."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, Literal, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    StringConstraints,
    model_validator,
)

from esplanade.planning.scene.rings import crossing_edges, distinct_corners, twice_area

MAX_EXTENT_M = 650.0
"""Longest side of a scene. Positions on the wire are 16-bit centimetres."""

MAX_CORNERS = 1_000
"""Most corners of one polygon; to check that it does not cross itself takes their square."""
MAX_ALL_CORNERS = 100_000
"""Most corners of all polygons of a scene."""
MAX_SOLIDS = 30_000
"""Most polygons and treads of stairs."""
MAX_WALLS = 50_000
MAX_SPOTS = 2_000
"""Most doors, spawns or places."""
MAX_PORTALS = 64

Metres = Annotated[float, Field(allow_inf_nan=False, ge=-1e6, le=1e6)]
Point = tuple[Metres, Metres]
Origin = tuple[
    Annotated[float, Field(allow_inf_nan=False, ge=-1e9, le=1e9)],
    Annotated[float, Field(allow_inf_nan=False, ge=-1e9, le=1e9)],
    Annotated[float, Field(allow_inf_nan=False, ge=-1e9, le=1e9)],
]
Bounds = tuple[Metres, Metres, Metres, Metres]


def _printable(name: str) -> str:
    """A name without characters that steer a terminal or turn the direction of writing."""
    for place, character in enumerate(name):
        if unicodedata.category(character) in ("Cc", "Zl", "Zp") or character in _TURNING:
            raise ValueError(
                f"character {place + 1} is U+{ord(character):04X}, a control character"
            )
    return name


_TURNING = frozenset("\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")

Name = Annotated[
    str, StringConstraints(strip_whitespace=True, max_length=64), AfterValidator(_printable)
]
RequiredName = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=64),
    AfterValidator(_printable),
]


def _simple_ring(points: tuple[Point, ...]) -> tuple[Point, ...]:
    """The ring without points that repeat the one before, as where a file closes it."""
    places = distinct_corners(points)
    ring = tuple(points[place] for place in places)
    if len(ring) < 3 or abs(twice_area(ring)) < 1e-6:
        raise ValueError("the polygon has no area")
    crossing = crossing_edges(ring)
    if crossing:
        i, j = (places[edge] for edge in crossing)
        raise ValueError(f"the polygon crosses itself: edge {i} meets edge {j}")
    return ring


Ring = Annotated[
    tuple[Point, ...], Field(min_length=3, max_length=MAX_CORNERS), AfterValidator(_simple_ring)
]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)


class _Line(_Part):
    start: Point
    end: Point

    @model_validator(mode="after")
    def _has_length(self) -> Self:
        if math.dist(self.start, self.end) < 1e-6:
            raise ValueError(f"the {type(self).__name__.lower()} has no length")
        return self


class _Spot(_Part):
    position: Point
    z_m: Metres = 0.0
    """Height of the floor that is meant: the floor nearest to it."""


class Ramp(_Line):
    """A slope: the top of a polygon rises evenly along a line, and no further before and behind it.

    At its end the top is as high as the polygon.
    """

    start_height_m: Annotated[float, Field(ge=0.0, le=500.0)] = 0.0
    """Height of the polygon's top above its underside at the start."""


class Polygon(_Part):
    """A prism over a polygon on the ground plane. Its top can be stood on if it carries."""

    points: Ring
    """Corners in order, metres. The ring closes itself; it must not cross itself."""
    height_m: Annotated[float, Field(gt=0.0, le=500.0)]
    """Height of its top above its underside."""
    offset_m: Annotated[float, Field(ge=0.0, le=500.0)] = 0.0
    """Clearance of its underside above the ground."""
    ramp: Ramp | None = None
    """The slope of its top; the top is level without one."""
    kind: Literal["building", "floor", "wall", "furniture", "plant", "water"] = "building"
    """The kind of thing that is drawn. One can stand on buildings and floors, on nothing else."""
    name: Name = ""

    def top_at(self, x: float, y: float) -> float:
        """Height of its top at a point, metres above the ground."""
        top = self.offset_m + self.height_m
        if self.ramp is None:
            return top
        (ax, ay), (bx, by) = self.ramp.start, self.ramp.end
        along = (x - ax) * (bx - ax) + (y - ay) * (by - ay)
        share = min(1.0, max(0.0, along / ((bx - ax) ** 2 + (by - ay) ** 2)))
        low = self.offset_m + self.ramp.start_height_m
        return low + share * (top - low)

    @property
    def carries(self) -> bool:
        """Whether one can stand on top."""
        return self.kind in ("building", "floor")


class Wall(_Line):
    """A thin vertical wall between two points."""

    height_m: Annotated[float, Field(gt=0.0, le=500.0)] = 2.5
    offset_m: Annotated[float, Field(ge=0.0, le=500.0)] = 0.0
    """Height of its foot above the ground."""


class Door(_Line):
    """A wall that is there only while it is closed."""

    name: RequiredName
    height_m: Annotated[float, Field(gt=0.0, le=500.0)] = 2.2
    offset_m: Annotated[float, Field(ge=0.0, le=500.0)] = 0.0
    """Height of its foot above the ground."""
    open: bool = True
    """Its state when the world starts."""


class Stairs(_Line):
    """A straight flight of even steps from the middle of its foot to that of its head.

    It is solid below each tread.
    """

    width_m: Annotated[float, Field(gt=0.0, le=100.0)]
    bottom_m: Annotated[float, Field(ge=0.0, le=500.0)] = 0.0
    """Height of the floor that it rises from."""
    top_m: Annotated[float, Field(gt=0.0, le=500.0)]
    """Height of the last tread."""
    steps: Annotated[int, Field(ge=1, le=500)]

    @model_validator(mode="after")
    def _rises(self) -> Self:
        if self.top_m <= self.bottom_m:
            raise ValueError("the stairs end no higher than they begin: top_m > bottom_m must hold")
        return self

    def treads(self) -> tuple[Polygon, ...]:
        """A prism for each step, from the floor that the flight rises from to its tread."""
        (ax, ay), (bx, by) = self.start, self.end
        half = 0.5 * self.width_m / math.dist(self.start, self.end)
        sx, sy = half * (by - ay), half * (ax - bx)

        def across(share: float) -> tuple[Point, Point]:
            x, y = ax + share * (bx - ax), ay + share * (by - ay)
            return (x + sx, y + sy), (x - sx, y - sy)

        rise = (self.top_m - self.bottom_m) / self.steps
        edges = [across(k / self.steps) for k in range(self.steps + 1)]
        # Right by construction, so the checks of a polygon from a file are left out.
        return tuple(
            Polygon.model_construct(
                points=(edges[k][0], edges[k + 1][0], edges[k + 1][1], edges[k][1]),
                offset_m=self.bottom_m,
                height_m=(k + 1) * rise,
                kind="floor",
            )
            for k in range(self.steps)
        )


class Spawn(_Spot):
    """Avatars come into the world anywhere free within `radius_m` of the position."""

    radius_m: Annotated[float, Field(ge=0.0, le=50.0)] = 1.0
    view: Point | None = None
    """The place that a page shows to those who come in here first; without it, the page chooses."""


class Place(_Spot):
    """A point with a name, for behaviours and for people to speak of."""

    name: RequiredName


class Portal(_Part):
    """An area of a floor from which one goes to another zone; a world file says to which."""

    name: RequiredName
    points: Ring
    """Corners of the area in order, metres. The ring closes itself; it must not cross itself."""
    z_m: Metres = 0.0
    """Height of the floor that is meant: the floor nearest to it."""
    arrival: Point | None = None
    """The point at which those stand who come out of it; without it, the middle of its corners."""

    @property
    def arrival_place(self) -> tuple[float, float, float]:
        """The place x, y, z, metres, nearest to which those stand who come out of it."""
        if self.arrival is not None:
            return (*self.arrival, self.z_m)
        xs, ys = zip(*self.points, strict=True)
        return sum(xs) / len(xs), sum(ys) / len(ys), self.z_m


class Scene(_Part):
    """The static world: bounds, obstacles, spawn points, named places and portals.

    The bounds are the edge of the walkable ground: centres of avatars stay inside them.
    Read one with `Scene.model_validate_json(text)`; a broken file raises
    `pydantic.ValidationError` (a `ValueError`) that names every fault and its place.
    """

    name: Name = "scene"
    bounds: Bounds
    """x0, y0, x1, y1 in metres, x to the east and y to the north."""
    polygons: Annotated[tuple[Polygon, ...], Field(max_length=MAX_SOLIDS)] = ()
    walls: Annotated[tuple[Wall, ...], Field(max_length=MAX_WALLS)] = ()
    stairs: Annotated[tuple[Stairs, ...], Field(max_length=MAX_SPOTS)] = ()
    doors: Annotated[tuple[Door, ...], Field(max_length=MAX_SPOTS)] = ()
    spawns: Annotated[tuple[Spawn, ...], Field(max_length=MAX_SPOTS)] = ()
    places: Annotated[tuple[Place, ...], Field(max_length=MAX_SPOTS)] = ()
    portals: Annotated[tuple[Portal, ...], Field(max_length=MAX_PORTALS)] = ()
    mesh: Path | None = None
    """A building in metres, y up, whose floors take the place of the ground and of all parts. In a
    file it is named relative to the file."""
    origin_m: Annotated[Origin, Field(exclude=True)] = (0.0, 0.0, 0.0)
    """x, y, z of the scene's origin in the axes of the file that it was made of: x to the east, z
    up. Nobody but its author needs it."""
    schema_address: Annotated[str, Field(alias="$schema", max_length=1024, exclude=True)] = ""
    """The JSON Schema by which editors complete the file and mark faults."""

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        faults = (*self._wrong_bounds(), *self._outside(), *self._wrong_mesh(), *self._same_names())
        if faults:
            raise ValueError("\n".join(faults))
        return self

    def _wrong_bounds(self) -> Iterator[str]:
        x0, y0, x1, y1 = self.bounds
        if not (x0 < x1 and y0 < y1):
            yield f"bounds: x0 < x1 and y0 < y1 must hold, got {self.bounds}"
        elif max(x1 - x0, y1 - y0) > MAX_EXTENT_M:
            yield f"bounds: a side may measure {MAX_EXTENT_M:g} m, got {self.bounds}"

    def _outside(self) -> Iterator[str]:
        x0, y0, x1, y1 = self.bounds
        if not (x0 < x1 and y0 < y1):
            return
        for group, spots in (
            ("spawns", [(each.position, each.view or each.position) for each in self.spawns]),
            ("places", [(each.position,) for each in self.places]),
        ):
            for i, points in enumerate(spots):
                for x, y in dict.fromkeys(points):
                    if not (x0 <= x <= x1 and y0 <= y <= y1):
                        yield f"{group}.{i}: ({x:g}, {y:g}) lies outside the bounds"
        for i, portal in enumerate(self.portals):
            for x, y in (*portal.points, portal.arrival_place[:2]):
                if not (x0 <= x <= x1 and y0 <= y <= y1):
                    yield f"portals.{i}: ({x:g}, {y:g}) lies outside the bounds"

    def _wrong_mesh(self) -> Iterator[str]:
        for group in ("polygons", "walls", "stairs", "doors"):
            if self.mesh is not None and getattr(self, group):
                yield f"{group}: a scene of a mesh has none"

    def _same_names(self) -> Iterator[str]:
        for group, names in (
            ("doors", [door.name for door in self.doors]),
            ("places", [place.name for place in self.places]),
            ("portals", [portal.name for portal in self.portals]),
        ):
            known: set[str] = set()
            for i, name in enumerate(names):
                if name in known:
                    yield f"{group}.{i}: the name {name!r} is taken"
                known.add(name)

    @model_validator(mode="after")
    def _has_bounded_parts(self) -> Self:
        corners = sum(len(polygon.points) for polygon in self.polygons)
        if corners > MAX_ALL_CORNERS:
            raise ValueError(
                f"polygons: they have {corners} corners in all, {MAX_ALL_CORNERS} are possible"
            )
        solids = len(self.polygons) + sum(flight.steps for flight in self.stairs)
        if solids > MAX_SOLIDS:
            raise ValueError(
                f"there are {solids} polygons and treads of stairs, {MAX_SOLIDS} are possible"
            )
        return self

    def solids(self) -> tuple[Polygon, ...]:
        """Everything that fills space: the polygons, and the treads of stairs."""
        treads = [tread for flight in self.stairs for tread in flight.treads()]
        return (*self.polygons, *treads)

    @classmethod
    def open_space(
        cls,
        bounds: Bounds,
        walls: Iterable[tuple[Point, Point]] = (),
        polygons: Iterable[Polygon] = (),
        name: str = "open space",
    ) -> Self:
        """A scene of bare ground with thin walls, e.g. around a recorded crowd.

        `bounds` are x0, y0, x1, y1 in metres; each wall is ((x, y), (x, y)).
        """
        return cls(
            name=name,
            bounds=bounds,
            walls=tuple(Wall(start=start, end=end) for start, end in walls),
            polygons=tuple(polygons),
        )

    def place(self, name: str) -> Place:
        """The place of that name.

        Raises
        ------
        KeyError
            There is none; the message lists those that exist.
        """
        return _named("place", self.places, name)

    def portal(self, name: str) -> Portal:
        """The portal of that name.

        Raises
        ------
        KeyError
            There is none; the message lists those that exist.
        """
        return _named("portal", self.portals, name)


_Named = TypeVar("_Named", Place, Portal)


def _named(kind: str, parts: tuple[_Named, ...], name: str) -> _Named:
    for part in parts:
        if part.name == name:
            return part
    known = ", ".join(part.name for part in parts) or "none"
    raise KeyError(f"no {kind} named {name!r}; the scene has: {known}")
