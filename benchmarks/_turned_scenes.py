"""Doors, flights of stairs and ramps at any angle and offset, and what planners are asked there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from esplanade.planning import Body, Scene

Point = tuple[float, float]
Point3 = tuple[float, float, float]

HALF_M: Final = 7.0
"""Half of the side of a scene."""
WALL_M: Final = 3.0
_FAR_M: Final = 12.0
_FLOOR_M: Final = 1.6


@dataclass(frozen=True)
class Turn:
    """The place of a building: turned to the left, and moved by a part of a cell."""

    degrees: float
    aside_m: Point = (0.0, 0.0)

    def at(self, along: float, across: float = 0.0) -> Point:
        """A point of the building on the map, metres."""
        cosine, sine = math.cos(math.radians(self.degrees)), math.sin(math.radians(self.degrees))
        x, y = along * cosine - across * sine, along * sine + across * cosine
        return self.aside_m[0] + x, self.aside_m[1] + y

    def ring(self, points: Sequence[Point]) -> list[Point]:
        """Several points of the building."""
        return [self.at(*point) for point in points]

    def rectangle(self, a0: float, c0: float, a1: float, c1: float) -> list[Point]:
        """A rectangle from a0 to a1 along the building, and from c0 to c1 across."""
        return self.ring([(a0, c0), (a1, c0), (a1, c1), (a0, c1)])


@dataclass(frozen=True)
class Case:
    """A way that is asked for."""

    scene: Scene
    start: Point3
    goal: Point3
    body: Body

    @property
    def back(self) -> Case:
        """The way back."""
        return Case(self.scene, self.goal, self.start, self.body)


def scene_of(parts: dict[str, Any], half_m: float = HALF_M) -> Scene:
    """A square around the origin with some parts."""
    return Scene.model_validate({"bounds": (-half_m, -half_m, half_m, half_m), **parts})


def flight(turn: Turn, width_m: float, body: Body, steps: int = 8, tread_m: float = 0.3) -> Case:
    """A flight of steps of 0.20 m up to a floor, and the way up."""
    half, top = 0.5 * steps * tread_m, 0.2 * steps
    stairs = {
        "start": turn.at(-half),
        "end": turn.at(half),
        "width_m": width_m,
        "top_m": top,
        "steps": steps,
    }
    floor = turn.rectangle(half, -2.0, half + 3.6, 2.0)
    scene = scene_of(
        {
            "stairs": [stairs],
            "polygons": [{"kind": "floor", "height_m": top, "points": floor}],
        },
        half + 7.0,
    )
    return Case(scene, (*turn.at(-half - 2.0), 0.0), (*turn.at(half + 1.6), top), body)


def low_flight(turn: Turn, steps: int, body: Body) -> Case:
    """A flight of wide, low steps to a landing, on all of which one counts as on an edge."""
    tread, rise = 0.3, 0.1
    half = 0.5 * steps * tread
    solids = [
        {
            "kind": "floor",
            "height_m": rise * (k + 1),
            "points": turn.rectangle(-half + k * tread, -0.8, half + 2.0, 0.8),
        }
        for k in range(steps)
    ]
    scene = scene_of({"polygons": solids}, half + 5.0)
    top = rise * steps
    return Case(scene, (*turn.at(-half - 1.5), 0.0), (*turn.at(half + 1.0), top), body)


def plank(turn: Turn, length_m: float, width_m: float, body: Body, around: bool) -> Case:
    """A kerb between two walls, on all of which one counts as on an edge, and the way over it.

    With `around` there is a level way past the end of one of the walls.
    """
    half, aside = 0.5 * length_m, 0.5 * width_m
    near, far = aside + 0.1, 2.0 * _FAR_M
    walls = [turn.rectangle(-half, -far, half, -near)]
    if around:
        walls += [
            turn.rectangle(-half, near, half, near + 3.0),
            turn.rectangle(-far, near + 4.2, far, near + 4.4),
        ]
    else:
        walls.append(turn.rectangle(-half, near, half, far))
    kerb = turn.rectangle(-half, -aside, half, aside)
    solids = [{"points": points, "height_m": WALL_M, "kind": "wall"} for points in walls]
    solids.append({"points": kerb, "height_m": 0.3, "kind": "floor"})
    scene = scene_of({"polygons": solids}, half + 7.0)
    ends = (*turn.at(-half - 1.6), 0.0), (*turn.at(half + 1.6), 0.0)
    return Case(scene, *ends, body)


def ramp(turn: Turn, width_m: float, body: Body) -> Case:
    """A ramp that rises by 1.6 m over 6 m to a floor, and the way up."""
    half = 0.5 * width_m
    solids = [
        {
            "kind": "floor",
            "height_m": _FLOOR_M,
            "points": turn.rectangle(-4.0, -half, 2.0, half),
            "ramp": {"start": turn.at(-4.0), "end": turn.at(2.0)},
        },
        {"kind": "floor", "height_m": _FLOOR_M, "points": turn.rectangle(2.0, -2.0, 5.0, 2.0)},
    ]
    scene = scene_of({"polygons": solids})
    return Case(scene, (*turn.at(-5.0), 0.0), (*turn.at(3.5), _FLOOR_M), body)


def doorway(turn: Turn, width_m: float, body: Body, thick_m: float = 0.1) -> Case:
    """A wall all across the scene, with a door in its middle."""
    half = 0.5 * width_m
    solids = [
        {"height_m": WALL_M, "points": turn.rectangle(-0.5 * thick_m, a, 0.5 * thick_m, b)}
        for a, b in ((-_FAR_M, -half), (half, _FAR_M))
    ]
    scene = scene_of({"polygons": solids})
    return Case(scene, (*turn.at(-3.0), 0.0), (*turn.at(3.0), 0.0), body)
