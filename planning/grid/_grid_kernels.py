"""The ground of one zone on bare arrays: cells, what they are next to, lines of sight.

A point is looked up by the *cell* it is in: the number of a standing surface, which tells layer,
row and column. From there `follow` finds the cell of a point nearby, up and down stairs and ramps.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground.layered import TILE, LayeredArrays, cell_index

REACH_M = 1.0
"""Surfaces that far apart in height are not mistaken for each other from one cell to the next."""


class GridArrays(NamedTuple):
    """What kernels know of a zone's ground and of the bodies on it."""

    layered: LayeredArrays
    clearance: NDArray[np.float32]
    """(B, N) m: for each kind of body the distance from a cell's centre to what stops it, capped at
    `CLEARANCE_CAP_M`."""
    edges: NDArray[np.bool_]
    """(B, N): cells where a step or an edge lies within the radius of that kind of body."""
    flat: bool
    """There is one layer, all of it at height 0: heights need not be looked at. Cells inside
    obstacles count as ground then, with negative clearance."""


@inlined
def length(x: float, y: float) -> float:
    """Length of a vector; quicker than `np.hypot`, which guards against overflow."""
    return float(np.sqrt(x * x + y * y))


@inlined
def row_and_column(grid: GridArrays, x: float, y: float) -> tuple[int, int]:
    """Row and column of the column of cells that holds a point, clamped to the grid."""
    per_m = 1.0 / grid.layered.cell_m  # the same for all: the compiler divides once
    j = min(grid.layered.ny - 1, max(0, int((y - grid.layered.y0) * per_m)))
    i = min(grid.layered.nx - 1, max(0, int((x - grid.layered.x0) * per_m)))
    return j, i


@inlined
def _inside(grid: GridArrays, x: float, y: float) -> bool:
    ground = grid.layered
    return bool(ground.x0 <= x <= ground.x1 and ground.y0 <= y <= ground.y1)


@inlined
def follow(grid: GridArrays, cell: int, x: float, y: float) -> int:
    """Cell of a point near a cell, whatever its layer: the surface nearest in height; -1 if none.

    The two must not be further apart than one gets in a slice: what lies between is not looked at.
    """
    if not _inside(grid, x, y):
        return -1
    j, i = row_and_column(grid, x, y)
    if grid.flat:
        page = grid.layered.pages[0, j >> 3, i >> 3]
        return page + ((j & 7) << 3) + (i & 7) if page >= 0 else -1
    if cell < 0:
        return -1
    floor = grid.layered.floors[cell]
    best = -1
    least = REACH_M
    for layer in range(len(grid.layered.pages)):
        other = cell_index(grid.layered, layer, j, i)
        if other >= 0:
            apart = abs(float(grid.layered.floors[other] - floor))
            if apart < least:
                least = apart
                best = other
    return best


@inlined
def floor_of(grid: GridArrays, cell: int) -> float:
    """Height of a cell's floor; 0 on flat ground, and where nobody can stand."""
    if grid.flat or cell < 0:
        return 0.0
    return float(grid.layered.floors[cell])


@kernel
def follow_path(
    grid: GridArrays,
    path: NDArray[np.float64],
    cells: NDArray[np.int64],
    first: int,
    last: int,
) -> None:
    """Cells (K,) that a path (K, 2) is in after slice first up to slice last."""
    for k in range(first + 1, last + 1):
        cells[k] = follow(grid, cells[k - 1], path[k, 0], path[k, 1])


@kernel
def surface_at(grid: GridArrays, x: float, y: float, z: float) -> int:
    """Cell of the standing surface nearest in height at a point or, if there is none, next to it.

    -1 where nobody can stand for two cells around.
    """
    j, i = row_and_column(grid, x, y)
    for ring in range(3):
        best = -1
        least = np.inf
        for nj in range(max(0, j - ring), min(grid.layered.ny, j + ring + 1)):
            for ni in range(max(0, i - ring), min(grid.layered.nx, i + ring + 1)):
                for layer in range(len(grid.layered.pages)):
                    cell = cell_index(grid.layered, layer, nj, ni)
                    if cell >= 0:
                        aside = length(float(nj - j), float(ni - i))
                        apart = (
                            abs(float(grid.layered.floors[cell] - z)) + aside * grid.layered.cell_m
                        )
                        if apart < least:
                            least = apart
                            best = cell
        if best >= 0:
            return best
    return -1


@inlined
def neighbour(grid: GridArrays, cell: int, dj: int, di: int) -> int:
    """Cell next to a cell, on whatever layer; itself where there is none."""
    if grid.flat:  # within a tile neighbours need not be looked up
        j = ((cell >> 3) & 7) + dj
        i = (cell & 7) + di
        if 0 <= j < TILE and 0 <= i < TILE:
            return cell + (dj << 3) + di
    if dj == 0:
        direction = 0 if di > 0 else 4
    elif dj > 0:
        direction = 2 - di
    else:
        direction = 6 + di
    link = grid.layered.links[cell, direction]
    return link if link >= 0 else cell


@inlined
def corners(grid: GridArrays, cell: int, x: float, y: float) -> tuple[int, int, int, float, float]:
    """The three cells besides its own that a point lies between, and how far toward them.

    (beside, above or below, across, u, v) with u, v in [0, 0.5] of a cell from the own centre.
    """
    j, i = row_and_column(grid, x, y)
    per_m = 1.0 / grid.layered.cell_m
    u = (x - grid.layered.x0) * per_m - (i + 0.5)
    v = (y - grid.layered.y0) * per_m - (j + 0.5)
    di = 1 if u >= 0.0 else -1
    dj = 1 if v >= 0.0 else -1
    if grid.flat:  # a tile may reach beyond the bounds
        if not 0 <= i + di < grid.layered.nx:
            di = 0
        if not 0 <= j + dj < grid.layered.ny:
            dj = 0
    return (
        neighbour(grid, cell, 0, di),
        neighbour(grid, cell, dj, 0),
        neighbour(grid, cell, dj, di),
        abs(u),
        abs(v),
    )


@inlined
def clearance_at(grid: GridArrays, body: int, cell: int, x: float, y: float) -> float:
    """Distance to what stops a body, between the cells around; -inf without a cell."""
    if cell < 0:
        return -np.inf
    beside, over, across, u, v = corners(grid, cell, x, y)
    c = grid.clearance[body]
    lower = (1.0 - u) * c[cell] + u * c[beside]
    upper = (1.0 - u) * c[over] + u * c[across]
    return float((1.0 - v) * lower + v * upper)


@kernel
def line_is_clear(
    grid: GridArrays,
    body: int,
    cell: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    radius: float,
) -> bool:
    """Whether a disc may move straight from a, in `cell`, to b; cheap in the open.

    On one level it is sphere-traced; over several it may not go further than a cell at a time.
    """
    way = length(bx - ax, by - ay)
    shortest = 0.5 * grid.layered.cell_m
    s = 0.0
    while True:
        u = s / way if way > 0.0 else 0.0
        x = ax + u * (bx - ax)
        y = ay + u * (by - ay)
        cell = follow(grid, cell, x, y)
        room = clearance_at(grid, body, cell, x, y) - radius
        if room < 0.0:
            return False
        if s >= way:
            return True
        step = max(room, shortest) if grid.flat else min(max(room, shortest), grid.layered.cell_m)
        s = min(way, s + step)


@kernel
def clearance_many(
    grid: GridArrays,
    body: int,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """`clearance_at` for (N,), (N, 2) -> out (N,); -inf outside the bounds."""
    for k in range(len(positions)):
        x = positions[k, 0]
        y = positions[k, 1]
        out[k] = -np.inf
        if _inside(grid, x, y):
            out[k] = clearance_at(grid, body, cells[k], x, y)


@kernel
def surfaces_at(
    grid: GridArrays,
    positions: NDArray[np.float64],
    heights: NDArray[np.float64],
    out: NDArray[np.int64],
) -> None:
    """`surface_at` for (N, 2), (N,) -> out (N,)."""
    for k in range(len(positions)):
        out[k] = surface_at(grid, positions[k, 0], positions[k, 1], heights[k])


@kernel
def heights_along(grid: GridArrays, cells: NDArray[np.int64], paths: NDArray[np.float64]) -> None:
    """Write the heights of A paths (A, K, 3) that begin in cells (A,) and step by step go on."""
    for a in range(len(cells)):
        cell = cells[a]
        for k in range(paths.shape[1]):
            on = follow(grid, cell, paths[a, k, 0], paths[a, k, 1])
            cell = on if on >= 0 else cell
            paths[a, k, 2] = floor_of(grid, cell)
