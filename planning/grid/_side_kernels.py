"""Sides of barriers, on bare arrays: what stands between a point and the anchors around it.

A cell that a wall divides belongs to the side that its anchor is on. A body on the other side of
the wall has to go by the anchors that it gets to.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import (
    GridArrays,
    anchor_at,
    fits_at_anchor,
    floor_of,
    follow,
    length,
)
from esplanade.planning.ground._barrier_kernels import height_to_climb
from esplanade.planning.ground._geometry_kernels import LOW_ROOM_M, TOLERANCE_M, crosses

_HALF_DIAGONAL = 0.7072
"""Of a cell, in cells."""
_RINGS = 3
"""A body that stands where it does not fit finds a way out over at most so many cells."""


@kernel
def is_barred(
    grid: GridArrays, body: int, cell: int, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Whether the segment ab meets a barrier in the list of a cell that stops a kind of body."""
    kinds = grid.kinds
    m = kinds.measures[body]
    floor = floor_of(grid, cell)
    entry = kinds.first[body, cell]
    while entry >= 0:
        listed = kinds.entries[m["entries"] + entry]
        barrier = kinds.barriers[listed["barrier"]]
        entry = listed["next"]
        climb = height_to_climb(barrier, floor, floor, m["height_m"])
        if climb > m["step_on_m"] + TOLERANCE_M and crosses(barrier, ax, ay, bx, by):
            return True
    return False


@inlined
def is_cut_off(grid: GridArrays, body: int, cell: int, x: float, y: float) -> bool:
    """Whether a barrier stands between a point, in a cell, and the anchor of the cell.

    Cheap unless a barrier passes through the cell.
    """
    if cell < 0:
        return False
    low_m = max(0.0, grid.kinds.measures[body]["radius_m"] - LOW_ROOM_M)
    if grid.clearance[body, cell] > _HALF_DIAGONAL * grid.layered.cell_m + low_m:
        return False
    ax, ay = anchor_at(grid, body, cell)
    return bool(is_barred(grid, body, cell, x, y, ax, ay))


@kernel
def sees(
    grid: GridArrays, body: int, cell: int, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Whether no barrier that stops a kind of body stands between a, in a cell, and b."""
    pieces = int(length(bx - ax, by - ay) / (0.5 * grid.layered.cell_m)) + 1
    for k in range(pieces + 1):
        u = k / pieces
        cell = follow(grid, cell, ax + u * (bx - ax), ay + u * (by - ay))
        if cell < 0 or is_barred(grid, body, cell, ax, ay, bx, by):
            return False
    return True


@kernel
def cells_to_begin_at(
    grid: GridArrays, body: int, radius: float, cell: int, x: float, y: float
) -> NDArray[np.int64]:
    """The cells where a way from a point may begin: its own if that is free, else free ones near.

    These are the free cells of the nearest ring of neighbours, up to three rings away, that has any
    that no barrier hides from the point.
    """
    step_on_m = grid.kinds.measures[body]["step_on_m"]
    cx, cy = anchor_at(grid, body, cell)
    if fits_at_anchor(grid, body, cell, radius) and sees(grid, body, cell, x, y, cx, cy):
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
                if apart > step_on_m:
                    continue
                known = False
                for j in range(end):
                    known = known or seen[j] == other
                if known:
                    continue
                seen[end] = other
                end += 1
                cx, cy = anchor_at(grid, body, other)
                if fits_at_anchor(grid, body, other, radius) and sees(
                    grid, body, cell, x, y, cx, cy
                ):
                    found[count] = other
                    count += 1
        if count:
            break
        first, last = last, end
    return found[:count].copy()
