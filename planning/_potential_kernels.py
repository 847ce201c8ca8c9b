"""Wave fronts that lead to a goal, on bare arrays.

Both kinds fill the same guide: per cell the distance left from a *waypoint* and the waypoint's
place, so that the potential anywhere in the cell is `guide distance + way to the waypoint`.
"""

import numpy as np
from numpy.typing import NDArray

from planning._grid_kernels import GridArrays, cell_at, length, line_is_clear
from planning._heap_kernels import heap_pop, heap_push
from planning._jit import inlined, kernel

Guide = NDArray[np.float32]
"""(L, ny, nx, 3): metres from the waypoint to the goal, waypoint x, waypoint y.
Unreachable cells hold inf."""


@inlined
def potential_at(grid: GridArrays, guide: Guide, layer: int, x: float, y: float) -> float:
    """Metres from a point to the goal; inf where no way leads."""
    j, i = cell_at(grid, x, y)
    g = guide[layer, j, i]
    return float(g[0] + length(g[1] - x, g[2] - y))


@inlined
def direction_at(
    grid: GridArrays, guide: Guide, layer: int, x: float, y: float
) -> tuple[float, float, float]:
    """Unit vector toward the waypoint and the way to it; zeros at the goal or where no way leads.

    Within a quarter of a cell of a waypoint the one after it counts.
    """
    j, i = cell_at(grid, x, y)
    left, wx, wy = guide[layer, j, i]
    if not np.isfinite(left):
        return 0.0, 0.0, 0.0
    leg = length(wx - x, wy - y)
    if leg < 0.25 * grid.cell_m and left > 0.0:
        j, i = cell_at(grid, wx, wy)
        left, wx, wy = guide[layer, j, i]
        leg = length(wx - x, wy - y)
    if leg < 1e-4:  # waypoints are rounded to float32
        return 0.0, 0.0, 0.0
    return (wx - x) / leg, (wy - y) / leg, leg


@kernel
def _may_pass(
    grid: GridArrays, layer: int, radius: float, j: int, i: int, nj: int, ni: int
) -> bool:
    """Whether a neighbouring cell is free and reached without cutting an obstacle's corner."""
    _, ny, nx = grid.clearance.shape
    if not (0 <= nj < ny and 0 <= ni < nx) or grid.clearance[layer, nj, ni] < radius:
        return False
    if j == nj or i == ni:  # also out of a goal's own cell, whose centre need not be free
        return True
    beside = min(grid.clearance[layer, j, ni], grid.clearance[layer, nj, i])
    return bool(beside >= radius)


@kernel
def spread_wave(
    grid: GridArrays,
    radius: float,
    layer: int,
    goal_x: float,
    goal_y: float,
    longest_sight: float,
    guide: Guide,
    settled: NDArray[np.uint8],
    keys: NDArray[np.float64],
    items: NDArray[np.int64],
) -> int:
    """Fill a guide; returns how many cells were reached.

    The wave spreads from cell to cell over the eight around, never cutting a corner. A cell that
    sees its neighbour's waypoint within `longest_sight` metres takes that waypoint over, else the
    neighbour itself is its waypoint; at zero sight this is NF1. Lines of sight are tested once a
    cell, when it leaves the heap. `keys` and `items` hold 8 entries a cell plus one.
    """
    nx = grid.clearance.shape[2]
    guide[:, :, :, 0] = np.inf
    guide[:, :, :, 1:] = 0.0
    settled[:] = 0
    gj, gi = cell_at(grid, goal_x, goal_y)
    guide[layer, gj, gi, 0] = 0.0
    guide[layer, gj, gi, 1] = goal_x
    guide[layer, gj, gi, 2] = goal_y
    size = heap_push(keys, items, 0, 0.0, gj * nx + gi)
    reached = 0
    while size > 0:
        cell = items[0]
        size = heap_pop(keys, items, size)
        j = cell // nx
        i = cell % nx
        if settled[layer, j, i]:
            continue
        x = grid.x0 + (i + 0.5) * grid.cell_m
        y = grid.y0 + (j + 0.5) * grid.cell_m
        own = guide[layer, j, i]
        seen = longest_sight == 0.0 or line_is_clear(grid, layer, x, y, own[1], own[2], radius)
        if reached > 0 and not seen:
            own[0] = np.inf
            for dj in range(-1, 2):
                for di in range(-1, 2):
                    nj = j + dj
                    ni = i + di
                    if _may_pass(grid, layer, radius, j, i, nj, ni) and settled[layer, nj, ni]:
                        cx = grid.x0 + (ni + 0.5) * grid.cell_m
                        cy = grid.y0 + (nj + 0.5) * grid.cell_m
                        left = potential_at(grid, guide, layer, cx, cy)
                        if left + np.hypot(cx - x, cy - y) < own[0] + np.hypot(
                            own[1] - x, own[2] - y
                        ):
                            own[0] = left
                            own[1] = cx
                            own[2] = cy
            if not np.isfinite(own[0]):
                continue
        settled[layer, j, i] = 1
        reached += 1
        for dj in range(-1, 2):
            for di in range(-1, 2):
                nj = j + dj
                ni = i + di
                if not _may_pass(grid, layer, radius, j, i, nj, ni) or settled[layer, nj, ni]:
                    continue
                cx = grid.x0 + (ni + 0.5) * grid.cell_m
                cy = grid.y0 + (nj + 0.5) * grid.cell_m
                left = own[0]
                wx = own[1]
                wy = own[2]
                if np.hypot(wx - cx, wy - cy) > longest_sight:
                    left = own[0] + np.hypot(wx - x, wy - y)
                    wx = x
                    wy = y
                cost = left + np.hypot(wx - cx, wy - cy)
                if cost < potential_at(grid, guide, layer, cx, cy):
                    guide[layer, nj, ni, 0] = left
                    guide[layer, nj, ni, 1] = wx
                    guide[layer, nj, ni, 2] = wy
                    size = heap_push(keys, items, size, cost, nj * nx + ni)
    return reached


@kernel
def extend_into_obstacles(
    grid: GridArrays, guide: Guide, settled: NDArray[np.uint8], layer: int
) -> None:
    """Lead out of cells that are not free but lie next to reached ones, three rings deep.

    Who was put beside a wall, closer than its radius, then still knows the way. Such ground
    counts thrice its length.
    """
    _, ny, nx = grid.clearance.shape
    for ring in range(1, 4):
        for j in range(ny):
            for i in range(nx):
                if settled[layer, j, i]:
                    continue
                x = grid.x0 + (i + 0.5) * grid.cell_m
                y = grid.y0 + (j + 0.5) * grid.cell_m
                best = np.inf
                for dj in range(-1, 2):
                    for di in range(-1, 2):
                        nj = j + dj
                        ni = i + di
                        if not (0 <= nj < ny and 0 <= ni < nx):
                            continue
                        mark = settled[layer, nj, ni]
                        if mark == 0 or mark > ring:
                            continue
                        cx = grid.x0 + (ni + 0.5) * grid.cell_m
                        cy = grid.y0 + (nj + 0.5) * grid.cell_m
                        way = np.hypot(cx - x, cy - y)
                        left = potential_at(grid, guide, layer, cx, cy) + 2.0 * way
                        if left + way < best:
                            best = left + way
                            guide[layer, j, i, 0] = left
                            guide[layer, j, i, 1] = cx
                            guide[layer, j, i, 2] = cy
                if np.isfinite(best):
                    settled[layer, j, i] = ring + 1


@kernel
def distances(
    grid: GridArrays,
    guide: Guide,
    layers: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """`potential_at` for (N,), (N, 2) -> out (N,)."""
    for k in range(len(positions)):
        out[k] = potential_at(grid, guide, layers[k], positions[k, 0], positions[k, 1])


@kernel
def directions(
    grid: GridArrays,
    guide: Guide,
    layers: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """`direction_at` for (N,), (N, 2) -> out (N, 2)."""
    for k in range(len(positions)):
        dx, dy, _ = direction_at(grid, guide, layers[k], positions[k, 0], positions[k, 1])
        out[k, 0] = dx
        out[k, 1] = dy
