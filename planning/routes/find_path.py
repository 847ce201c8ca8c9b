"""A path for one body through a layered scene: Huang & Li, from reachability to headings."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.routes._snapping_kernels import snap
from esplanade.planning.routes.moved_ends import MovedEnd, moved_end
from esplanade.planning.routes.stable_bfp import stable_bfp
from esplanade.planning.routes.straightening import headings, line_of_cells, straighten
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal._stability_kernels import FORBIDDEN
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import spread_toward

Point3 = tuple[float, float, float]
_LONGER = (1.0, 1.05, 1.2, math.inf)
"""Limits for the path that M allows, in lengths of the shortest path without M. They are tried in
turn, since most paths are as short and a low limit saves work."""


class PathStatus(IntEnum):
    """The outcome of the search for a path."""

    FOUND = 0
    NO_WAY = 1
    """The body fits at start and goal, but no legal path leads from one to the other."""
    START_BLOCKED = 2
    """The body fits nowhere within half a metre of the start, or not there with `strict`."""
    GOAL_BLOCKED = 3
    """The body fits nowhere within half a metre of the goal, or not there with `strict`."""


@dataclass(frozen=True, eq=False)
class LayeredPath:
    """A path over floors, with a point in every cell that it crosses; empty unless found."""

    status: PathStatus
    points: NDArray[np.float64]
    """(N, 3): x, y, and the height of the floor; metres."""
    layers: NDArray[np.int64]
    """(N,): the layer of each point."""
    headings: NDArray[np.float64]
    """(N,): headings of the body, radians from east toward north."""
    expansions: int = 0
    """Number of states that the search looked at."""
    start_moved: MovedEnd | None = None
    """How the start was moved, if by more than 0.25 m; with `strict`, how it would have been."""
    goal_moved: MovedEnd | None = None
    """The same of the goal."""

    @property
    def length_m(self) -> float:
        """Length of the path in metres, up and down included; 0 if there is no path."""
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
    grid: LayeredGrid,
    start: Point3,
    goal: Point3,
    body: Body | None = None,
    *,
    strict: bool = False,
) -> LayeredPath:
    """The shortest path that a body may walk from one point to another, on any floors.

    Parameters
    ----------
    start, goal : x, y, z in metres
        z tells the floor: the nearest one above or below, within 1 m. Where the body does not fit
        it is moved by half a metre at most, and through a wall only if it fits nowhere on this
        side, as inside a hollow wall.
    body : Body
        An adult if not given. The path is that of its kind (`kind_of`), as live actors walk it.
    strict : bool
        There is no path if the start or the goal has to be moved by more than 0.25 m.

    Returns
    -------
    LayeredPath
        Its status tells why there is none.

    Raises
    ------
    ValueError
        A point is not three finite numbers, or lies outside the bounds.
    """
    body = Body.adult() if body is None else body
    start, goal = _checked("start", start, grid), _checked("goal", goal, grid)
    body = replace(kind_of(body), edge_cells=body.edge_cells)
    traversability = grid.traversability.of(body)
    first, last = find_endpoint(traversability, start), find_endpoint(traversability, goal)
    if first is None:
        return _no_path(PathStatus.START_BLOCKED)
    if last is None:
        return _no_path(PathStatus.GOAL_BLOCKED)
    regions = grid.traversability.regions_of(body)
    if regions[first.cell] != regions[last.cell]:
        # An endpoint that has to be moved anyway may be moved to the region of the other.
        first = _moved(traversability, start, first, regions == regions[last.cell]) or first
    if regions[first.cell] != regions[last.cell]:
        last = _moved(traversability, goal, last, regions == regions[first.cell]) or last
    if regions[first.cell] != regions[last.cell]:
        return _no_path(PathStatus.NO_WAY)
    started, ended = _how_moved(grid, body, start, first), _how_moved(grid, body, goal, last)
    if strict and (started or ended):
        blocked = PathStatus.START_BLOCKED if started else PathStatus.GOAL_BLOCKED
        return replace(_no_path(blocked), start_moved=started, goal_moved=ended)
    path = find_route(traversability, first, last)
    return replace(path, start_moved=started, goal_moved=ended)


def _how_moved(grid: LayeredGrid, body: Body, asked: Point3, end: Endpoint) -> MovedEnd | None:
    floor_m = float(grid.layered.floors[end.cell])
    return moved_end(grid, body, asked, (end.x, end.y, floor_m))


class Endpoint(NamedTuple):
    """A start or goal: a cell, and a position in it where the body can stand, in metres."""

    cell: int
    x: float
    y: float
    through: bool
    """Whether the body was moved through a wall, as it fits nowhere on the point's side."""


def find_endpoint(traversability: Traversability, point: Point3) -> Endpoint | None:
    """The nearest endpoint to a point; None if the body fits nowhere near.

    The body stays on its side of walls if it fits there; otherwise the point is inside of an
    obstacle, and the body is moved out of it.
    """
    return _snapped(traversability, point, False) or _snapped(traversability, point, True)


def _snapped(
    traversability: Traversability,
    point: Point3,
    through: bool,
    among: NDArray[np.bool_] | None = None,
) -> Endpoint | None:
    """The nearest endpoint to a point, among all cells or some, bool (N,)."""
    classes = traversability.classes
    if among is not None:
        classes = np.where(among, classes, np.uint8(FORBIDDEN))
    cell, x, y = snap(traversability, classes, *point, through)
    return Endpoint(cell, x, y, through) if cell >= 0 else None


def _moved(
    traversability: Traversability, point: Point3, end: Endpoint, among: NDArray[np.bool_]
) -> Endpoint | None:
    """Another endpoint among some cells; None if the body fits at the point itself or in none."""
    if (end.x, end.y) == point[:2]:
        return None
    return _snapped(traversability, point, end.through, among)


def find_route(traversability: Traversability, first: Endpoint, last: Endpoint) -> LayeredPath:
    """The shortest path between two endpoints that M allows.

    Cost O(cells on paths that are no longer); in the open these are few besides the path itself.
    """
    for longer in _LONGER:
        distances = spread_toward(traversability, last.cell, first.cell, longer)
        path = stable_bfp(traversability, distances, first.cell, last.cell, longer)
        if len(path.cells):
            break
    else:
        return _no_path(PathStatus.NO_WAY, path.expansions)
    start, goal = (first.x, first.y), (last.x, last.y)
    line = line_of_cells(traversability, path.cells, path.counts, start, goal)
    line = straighten(traversability, line)
    points = np.column_stack([line.xy, traversability.arrays.floors[line.cells].astype(np.float64)])
    layers = traversability.arrays.places["layer"][line.cells].astype(np.int64)
    return LayeredPath(PathStatus.FOUND, points, layers, headings(line.xy), path.expansions)
