"""Walks down the waypoints of a wave front to its goal, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import (
    anchor_at,
    fits_at_anchor,
    floor_of,
    length,
)
from esplanade.planning.grid._walking_kernels import GroundArrays, walk
from esplanade.planning.ground._geometry_kernels import Placement, crosses_any
from esplanade.planning.routes._potential_kernels import PotentialValues, direction_at
from esplanade.planning.scene.heights import SAME_SURFACE_M

_RINGS = 3
"""A body that stands where it does not fit finds a way out over at most so many cells."""


@kernel
def cells_to_begin_at(
    ground: GroundArrays,
    body: int,
    radius: float,
    placement: Placement,
    cell: int,
    x: float,
    y: float,
) -> NDArray[np.int64]:
    """The cells where a route from a point may begin: its own if that is free, else free ones near.

    These are the free cells of the nearest ring of neighbours, up to three rings away, that has any
    that no barrier hides from the point.
    """
    grid = ground.grid
    cx, cy = anchor_at(grid, body, cell)
    if fits_at_anchor(grid, body, cell, radius) and not crosses_any(
        ground.barriers, placement, x, y, cx, cy
    ):
        return np.full(1, cell, dtype=np.int64)
    side = 2 * _RINGS + 1
    seen = np.empty(side * side, dtype=np.int64)
    seen[0] = cell
    first, last = 0, 1
    found = np.empty(side * side, dtype=np.int64)
    count = 0
    for _ in range(_RINGS):
        end = last
        for k in range(first, last):
            for direction in range(8):
                other = grid.layered.links[seen[k], direction]
                if other < 0 or end == len(seen):
                    continue
                apart = abs(grid.layered.floors[other] - grid.layered.floors[seen[k]])
                if apart > placement.step_on_m:
                    continue
                known = False
                for j in range(end):
                    known = known or seen[j] == other
                if known:
                    continue
                seen[end] = other
                end += 1
                cx, cy = anchor_at(grid, body, other)
                if fits_at_anchor(grid, body, other, radius) and not crosses_any(
                    ground.barriers, placement, x, y, cx, cy
                ):
                    found[count] = other
                    count += 1
        if count:
            break
        first, last = last, end
    return found[:count].copy()


@kernel
def descend(
    ground: GroundArrays,
    height_m: float,
    step_on_m: float,
    leg_length_m: float,
    clearance: float,
    potential: PotentialValues,
    settled: NDArray[np.uint8],
    cell: int,
    start: tuple[float, float],
    toward: tuple[float, float],
    goal: tuple[float, float, float],
    step: float,
    turn_cos: float,
    corners: NDArray[np.float64],
) -> int:
    """Walk from a start to the goal and write where the way turns into `corners` (K, 3).

    The body takes steps of `step` metres towards the waypoint of the cell that it is in; as long as
    the wave has not settled that cell, towards the one that it had, at first `toward`. A change of
    direction whose cosine is at least `turn_cos` is no corner. Returns the number of corners, -1 if
    the goal is not reached in K steps.
    """
    grid = ground.grid
    x, y = start
    wx, wy = toward
    hx, hy = 0.0, 0.0
    count = 0
    for k in range(len(corners)):
        if (
            length(x - goal[0], y - goal[1]) <= step
            and abs(floor_of(grid, cell) - goal[2]) < SAME_SURFACE_M
        ):
            return count
        if settled[cell]:
            dx, dy, leg = direction_at(grid, potential, cell, x, y)
            wx = x + leg * dx
            wy = y + leg * dy
        else:
            leg = length(wx - x, wy - y)
            dx = (wx - x) / leg if leg > 0.0 else 0.0
            dy = (wy - y) / leg if leg > 0.0 else 0.0
        if dx == 0.0 and dy == 0.0:
            return -1
        if k == 0:
            hx, hy = dx, dy
        elif dx * hx + dy * hy < turn_cos:
            corners[count, 0] = x
            corners[count, 1] = y
            corners[count, 2] = floor_of(grid, cell)
            count += 1
            hx, hy = dx, dy
        cell, x, y = walk(
            grid,
            ground.barriers,
            height_m,
            step_on_m,
            leg_length_m,
            cell,
            x,
            y,
            step * dx,
            step * dy,
            clearance,
        )
        if cell < 0:
            return -1
    return -1
