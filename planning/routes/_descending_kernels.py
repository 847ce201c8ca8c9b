"""Walks down the waypoints of a wave front to its goal, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import floor_of, length
from esplanade.planning.grid._side_kernels import is_cut_off
from esplanade.planning.grid._walking_kernels import GroundArrays, walk
from esplanade.planning.routes._potential_kernels import PotentialValues, direction_at
from esplanade.planning.scene.heights import SAME_SURFACE_M

_PIECE_M = 0.07
"""Steps are walked in pieces as long as people's moves in a tick, so that people get along."""


@kernel
def descend(
    ground: GroundArrays,
    body: int,
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
    the wave has not settled that cell, or the body is cut off from its anchor, towards the one that
    it had, at first `toward`. A change of direction whose cosine is at least `turn_cos` is no
    corner. Returns the number of corners, -1 if the goal is not reached in K steps.
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
        if settled[cell] and not is_cut_off(grid, body, cell, x, y):
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
        pieces = max(1, int(np.ceil(step / _PIECE_M - 1e-9)))
        for _ in range(pieces):
            cell, x, y = walk(
                grid,
                ground.barriers,
                height_m,
                step_on_m,
                leg_length_m,
                cell,
                x,
                y,
                step * dx / pieces,
                step * dy / pieces,
                clearance,
            )
            if cell < 0:
                return -1
    return -1
