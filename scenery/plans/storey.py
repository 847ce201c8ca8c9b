"""One storey of a plan: where one can walk, and the walls, doors and points drawn in it."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, NamedTuple

from esplanade.commandline.errors import UsageError

Point = tuple[float, float]
Line = tuple[Point, Point]


class Slope(NamedTuple):
    """A floor that rises evenly from one line to another."""

    area: Any
    """A polygon of shapely."""
    low: Point
    """The middle of its foot."""
    high: Point
    """The middle of its head."""
    bottom_m: float
    top_m: float
    width_m: float
    """Of a flight of stairs; 0 for a ramp."""


@dataclass
class Storey:
    """One storey as a plan shows it, in metres."""

    name: str
    walkable: Any = None
    """A polygon or several of shapely; None where the plan only draws walls on open ground."""
    walls: list[Line] = field(default_factory=list)
    doors: list[tuple[str, Line]] = field(default_factory=list)
    points: list[tuple[str, Point]] = field(default_factory=list)
    stairs: list[tuple[Line, float]] = field(default_factory=list)
    """Flights to the storey above, from foot to head, with their widths."""
    height_m: float | None = None
    """The height of its floor, where the plan says it."""
    slopes: list[Slope] = field(default_factory=list)
    """Floors that rise from this storey or any above it."""
    above: list[Storey] = field(default_factory=list)
    """Further storeys of the same plan, each higher than the one before."""
    edged: bool = True
    """Whether there are walls along the edges of what can be walked above the ground."""
    remarks: list[str] = field(default_factory=list)
    """Remarks on things taken for granted or passed over, one sentence each."""

    def add_path(self, points: list[Point]) -> None:
        """Add the walls of a line of many points."""
        self.walls += [(a, b) for a, b in itertools.pairwise(points) if _apart(a, b)]

    def bounds(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1 of everything in it.

        Raises
        ------
        ValueError
            There is nothing.
        """
        ends = [point for wall in self.walls for point in wall]
        ends += [point for _, door in self.doors for point in door]
        ends += [point for _, point in self.points]
        ends += [point for flight, _ in self.stairs for point in flight]
        areas = [*(slope.area for slope in self.slopes), self.walkable]
        for area in areas:
            if area is not None and not area.is_empty:
                x0, y0, x1, y1 = area.bounds
                ends += [(x0, y0), (x1, y1)]
        if not ends:
            raise ValueError("it draws nothing that can be read")
        xs, ys = zip(*ends, strict=True)
        return min(xs), min(ys), max(xs), max(ys)


def _apart(a: Point, b: Point) -> bool:
    return abs(a[0] - b[0]) > 1e-6 or abs(a[1] - b[1]) > 1e-6


def library(name: str, wanted_for: str) -> Any:
    """A library of the extra `plans`.

    Raises
    ------
    UsageError
        It is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        raise UsageError(
            f"{wanted_for} need {name.partition('.')[0]}: pip install 'esplanade[plans]'"
        ) from None
