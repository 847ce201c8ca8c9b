"""Ways over anchors, on bare arrays: exact ways, however little room a passage leaves.

The waypoint of a cell is seen from the cell's anchor. From another point of the cell the straight
line to it may pass a corner too closely. The steps between anchors, bends included, are checked
exactly, and they lead to the goal wherever a wave has come from there.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import GridArrays, anchor_at, floor_of, follow, length
from esplanade.planning.ground._barrier_kernels import Measures, NearBarriers
from esplanade.planning.ground._geometry_kernels import TOLERANCE_M
from esplanade.planning.routes._potential_kernels import PotentialValues, potential_at
from esplanade.planning.traversal._way_kernels import CLEAR, bend_between, way_through

_LOWER_M = 1e-5
"""The potential falls by at least this much from one anchor of a way to the next."""


@kernel
def near_of(grid: GridArrays, body: int) -> NearBarriers:
    """The barriers near each cell that matter to a kind of body."""
    kinds = grid.kinds
    begin = kinds.measures[body]["entries"]
    reach_m = float(kinds.measures[body]["reach_m"])
    return NearBarriers(kinds.barriers, kinds.first[body], kinds.entries[begin:], reach_m)


@kernel
def measures_less(grid: GridArrays, body: int, less_m: float) -> Measures:
    """The measures of a kind of body, with a radius that is smaller by `less_m`."""
    m = grid.kinds.measures[body]
    return Measures(
        float(m["radius_m"] - less_m),
        float(m["height_m"]),
        float(m["step_on_m"]),
        float(m["leg_length_m"]),
    )


@kernel
def leads_exactly(
    grid: GridArrays,
    body: int,
    cell: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    less_m: float,
) -> bool:
    """Whether a body may move straight from a, in `cell`, to b, by its distances to barriers.

    Its radius is smaller by `less_m` for that.
    """
    near, measures = near_of(grid, body), measures_less(grid, body, less_m)
    pieces = int(length(bx - ax, by - ay) / (0.5 * grid.layered.cell_m)) + 1
    for k in range(pieces + 1):
        u = k / pieces
        there = follow(grid, cell, ax + u * (bx - ax), ay + u * (by - ay))
        if there < 0:
            return False
        if k == 0 or there != cell:
            here_m, there_m = floor_of(grid, cell), floor_of(grid, there)
            lowest, highest = min(here_m, there_m), max(here_m, there_m)
            if highest - lowest > measures.step_on_m + TOLERANCE_M:
                return False
            found = way_through(
                near, measures, there, lowest, highest, ax, ay, bx, by, 0.0, False, False, -1
            )
            if found != CLEAR:
                return False
        cell = there
    return True


@kernel
def anchors_ahead(
    grid: GridArrays,
    potential: PotentialValues,
    body: int,
    cell: int,
    points: NDArray[np.float64],
    cells: NDArray[np.int64],
) -> tuple[int, bool]:
    """Write the points of the way over anchors from a cell on: `points` (K, 2) and `cells` (K,).

    They are anchors and the bends of steps between them, and at last the goal. The way follows the
    step by which the goal is nearest. Returns the number of points, and whether they lead all the
    way to the goal.
    """
    x, y = anchor_at(grid, body, cell)
    left = potential_at(potential, cell, x, y)
    if not np.isfinite(left) or len(points) == 0:
        return 0, False
    points[0, 0] = x
    points[0, 1] = y
    cells[0] = cell
    count = 1
    while count + 2 <= len(points):
        best = -1
        least = np.inf
        for direction in range(8):
            if not grid.kinds.steps[body, cell] >> direction & 1:
                continue
            other = grid.layered.links[cell, direction]
            cx, cy = anchor_at(grid, body, other)
            there = potential_at(potential, other, cx, cy)
            if there < left - _LOWER_M and there + length(cx - x, cy - y) < least:
                least = there + length(cx - x, cy - y)
                best = other
        if best < 0:  # the waypoint of the goal's cell, and of those that see it, is the goal
            points[count, 0] = potential[cell, 1]
            points[count, 1] = potential[cell, 2]
            cells[count] = follow(grid, cell, potential[cell, 1], potential[cell, 2])
            return count + 1, bool(potential[cell, 0] == 0.0)
        count = append_step(grid, body, cell, best, points, cells, count)
        cell = best
        x, y = anchor_at(grid, body, cell)
        left = potential_at(potential, cell, x, y)
    return count, False


@kernel
def append_step(
    grid: GridArrays,
    body: int,
    cell: int,
    other: int,
    points: NDArray[np.float64],
    cells: NDArray[np.int64],
    count: int,
) -> int:
    """Write the points of a step after `count` others: its bend if it has one, and its end.

    Returns the new number of points.
    """
    near, measures = near_of(grid, body), measures_less(grid, body, 0.0)
    offsets = grid.kinds.offsets[grid.kinds.measures[body]["entries"] :]
    kind, bx, by = bend_between(grid.layered, near, measures, offsets, cell, other)
    if kind == 2:
        points[count, 0] = bx
        points[count, 1] = by
        cells[count] = follow(grid, cell, bx, by)
        count += 1
    points[count] = anchor_at(grid, body, other)
    cells[count] = other
    return count + 1
