"""One way for one body through a layered scene: Huang & Li, from reachability to headings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from planning._footing import Footing
from planning._stability_kernels import FORBIDDEN
from planning._standing_kernels import stand
from planning.bodies import Body
from planning.footing import footing_of
from planning.stable_bfp import stable_bfp
from planning.straightening import headings, line_of_cells, straighten
from planning.wavefront import UNREACHED, spread_wave

if TYPE_CHECKING:
    from planning.grid import LayeredGrid

Point3 = tuple[float, float, float]


class PathStatus(IntEnum):
    """How the search for a way ended."""

    FOUND = 0
    NO_WAY = 1
    """The body fits at start and goal, but no legal way leads from one to the other."""
    START_BLOCKED = 2
    """The body fits nowhere within half a metre of the start."""
    GOAL_BLOCKED = 3
    """The body fits nowhere within half a metre of the goal."""


@dataclass(frozen=True, eq=False)
class LayeredPath:
    """A way over floors, with a point in every cell that it crosses; empty unless found."""

    status: PathStatus
    points: NDArray[np.float64]
    """(N, 3): x, y, and the height of the floor; metres."""
    layers: NDArray[np.int64]
    """(N,): the layer of each point."""
    headings: NDArray[np.float64]
    """(N,): where the body looks, radians from east toward north."""
    expansions: int = 0
    """States that the search looked at."""

    @property
    def length_m(self) -> float:
        """Length of the way, up and down included; 0 if there is none."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())


def _no_path(status: PathStatus, expansions: int = 0) -> LayeredPath:
    return LayeredPath(
        status, np.empty((0, 3)), np.empty(0, dtype=np.int64), np.empty(0), expansions
    )


def _checked(name: str, point: Point3, grid: LayeredGrid) -> Point3:
    coordinates = tuple(map(float, point))
    if len(coordinates) != 3 or not all(map(math.isfinite, coordinates)):
        raise ValueError(f"{name} must be three finite numbers x, y, z, got {point}")
    x, y, z = coordinates
    x0, y0, x1, y1 = grid.bounds
    if not (x0 <= x <= x1 and y0 <= y <= y1):
        raise ValueError(f"{name}: ({x:g}, {y:g}) lies outside the bounds {grid.bounds}")
    return x, y, z


def find_path(
    grid: LayeredGrid, start: Point3, goal: Point3, body: Body | None = None
) -> LayeredPath:
    """The shortest way that a body may walk from one point to another, on whatever floors.

    Parameters
    ----------
    start, goal : x, y, z in metres
        z says which floor: the nearest one above or below, within 1 m. Where the body does not
        fit, it is moved by half a metre at most, but not through a wall.
    body : Body
        An adult if not given.

    Returns
    -------
    LayeredPath
        Its status says why there is none.

    Raises
    ------
    ValueError
        A point is not three finite numbers, or lies outside the bounds.
    """
    body = Body.adult() if body is None else body
    start, goal = _checked("start", start, grid), _checked("goal", goal, grid)
    return find_way(footing_of(grid, body), start, goal)


def find_way(footing: Footing, start: Point3, goal: Point3) -> LayeredPath:
    """`find_path` on floors that are already known; points must be finite and within bounds."""
    classes = footing.classes
    first, x, y = stand(footing, classes, *start)
    if first < 0:
        return _no_path(PathStatus.START_BLOCKED)
    last, goal_x, goal_y = stand(footing, classes, *goal)
    if last < 0:
        return _no_path(PathStatus.GOAL_BLOCKED)
    left = spread_wave(footing, last, first)
    if left[first] == UNREACHED:
        connected = np.where(left == UNREACHED, np.uint8(FORBIDDEN), classes)
        first, x, y = stand(footing, connected, *start)
        if first < 0 or (x, y) == start[:2]:
            return _no_path(PathStatus.NO_WAY)
    way = stable_bfp(footing, left, first, last)
    if not len(way.cells):
        return _no_path(PathStatus.NO_WAY, way.expansions)
    line = line_of_cells(footing, way.cells, way.counts, (x, y), (goal_x, goal_y))
    line = straighten(footing, line)
    points = np.column_stack([line.xy, footing.arrays.floors[line.cells].astype(np.float64)])
    layers = footing.arrays.places[line.cells, 0].astype(np.int64)
    return LayeredPath(PathStatus.FOUND, points, layers, headings(line.xy), way.expansions)
