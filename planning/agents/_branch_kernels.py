"""The steps that a node of the search branches into, all of them at once, on bare arrays.

A processor works on many of them together as long as nothing is decided in between.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._cost_kernels import turned_mps
from esplanade.planning.agents._task_kernels import Task, metres_left, on_ramp
from esplanade.planning.compiled.jit import inlined
from esplanade.planning.grid._grid_kernels import GridArrays, follow, length
from esplanade.planning.routes._potential_kernels import PotentialValues

HALF_X, HALF_Y, X, Y, VX, VY, STRIDE, SPEED, TURNED, LEFT = range(10)
BRANCH_ROWS = LEFT + 1
"""Rows of branches: the places half-way and at the end of a step and the velocity there, the length
of the step, the mean speed in its second half, by how much the velocity changes, and the metres
left; metres, seconds."""


class Moves(NamedTuple):
    """The M moves that a node branches into, besides standing still.

    `cosines` and `sines` (M,) are those of the heading, relative to the descent of the potential
    if `relative`, else to +x; `speeds` (M,) are in metres a second. The first `straight` moves
    descend the potential and stop at the goal rather than beyond it. The first `coarse` of them are
    enough far ahead.
    """

    cosines: NDArray[np.float64]
    sines: NDArray[np.float64]
    speeds: NDArray[np.float64]
    straight: int
    coarse: int
    relative: bool


@inlined
def branch_out(
    moves: Moves,
    last: int,
    per_a: float,
    step_s: float,
    half_s: float,
    gx: float,
    gy: float,
    away: float,
    x: float,
    y: float,
    vx: float,
    vy: float,
    ux: float,
    uy: float,
    out: NDArray[np.float64],
) -> None:
    """Fill `out` (`BRANCH_ROWS`, M + 1) with the first steps from (x, y) with velocity v.

    They are `last` moves, and standing. The mean velocity of the half step before was u. (gx, gy)
    is the heading that moves are relative to, `away` the metres to the goal, and `per_a` one over
    the greatest acceleration.
    """
    for m in range(last + 1):
        wx = 0.0
        wy = 0.0
        if m < last:
            speed = moves.speeds[m]
            if m < moves.straight and away < speed * step_s:
                speed = away / step_s
            wx = speed * (gx * moves.cosines[m] - gy * moves.sines[m])
            wy = speed * (gx * moves.sines[m] + gy * moves.cosines[m])
        dvx = wx - vx
        dvy = wy - vy
        ramp = length(dvx, dvy) * per_a
        ex, ey, evx, evy = on_ramp(x, y, vx, vy, dvx, dvy, ramp, step_s)
        hx, hy, _, _ = on_ramp(x, y, vx, vy, dvx, dvy, ramp, half_s)
        to_x = (hx - x) / half_s
        to_y = (hy - y) / half_s
        on_x = (ex - hx) / half_s
        on_y = (ey - hy) / half_s
        out[HALF_X, m] = hx
        out[HALF_Y, m] = hy
        out[X, m] = ex
        out[Y, m] = ey
        out[VX, m] = evx
        out[VY, m] = evy
        out[STRIDE, m] = length(ex - x, ey - y)
        out[SPEED, m] = length(on_x, on_y)
        out[TURNED, m] = turned_mps(ux, uy, to_x, to_y, on_x, on_y)


@inlined
def look_up(
    grid: GridArrays,
    potential: PotentialValues,
    task: Task,
    cell: int,
    branches: NDArray[np.float64],
    last: int,
    cells: NDArray[np.int64],
) -> None:
    """Fill `cells` (2, M + 1) and the row `LEFT` of the branches, up to the last, of a node that is
    in `cell`.

    On flat ground the cell half-way is left to those who want it. The cell at the end does not
    depend on it there.
    """
    for m in range(last + 1):
        half = cell
        if not grid.flat:
            half = follow(grid, cell, branches[HALF_X, m], branches[HALF_Y, m])
        end = follow(grid, half, branches[X, m], branches[Y, m])
        cells[0, m] = half
        cells[1, m] = end
        branches[LEFT, m] = metres_left(potential, task, end, branches[X, m], branches[Y, m])
