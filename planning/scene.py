"""A scene: what stands where, read from JSON and checked before anything uses it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    StringConstraints,
    model_validator,
)

MAX_EXTENT_M = 650.0
"""Longest side of a scene. Positions on the wire are 16-bit centimetres."""

Metres = Annotated[float, Field(allow_inf_nan=False, ge=-1e6, le=1e6)]
Point = tuple[Metres, Metres]
Bounds = tuple[Metres, Metres, Metres, Metres]
Name = Annotated[str, StringConstraints(strip_whitespace=True, max_length=64)]


def _twice_area(points: tuple[Point, ...]) -> float:
    ring = zip(points, points[1:] + points[:1], strict=True)
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in ring)


def _crossing_edges(points: tuple[Point, ...]) -> tuple[int, int] | None:
    """Indices of two edges of the ring that cross or touch although they are not neighbours."""
    n = len(points)
    for i in range(n):
        for j in range(i + 2, n - (i == 0)):
            if _segments_meet(points[i], points[(i + 1) % n], points[j], points[(j + 1) % n]):
                return i, j
    return None


def _segments_meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    def side(p: Point, q: Point, r: Point) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    def between(p: Point, q: Point, r: Point) -> bool:
        return min(p[0], q[0]) <= r[0] <= max(p[0], q[0]) and (
            min(p[1], q[1]) <= r[1] <= max(p[1], q[1])
        )

    s1, s2, s3, s4 = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    if s1 * s2 < 0 and s3 * s4 < 0:
        return True
    return (
        (s1 == 0 and between(a, b, c))
        or (s2 == 0 and between(a, b, d))
        or (s3 == 0 and between(c, d, a))
        or (s4 == 0 and between(c, d, b))
    )


def _simple_ring(points: tuple[Point, ...]) -> tuple[Point, ...]:
    if abs(_twice_area(points)) < 1e-6:
        raise ValueError("the polygon has no area")
    crossing = _crossing_edges(points)
    if crossing:
        i, j = crossing
        raise ValueError(f"the polygon crosses itself: edge {i} meets edge {j}")
    return points


Ring = Annotated[tuple[Point, ...], Field(min_length=3), AfterValidator(_simple_ring)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Polygon(_Part):
    """A prism over a polygon on the ground plane."""

    points: Ring
    """Corners in order, metres. The ring closes itself; it must not cross itself."""
    height_m: Annotated[float, Field(gt=0.0, le=500.0)]
    """From its underside to its top."""
    offset_m: Annotated[float, Field(ge=0.0, le=500.0)] = 0.0
    """Clearance of its underside above the ground."""
    kind: Literal["building", "wall", "furniture", "plant", "water"] = "building"
    """What it is drawn as. Every kind is an obstacle."""
    name: Name = ""


class Wall(_Part):
    """A thin vertical wall between two points."""

    start: Point
    end: Point
    height_m: Annotated[float, Field(gt=0.0, le=500.0)] = 2.5

    @model_validator(mode="after")
    def _has_length(self) -> Self:
        if math.dist(self.start, self.end) < 1e-6:
            raise ValueError("the wall has no length")
        return self


class Spawn(_Part):
    """Where avatars come into the world: anywhere free within `radius_m` of the position."""

    position: Point
    layer: Annotated[int, Field(ge=0, le=255)] = 0
    radius_m: Annotated[float, Field(ge=0.0, le=50.0)] = 1.0


class Place(_Part):
    """A point with a name, for behaviours and for people to speak of."""

    name: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=64)]
    position: Point
    layer: Annotated[int, Field(ge=0, le=255)] = 0


class Scene(_Part):
    """The static world: bounds, obstacles, spawn points and named places.

    The bounds are the edge of the walkable ground: centres of avatars stay inside them.
    Read one with `Scene.model_validate_json(text)`; a broken file raises
    `pydantic.ValidationError` (a `ValueError`) that names every fault and its place.
    """

    name: Name = "scene"
    bounds: Bounds
    """x0, y0, x1, y1 in metres, x to the east and y to the north."""
    polygons: tuple[Polygon, ...] = ()
    walls: tuple[Wall, ...] = ()
    spawns: tuple[Spawn, ...] = ()
    places: tuple[Place, ...] = ()

    @property
    def layers(self) -> int:
        """Number of layers; a scene of polygons that stand on the ground has one."""
        return 1

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        x0, y0, x1, y1 = self.bounds
        if not (x0 < x1 and y0 < y1):
            raise ValueError(f"bounds: x0 < x1 and y0 < y1 must hold, got {self.bounds}")
        if max(x1 - x0, y1 - y0) > MAX_EXTENT_M:
            raise ValueError(f"bounds: a side may measure {MAX_EXTENT_M:g} m, got {self.bounds}")
        for group, points in (
            ("spawns", [(s.position, s.layer) for s in self.spawns]),
            ("places", [(p.position, p.layer) for p in self.places]),
        ):
            for i, ((x, y), layer) in enumerate(points):
                if not (x0 <= x <= x1 and y0 <= y <= y1):
                    raise ValueError(f"{group}.{i}: ({x:g}, {y:g}) lies outside the bounds")
                if layer >= self.layers:
                    raise ValueError(f"{group}.{i}: there is no layer {layer}")
        names = [place.name for place in self.places]
        for i, name in enumerate(names):
            if name in names[:i]:
                raise ValueError(f"places.{i}: the name {name!r} is taken")
        return self

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
        for place in self.places:
            if place.name == name:
                return place
        known = ", ".join(p.name for p in self.places) or "none"
        raise KeyError(f"no place named {name!r}; the scene has: {known}")
