"""A search for a walking route, a piece at a time, and wave fronts that searches share."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.grid._side_kernels import cells_to_begin_at
from esplanade.planning.grid._walking_kernels import GroundArrays
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.routes import _descending_kernels as kernels
from esplanade.planning.routes._anchor_way_kernels import anchors_ahead
from esplanade.planning.routes._straightening_kernels import Line, recount
from esplanade.planning.routes.moved_ends import MovedEnd, moved_end
from esplanade.planning.routes.straightening import straighten
from esplanade.planning.routes.wave_front import Wave, WaveFront
from esplanade.planning.scene.bodies import LIMITS, Body
from esplanade.planning.scene.heights import SAME_SURFACE_M

Point = tuple[float, float, float]
"""x, y and the height of the floor, metres."""
Route = tuple[Point, ...]
"""The ends of straight legs, the goal last."""

STEP_M: Final = 0.2
TURN_COS: Final = math.cos(math.radians(2.0))

PIECE_CELLS: Final = 8192
"""A piece of a search settles at most so many cells: some 10 to 20 ms."""

_STRAIGHT_COS: Final = 1.0 - 1e-9

_BEYOND_M: Final = 1.0
"""A wave goes so much further than the start, for whoever walks beside its cells."""
_WAVES_KEPT: Final = 16
_BYTES_KEPT: Final = 64 * 2**20
_BYTES_A_CELL: Final = 24


def walker(radius_m: float) -> Body:
    """The body of a person of this radius."""
    return replace(Body.adult(), radius_m=max(LIMITS["radius_m"][0], radius_m))


class SharedWaves:
    """The wave fronts of the goals that routes were last sought to, by the cell of the goal.

    They are dropped once a door has moved. At least one is kept, at most 16 or 64 MiB.
    """

    def __init__(self, grid: LayeredGrid) -> None:
        self.grid = grid
        self._waves: OrderedDict[tuple[int, float], WaveFront] = OrderedDict()
        cells = len(grid.layered.floors)
        self._kept = max(1, min(_WAVES_KEPT, _BYTES_KEPT // (_BYTES_A_CELL * max(1, cells))))

    def __len__(self) -> int:
        return len(self._waves)

    def of(self, goal: tuple[float, float], cell: int, radius_m: float) -> WaveFront:
        """The wave from a goal, or from another one in the same cell."""
        key = cell, radius_m
        wave = self._waves.get(key)
        if wave is None or wave.arrays is not self.grid.arrays:
            wave = WaveFront(self.grid, goal, cell, radius_m, Wave.SIGHT, walker(radius_m))
            self._waves[key] = wave
        self._waves.move_to_end(key)
        if len(self._waves) > self._kept:
            self._waves.popitem(last=False)
        return wave


class RouteSearch:
    """A search for a shortest route to the free place nearest to a goal, for an adult.

    Call `advance` until it returns true; then `route` is the route, None where there is none, or
    where the goal is not free itself and the search is strict. It
    runs in any thread, one search at a time for the same `waves`, and holds no interpreter lock but
    for some 0.1 ms a piece.
    """

    def __init__(
        self,
        waves: SharedWaves,
        start: Point,
        goal: Point,
        clearance_m: float,
        *,
        strict: bool = False,
    ) -> None:
        self.route: Route | None = None
        self.moved: MovedEnd | None = None
        """How the goal was moved, if by more than 0.25 m."""
        self._strict = strict
        self._waves = waves
        self._grid = waves.grid
        self._body = walker(clearance_m)
        self._clearance_m = clearance_m
        self._start = start
        self._goal = goal
        self._wave: WaveFront | None = None
        self._cell = -1
        self._targets: NDArray[np.int64] = np.empty(0, dtype=np.int64)

    def advance(self) -> bool:
        """Search on for a while; whether the search is over.

        Cost: 10 to 20 ms; less where the way is straight, or known from another search.
        """
        wave = self._wave = self._wave or self._begin()
        if wave is None:
            return True
        if not wave.grow(self._targets, _BEYOND_M, PIECE_CELLS):
            return False
        self.route = self._descend(wave)
        if self.route is not None and not self._grid.bounds_edges(self._body):
            self.route = self._shortened(self.route)
        return True

    def _begin(self) -> WaveFront | None:
        """Find a free goal and try the straight line; a wave if the search goes on."""
        grid, clearance_m = self._grid, self._clearance_m
        x, y, z = self._goal
        free = grid.nearest_free((x, y), z, clearance_m, self._body)
        if free is None:
            return None
        goal = self._goal = (*free, grid.floor_at(free, z))
        self.moved = moved_end(grid, self._body, (x, y, z), goal)
        if self._strict and self.moved is not None:
            return None
        if not grid.bounds_edges(self._body) and self._straight(self._start, goal):
            self.route = (goal,)
            return None
        self._cell = grid.cell_at(self._start[:2], self._start[2])
        goal_cell = grid.cell_at(goal[:2], goal[2])
        if self._cell < 0 or goal_cell < 0:
            return None
        self._targets = cells_to_begin_at(
            grid.arrays, grid.row_of(self._body), clearance_m, self._cell, *self._start[:2]
        )
        if not len(self._targets):
            return None
        return self._waves.of(goal[:2], goal_cell, clearance_m)

    def _descend(self, wave: WaveFront) -> Route | None:
        """The route down a wave that has reached the start, None where it never does."""
        start = self._start[:2]
        anchors = wave.anchors(self._targets)
        values = wave.values[self._targets]
        left_m = values[:, 0] + np.hypot(*(values[:, 1:3] - anchors).T)
        left_m[wave.settled[self._targets] == 0] = np.inf
        left_m += np.hypot(*(anchors - start).T)
        nearest = int(left_m.argmin())
        if not math.isfinite(left_m[nearest]):
            return None
        corners = np.empty((int(2.0 * left_m[nearest] / STEP_M) + 10, 3))
        end = (*wave.goal, self._goal[2])
        x, y = anchors[nearest].tolist()
        count = kernels.descend(
            GroundArrays(self._grid.arrays, self._grid.index),
            self._grid.row_of(self._body),
            self._body.height_m,
            self._body.step_on_m,
            self._body.leg_length_m,
            self._clearance_m,
            wave.values,
            wave.settled,
            self._cell,
            start,
            (x, y),
            end,
            STEP_M,
            TURN_COS,
            corners,
        )
        if count < 0:
            return self._over_anchors(wave, int(self._targets[nearest]), float(left_m[nearest]))
        legs: list[Point] = [(x, y, z) for x, y, z in corners[:count].tolist()]
        if end != self._goal:
            # Somebody else's wave led to another point of the same cell.
            last = legs[-1] if legs else self._start
            if not self._straight(last, self._goal):
                legs.append(end)
        return (*legs, self._goal)

    def _over_anchors(self, wave: WaveFront, cell: int, left_m: float) -> Route | None:
        """The route over the anchors that a wave has reached, straightened.

        Steps between anchors are checked exactly, so that it leads through passages in which a
        straight walk to a waypoint ends at a corner.
        """
        most = 64 + int(8.0 * left_m / self._grid.cell_m)
        points, cells = np.empty((most, 2)), np.empty(most, dtype=np.int64)
        row = self._grid.row_of(self._body)
        count, complete = anchors_ahead(wave.arrays, wave.values, row, cell, points, cells)
        if not complete:
            return None
        points, cells = points[:count], cells[:count].astype(np.int32)
        traversability = self._grid.traversability.of(kind_of(self._body))
        line = Line(
            np.concatenate([[self._start[:2]], points, [self._goal[:2]]]),
            np.concatenate([[np.int32(self._cell)], cells, cells[-1:]]),
            np.zeros(count + 2, dtype=np.int32),
        )
        if not recount(traversability, line):
            return None
        line = straighten(traversability, line)
        heights = self._grid.layered.floors[line.cells]
        ends = np.flatnonzero(_turns(line.xy)).tolist()
        return tuple((*line.xy[k].tolist(), float(heights[k])) for k in ends)

    def _shortened(self, route: Route) -> Route:
        """The route without corners whose neighbours a straight walk joins; cost of a walk each."""
        kept = [self._start]
        for corner, after in pairwise(route):
            if not self._straight(kept[-1], after):
                kept.append(corner)
        return (*kept[1:], route[-1])

    def _straight(self, start: Point, goal: Point) -> bool:
        return leads_straight(self._grid, start, goal, self._clearance_m)


def _turns(xy: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether a line (N, 2) turns or ends at each of its points, bool (N,); not at the first."""
    along = np.diff(xy, axis=0)
    lengths = np.hypot(*along.T)
    ends = np.zeros(len(xy), dtype=np.bool_)
    ends[-1] = True
    before = 0
    for k in np.flatnonzero(lengths > 1e-9).tolist():
        cosine = along[before] @ along[k] / (lengths[before] * lengths[k])
        ends[k] = k > 0 and lengths[before] > 0.0 and cosine < _STRAIGHT_COS
        before = k
    return ends


def leads_straight(grid: LayeredGrid, start: Point, goal: Point, clearance_m: float) -> bool:
    """Whether the goal is free and nothing stands between; cost of one walk."""
    if not grid.is_free([goal[:2]], [goal[2]], clearance_m)[0]:
        return False
    line = np.subtract(goal[:2], start[:2])
    reached, heights = grid.walk([start[:2]], [start[2]], [line], clearance_m)
    return bool(
        math.dist(reached[0], goal[:2]) < 1e-6 and abs(heights[0] - goal[2]) < SAME_SURFACE_M
    )
