"""The grid of one zone on bare arrays: clearance look-ups and lines of sight."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._jit import inlined, kernel


class GridArrays(NamedTuple):
    """What kernels know of a zone's ground."""

    clearance: NDArray[np.float32]
    """(L, ny, nx): distance from a cell's centre to the nearest obstacle, negative inside one,
    capped at `CLEARANCE_CAP_M`."""
    x0: float
    y0: float
    x1: float
    y1: float
    cell_m: float


@inlined
def length(x: float, y: float) -> float:
    """Length of a vector; quicker than `np.hypot`, which guards against overflow."""
    return float(np.sqrt(x * x + y * y))


@inlined
def cell_at(grid: GridArrays, x: float, y: float) -> tuple[int, int]:
    """Row and column of the cell that holds a point, clamped to the grid."""
    _, ny, nx = grid.clearance.shape
    j = min(ny - 1, max(0, int((y - grid.y0) / grid.cell_m)))
    i = min(nx - 1, max(0, int((x - grid.x0) / grid.cell_m)))
    return j, i


@inlined
def clearance_at(grid: GridArrays, layer: int, x: float, y: float) -> float:
    """Distance to the nearest obstacle by bilinear interpolation; -inf outside the bounds."""
    if not (grid.x0 <= x <= grid.x1 and grid.y0 <= y <= grid.y1):
        return -np.inf
    _, ny, nx = grid.clearance.shape
    u = (x - grid.x0) / grid.cell_m - 0.5
    v = (y - grid.y0) / grid.cell_m - 0.5
    i = min(max(nx - 2, 0), max(0, int(np.floor(u))))
    j = min(max(ny - 2, 0), max(0, int(np.floor(v))))
    i1 = min(nx - 1, i + 1)
    j1 = min(ny - 1, j + 1)
    u = min(1.0, max(0.0, u - i))
    v = min(1.0, max(0.0, v - j))
    c = grid.clearance
    lower = (1.0 - u) * c[layer, j, i] + u * c[layer, j, i1]
    upper = (1.0 - u) * c[layer, j1, i] + u * c[layer, j1, i1]
    return float((1.0 - v) * lower + v * upper)


@kernel
def line_is_clear(
    grid: GridArrays, layer: int, ax: float, ay: float, bx: float, by: float, radius: float
) -> bool:
    """Whether a disc may move straight from a to b; sphere-traced, so cheap in the open."""
    length = np.hypot(bx - ax, by - ay)
    shortest = 0.5 * grid.cell_m
    s = 0.0
    while True:
        u = s / length if length > 0.0 else 0.0
        room = clearance_at(grid, layer, ax + u * (bx - ax), ay + u * (by - ay)) - radius
        if room < 0.0:
            return False
        if s >= length:
            return True
        s = min(length, s + max(room, shortest))


@kernel
def clearance_many(
    grid: GridArrays,
    layers: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """`clearance_at` for (N,), (N, 2) -> out (N,)."""
    for k in range(len(positions)):
        out[k] = clearance_at(grid, layers[k], positions[k, 0], positions[k, 1])
