"""Wave fronts that lead to a goal, on bare arrays.

Both kinds fill the same guide: per cell the distance left from a *waypoint* and the waypoint's
place, so that the potential anywhere in the cell is `guide distance + way to the waypoint`.
"""

import numpy as np
from numpy.typing import NDArray

from planning._grid_kernels import GridArrays, cell_at, line_is_clear
from planning._heap_kernels import heap_pop, heap_push
from planning._jit import kernel

Guide = NDArray[np.float32]
"""(L, ny, nx, 3): metres from the waypoint to the goal, waypoint x, waypoint y.
Unreachable cells hold inf."""


LONGEST_SIGHT_M = 24.0
"""A waypoint is followed by another at the latest after this way, so that a line of sight costs
no more in a large zone than in a small one."""


@kernel
def potential_at(grid: GridArrays, guide: Guide, layer: int, x: float, y: float) -> float:
    """Metres from a point to the goal; inf where no way leads."""
    j, i = cell_at(grid, x, y)
    g = guide[layer, j, i]
    return float(g[0] + np.hypot(g[1] - x, g[2] - y))


@kernel
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
    length = np.hypot(wx - x, wy - y)
    if length < 0.25 * grid.cell_m and left > 0.0:
        j, i = cell_at(grid, wx, wy)
        left, wx, wy = guide[layer, j, i]
        length = np.hypot(wx - x, wy - y)
    if length < 1e-4:  # waypoints are rounded to float32
        return 0.0, 0.0, 0.0
    return (wx - x) / length, (wy - y) / length, length


@kernel
def sight_wave(
    grid: GridArrays,
    radius: float,
    layer: int,
    goal_x: float,
    goal_y: float,
    guide: Guide,
    settled: NDArray[np.uint8],
    keys: NDArray[np.float64],
    items: NDArray[np.int64],
) -> int:
    """Fill a guide with shortest ways of any angle; returns how many cells were reached.

    A wave front by distance as NF1's, but a cell that sees its neighbour's waypoint takes that
    waypoint over (lines of sight are tested once a cell, when it leaves the heap).
    `keys` and `items` hold 8 entries a cell plus one.
    """
    _, ny, nx = grid.clearance.shape
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
        if reached > 0 and not line_is_clear(grid, layer, x, y, own[1], own[2], radius):
            own[0] = np.inf
            for dj in range(-1, 2):
                for di in range(-1, 2):
                    nj = j + dj
                    ni = i + di
                    if 0 <= nj < ny and 0 <= ni < nx and settled[layer, nj, ni]:
                        if (
                            dj != 0
                            and di != 0
                            and (
                                grid.clearance[layer, j, ni] < radius
                                or grid.clearance[layer, nj, i] < radius
                            )
                        ):
                            continue
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
                if not (0 <= nj < ny and 0 <= ni < nx) or settled[layer, nj, ni]:
                    continue
                if grid.clearance[layer, nj, ni] < radius:
                    continue
                if (
                    dj != 0
                    and di != 0
                    and (
                        grid.clearance[layer, j, ni] < radius
                        or grid.clearance[layer, nj, i] < radius
                    )
                ):
                    continue
                cx = grid.x0 + (ni + 0.5) * grid.cell_m
                cy = grid.y0 + (nj + 0.5) * grid.cell_m
                left = own[0]
                wx = own[1]
                wy = own[2]
                if np.hypot(wx - cx, wy - cy) > LONGEST_SIGHT_M:
                    left = own[0] + np.hypot(wx - x, wy - y)
                    wx = x
                    wy = y
                cost = left + np.hypot(wx - cx, wy - cy)
                if cost < potential_at(grid, guide, layer, cx, cy):
                    guide[layer, nj, ni, 0] = left
                    guide[layer, nj, ni, 1] = wx
                    guide[layer, nj, ni, 2] = wy
                    size = heap_push(keys, items, size, cost, nj * nx + ni)
    _extend_into_obstacles(grid, guide, settled, layer)
    return reached


@kernel
def _extend_into_obstacles(
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
def nf1_wave(
    grid: GridArrays,
    radius: float,
    layer: int,
    goal_x: float,
    goal_y: float,
    guide: Guide,
    settled: NDArray[np.uint8],
    keys: NDArray[np.float64],
    items: NDArray[np.int64],
) -> int:
    """NF1 as in the paper: the wave spreads from cell to cell; returns how many were reached.

    Neighbours are the eight around, a diagonal costs sqrt(2) and must not cut a corner. A cell's
    waypoint is the neighbour that it was reached from.
    """
    _, ny, nx = grid.clearance.shape
    guide[:, :, :, 0] = np.inf
    guide[:, :, :, 1:] = 0.0
    settled[:] = 0
    gj, gi = cell_at(grid, goal_x, goal_y)
    guide[layer, gj, gi, 0] = 0.0
    guide[layer, gj, gi, 1] = grid.x0 + (gi + 0.5) * grid.cell_m
    guide[layer, gj, gi, 2] = grid.y0 + (gj + 0.5) * grid.cell_m
    size = heap_push(keys, items, 0, 0.0, gj * nx + gi)
    reached = 0
    while size > 0:
        value = keys[0]
        cell = items[0]
        size = heap_pop(keys, items, size)
        j = cell // nx
        i = cell % nx
        if settled[layer, j, i]:
            continue
        settled[layer, j, i] = 1
        reached += 1
        x = grid.x0 + (i + 0.5) * grid.cell_m
        y = grid.y0 + (j + 0.5) * grid.cell_m
        for dj in range(-1, 2):
            for di in range(-1, 2):
                nj = j + dj
                ni = i + di
                if not (0 <= nj < ny and 0 <= ni < nx) or settled[layer, nj, ni]:
                    continue
                if grid.clearance[layer, nj, ni] < radius:
                    continue
                if (
                    dj != 0
                    and di != 0
                    and (
                        grid.clearance[layer, j, ni] < radius
                        or grid.clearance[layer, nj, i] < radius
                    )
                ):
                    continue
                cost = value + grid.cell_m * np.sqrt(float(dj * dj + di * di))
                cx = grid.x0 + (ni + 0.5) * grid.cell_m
                cy = grid.y0 + (nj + 0.5) * grid.cell_m
                if cost < potential_at(grid, guide, layer, cx, cy) - 1e-9:
                    guide[layer, nj, ni, 0] = value
                    guide[layer, nj, ni, 1] = x
                    guide[layer, nj, ni, 2] = y
                    size = heap_push(keys, items, size, cost, nj * nx + ni)
    return reached


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
