"""The free cell nearest to a place, on bare arrays."""

import numpy as np

from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import anchor_at, fits_at_anchor
from esplanade.planning.grid._walking_kernels import GroundArrays
from esplanade.planning.ground._geometry_kernels import Placement, crosses_any

NEAR_M = 1.0
"""Within this, a cell on this side of walls is taken before a nearer one behind them."""


@kernel
def nearest_free_cell(
    ground: GroundArrays,
    body: int,
    clearance: float,
    placement: Placement,
    x: float,
    y: float,
    z: float,
    within: float,
) -> int:
    """The free cell nearest to a place; -1 if none is.

    Only floors that differ from `z` by less than `within` metres count. `placement` is that of a
    body at the place. What a floor is higher or lower counts as distance.
    """
    grid = ground.grid
    floors, clear = grid.layered.floors, grid.clearance[body]
    most_m = clearance - 0.7072 * grid.layered.cell_m
    near = np.empty(64, dtype=np.int64)
    aways = np.empty(64, dtype=np.float64)
    count = 0
    best = -1
    least = np.inf
    for cell in range(len(floors)):
        apart = abs(floors[cell] - np.float32(z))
        if not (clear[cell] >= most_m and apart < np.float32(within)):
            continue
        if clear[cell] < clearance and not fits_at_anchor(grid, body, cell, clearance):
            continue
        ax, ay = anchor_at(grid, body, cell)
        away = np.hypot(ax - x, ay - y) + apart
        if away < least:
            least = away
            best = cell
        if away < NEAR_M:
            if count == len(near):
                near = np.concatenate((near, np.empty_like(near)))
                aways = np.concatenate((aways, np.empty_like(aways)))
            near[count] = cell
            aways[count] = away
            count += 1
    for _ in range(count):
        nearest = 0
        for k in range(1, count):
            if aways[k] < aways[nearest]:
                nearest = k
        cell = near[nearest]
        ax, ay = anchor_at(grid, body, cell)
        if not crosses_any(ground.barriers, placement, x, y, ax, ay):
            return int(cell)
        aways[nearest] = np.inf
    return best
