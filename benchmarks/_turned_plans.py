"""Random plans of walls, doors, corridors and pillars, and shapely's judgement of the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np
from benchmarks._turned_scenes import WALL_M, Case, Point, Turn, scene_of
from shapely import LineString, MultiPolygon, Polygon, box, union_all
from shapely import Point as Spot

from esplanade.planning import Body

BAND_M: Final = 0.015
"""Nothing is asked where a body with a radius larger or smaller by this has another answer."""
ROOM_M: Final = 4.0
"""Half of the side of the room that everything stands in."""
_ROOM: Final = box(-ROOM_M, -ROOM_M, ROOM_M, ROOM_M)
ROOMS_M: Final = (BAND_M, 0.03, 0.05, 0.1)
"""Room on each side that a way has at least, or lacks at least."""
RADII_M: Final = (0.2, 0.25, 0.3, 0.35, 0.4)
"""Whole cells of Recast: it rounds others up."""
THIN_M: Final = (0.0, 0.1, 0.3, 1.5)
"""Thicknesses of walls; 0 is a wall without thickness."""
_HALF_M: Final = 6.5
_SEGMENTS: Final = 64
_FREE_M: Final = 0.1
"""Start and goal are at least so much further from everything than the body is wide."""

Random = np.random.Generator
Ring = tuple[Point, ...]
Line = tuple[Point, Point]


@dataclass(frozen=True)
class Plan:
    """Obstacles in a room, in the building's own coordinates, and the judgement."""

    kind: str
    rings: tuple[Ring, ...]
    lines: tuple[Line, ...]
    start: Point
    goal: Point
    radius_m: float
    has_way: bool
    room_m: float
    """A body so much larger still has a way, or one so much smaller has none: a value of
    `ROOMS_M`."""

    def turned(self, turn: Turn) -> Case:
        """The plan as a scene at an angle and an offset."""
        corners = list(_ROOM.exterior.coords)
        parts: dict[str, Any] = {
            "walls": [
                {"start": turn.at(*a), "end": turn.at(*b), "height_m": WALL_M}
                for a, b in (*pairwise(corners), *self.lines)
            ],
            "polygons": [
                {"points": turn.ring(ring), "height_m": WALL_M, "kind": "wall"}
                for ring in self.rings
            ],
        }
        start, goal = (*turn.at(*self.start), 0.0), (*turn.at(*self.goal), 0.0)
        return Case(scene_of(parts, _HALF_M), start, goal, Body(radius_m=self.radius_m))


def random_plan(random: Random) -> Plan:
    """A plan of a random kind whose judgement is the same for bodies of a little more and less."""
    kind = str(random.choice(list(KINDS)))
    while True:
        radius_m = float(random.choice(RADII_M))
        rings, lines = KINDS[kind](random, radius_m)
        ends = [(side * 3.2, float(random.uniform(-3.2, 3.2))) for side in (-1.0, 1.0)]
        obstacles = union_all([*map(Polygon, rings), *map(LineString, lines), _ROOM.exterior])
        if min(Spot(end).distance(obstacles) for end in ends) < radius_m + _FREE_M:
            continue
        has_way = _connected(obstacles, ends[0], ends[1], radius_m)
        sign = 1.0 if has_way else -1.0
        rooms = [
            room
            for room in ROOMS_M
            if _connected(obstacles, ends[0], ends[1], radius_m + sign * room) is has_way
        ]
        if rooms:
            return Plan(
                kind, tuple(rings), tuple(lines), ends[0], ends[1], radius_m, has_way, rooms[-1]
            )


def _connected(obstacles: Any, start: Point, goal: Point, radius_m: float) -> bool:
    """Whether a disc gets from one point to another."""
    free = _ROOM - obstacles.buffer(radius_m, quad_segs=_SEGMENTS)
    pieces = free.geoms if isinstance(free, MultiPolygon) else [free]
    return any(piece.covers(Spot(start)) and piece.covers(Spot(goal)) for piece in pieces)


# --- kinds of plans ---------------------------------------------------------------------------

Obstacles = tuple[list[Ring], list[Line]]


def _width(random: Random, radius_m: float) -> float:
    """A passage that is sometimes too narrow for a body, and sometimes just wide enough."""
    return 2.0 * radius_m + float(random.choice([*random.uniform(-0.15, 0.15, 2), 0.04, 0.3]))


def _rectangle(middle: Point, size: Point, degrees: float) -> Ring:
    a, c = 0.5 * size[0], 0.5 * size[1]
    return tuple(Turn(degrees, middle).rectangle(-a, -c, a, c))


def _wall(random: Random, radius_m: float, along: float, degrees: float) -> Obstacles:
    """A wall across the room with a door somewhere in it."""
    half, far = 0.5 * _width(random, radius_m), 6.0
    turn = Turn(degrees, (along, float(random.uniform(-2.0, 2.0))))
    thick = float(random.choice(THIN_M))
    spans = ((-far - 2.0, -half), (half, far + 2.0))
    if thick:
        return [tuple(turn.rectangle(-0.5 * thick, a, 0.5 * thick, b)) for a, b in spans], []
    return [], [(turn.at(0.0, a), turn.at(0.0, b)) for a, b in spans]


def _door(random: Random, radius_m: float) -> Obstacles:
    rings, lines = _wall(random, radius_m, 0.0, 0.0)
    if random.random() < 0.5:
        middle = float(random.uniform(-1.6, 1.6)), float(random.uniform(-2.5, 2.5))
        size = float(random.uniform(0.1, 0.6)), float(random.uniform(0.1, 0.6))
        rings.append(_rectangle(middle, size, float(random.uniform(0.0, 90.0))))
    return rings, lines


def _wings(random: Random, radius_m: float) -> Obstacles:
    """Two walls with doors that lie at different angles."""
    first = _wall(random, radius_m, -1.3, float(random.uniform(-18.0, 18.0)))
    second = _wall(random, radius_m, 1.3, float(random.uniform(-18.0, 18.0)))
    return first[0] + second[0], first[1] + second[1]


def _corridor(random: Random, radius_m: float) -> Obstacles:
    """A corridor with two bends through what is closed beside it."""
    y0, y1 = (float(v) for v in random.uniform(-1.5, 1.5, 2))
    middle = LineString([(-1.8, y0), (-0.6, y0), (0.6, y1), (1.8, y1)])
    half, lines = 0.5 * _width(random, radius_m), []
    for side, edge in ((1.0, ROOM_M), (-1.0, -ROOM_M)):
        curve = list(middle.offset_curve(side * half, join_style="mitre").coords)
        curve = [(curve[0][0], edge), *curve, (curve[-1][0], edge)]
        lines += pairwise(curve)
    return [], lines


def _pillars(random: Random, radius_m: float) -> Obstacles:
    """A row of pillars at odd angles across the room, and some anywhere."""
    rings, at = [], -ROOM_M
    while at < ROOM_M:
        size = float(random.uniform(0.15, 0.9)), float(random.uniform(0.15, 0.9))
        middle = float(random.uniform(-0.2, 0.2)), at + 0.5 * size[1]
        rings.append(_rectangle(middle, size, float(random.uniform(-25.0, 25.0))))
        at += size[1] + 2.0 * radius_m + float(random.uniform(-0.3, 0.12))
    for _ in range(int(random.integers(0, 4))):
        middle = float(random.uniform(-2.4, 2.4)), float(random.uniform(-3.0, 3.0))
        rings.append(_rectangle(middle, (0.4, 0.4), float(random.uniform(0.0, 90.0))))
    return rings, []


KINDS: Final[dict[str, Callable[[Random, float], Obstacles]]] = {
    "doors": _door,
    "wings": _wings,
    "corridors": _corridor,
    "pillars": _pillars,
}
