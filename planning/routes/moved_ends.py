"""Starts and goals that had to be moved to where a body fits: how far, and why."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Final

import numpy as np

from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.ground._surface_kernels import top_at
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.heights import SAME_SURFACE_M

TOLD_M: Final = 0.25
"""Nothing is said of a start or goal that is moved by no more than this."""

_KNEES_M: Final = 0.4
"""A solid that ends below this above the ground is a step, not a wall."""


class MoveReason(IntEnum):
    """Why a body cannot begin or end where it was told to."""

    INSIDE_WALL = 1
    """The point lies inside a wall or solid, or so close that no body's centre may be there."""
    NEAR_WALL = 2
    """The point is free, but nearer to a wall or a drop than the body's radius."""
    NO_GROUND = 3
    """There is no floor at the point within a metre of its height, or too little headroom."""
    OTHER_REGION = 4
    """The body fits there, but no way leads there."""


@dataclass(frozen=True)
class MovedEnd:
    """A start or goal that was moved by more than `TOLD_M`."""

    distance_m: float
    reason: MoveReason
    asked: tuple[float, float, float]
    place: tuple[float, float, float]
    """The place that it was moved to; x, y and height of the floor."""

    def __str__(self) -> str:
        return f"moved by {self.distance_m:.2f} m, as the point {_TEXTS[self.reason]}"


_TEXTS: Final = {
    MoveReason.INSIDE_WALL: "is inside a wall or solid",
    MoveReason.NEAR_WALL: "is too near a wall or a drop",
    MoveReason.NO_GROUND: "has no floor to stand on",
    MoveReason.OTHER_REGION: "is in a region that no way leads to",
}


def moved_end(
    grid: LayeredGrid,
    body: Body,
    asked: tuple[float, float, float],
    place: tuple[float, float, float],
) -> MovedEnd | None:
    """The move of a start or goal from the point asked for; None if by no more than `TOLD_M`."""
    away_m = math.dist(asked[:2], place[:2])
    if away_m <= TOLD_M:
        return None
    return MovedEnd(away_m, _why(grid, body, asked), asked, place)


def _why(grid: LayeredGrid, body: Body, asked: tuple[float, float, float]) -> MoveReason:
    x, y, z = asked
    layered = grid.layered
    row = min(layered.ny - 1, max(0, int((y - layered.y0) / layered.cell_m)))
    column = min(layered.nx - 1, max(0, int((x - layered.x0) / layered.cell_m)))
    pages = layered.pages[:, row >> 3, column >> 3]
    cells = pages[pages >= 0] + ((row & 7) << 3) + (column & 7)
    floors = layered.floors[cells]
    floors = floors[~np.isnan(floors)].astype(np.float64)
    if not len(floors) or np.abs(floors - z).min() > SAME_SURFACE_M:
        # Where all floors of the column are above, the point is inside of what carries them.
        above = len(floors) > 0 and floors.min() > z
        inside = above or _in_a_solid(grid, row * layered.nx + column, asked)
        return MoveReason.INSIDE_WALL if inside else MoveReason.NO_GROUND
    if _in_a_solid(grid, row * layered.nx + column, asked):
        return MoveReason.INSIDE_WALL
    room_m = float(grid.clearance([(x, y)], [z], body)[0])
    if room_m == -np.inf:
        return MoveReason.NO_GROUND
    return MoveReason.NEAR_WALL if room_m < body.radius_m else MoveReason.OTHER_REGION


def _in_a_solid(grid: LayeredGrid, column: int, asked: tuple[float, float, float]) -> bool:
    """Whether a body's legs would be inside a solid of a scene of polygons."""
    x, y, z = asked
    columns = grid.surfaces.solids
    if column + 1 >= len(columns.starts):
        return False
    members = columns.members[columns.starts[column] : columns.starts[column + 1]]
    knees_m = z + _KNEES_M
    return any(
        float(columns.solids.bottoms[k]) <= knees_m < top_at(columns.solids, k, x, y)
        for k in members.tolist()
    )
