"""Walking on layers and deriving clearances, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from planning._geometry_kernels import (
    SegmentIndex,
    Stance,
    point_segment_distance,
    slide,
    stops,
)
from planning._grid_kernels import GridArrays, corners, follow
from planning._jit import inlined, kernel


@inlined
def _foothold(grid: GridArrays, cell: int, x: float, y: float, step_on_m: float) -> float:
    """Height of the highest floor around a point that a body in a cell can step on.

    Stairs rise within a cell: who is nearly out of it may have a foot on the next tread already.
    """
    floor = grid.layered.floors[cell]
    beside, over, across, _, _ = corners(grid, cell, x, y)
    top = floor
    for other in (beside, over, across):
        if top < grid.layered.floors[other] <= floor + step_on_m:
            top = grid.layered.floors[other]
    return float(top)


@inlined
def walk(
    grid: GridArrays,
    index: SegmentIndex,
    height_m: float,
    step_on_m: float,
    cell: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    clearance: float,
) -> tuple[int, float, float]:
    """Move a body by (dx, dy), sliding along what stops it, up and down what it can step on.

    Where there is nothing to stand on it stays. Over several levels the way is cut into pieces of
    a cell at most, since what stops it depends on where it stands.
    """
    bounds = (grid.layered.x0, grid.layered.y0, grid.layered.x1, grid.layered.y1)
    if grid.flat:
        stance = Stance(0.0, 0.0, height_m, step_on_m)
        nx, ny = slide(index, stance, bounds, x, y, dx, dy, clearance)
        return follow(grid, cell, nx, ny), nx, ny
    pieces = max(1, int(np.ceil(np.hypot(dx, dy) / (0.8 * grid.layered.cell_m))))
    for _ in range(pieces):
        foothold = _foothold(grid, cell, x, y, step_on_m)
        stance = Stance(float(grid.layered.floors[cell]), foothold, height_m, step_on_m)
        nx, ny = slide(index, stance, bounds, x, y, dx / pieces, dy / pieces, clearance)
        other = follow(grid, cell, nx, ny)
        if (
            other < 0
            or abs(grid.layered.floors[other] - grid.layered.floors[cell]) > step_on_m + 1e-4
        ):
            break
        cell = other
        x = nx
        y = ny
    return cell, x, y


@kernel
def walk_many(
    grid: GridArrays,
    index: SegmentIndex,
    height_m: float,
    step_on_m: float,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    displacements: NDArray[np.float64],
    clearance: float,
) -> None:
    """`walk` for N bodies in place: cells (N,), positions (N, 2) by displacements (N, 2)."""
    for n in range(len(cells)):
        if cells[n] < 0 and not grid.flat:
            continue
        cells[n], positions[n, 0], positions[n, 1] = walk(
            grid,
            index,
            height_m,
            step_on_m,
            cells[n],
            positions[n, 0],
            positions[n, 1],
            displacements[n, 0],
            displacements[n, 1],
            clearance,
        )


@kernel
def lower_to_barriers(
    grid: GridArrays,
    index: SegmentIndex,
    height_m: float,
    step_on_m: float,
    reach: float,
    box: tuple[float, float, float, float],
    field: NDArray[np.float32],
) -> None:
    """Lower a field (N,), preset to `reach`, to the distances of cells from what stops a body.

    Only cells whose centres lie in `box` (x0, y0, x1, y1) are looked at.
    """
    cell_m = grid.layered.cell_m
    for s in range(len(index.segments)):
        ax = index.segments[s, 0]
        ay = index.segments[s, 1]
        bx = index.segments[s, 2]
        by = index.segments[s, 3]
        i0 = max(0, int((max(box[0], min(ax, bx) - reach) - grid.layered.x0) / cell_m) - 1)
        i1 = min(
            grid.layered.nx, int((min(box[2], max(ax, bx) + reach) - grid.layered.x0) / cell_m) + 2
        )
        j0 = max(0, int((max(box[1], min(ay, by) - reach) - grid.layered.y0) / cell_m) - 1)
        j1 = min(
            grid.layered.ny, int((min(box[3], max(ay, by) + reach) - grid.layered.y0) / cell_m) + 2
        )
        for layer in range(len(grid.layered.pages)):
            for j in range(j0, j1):
                for i in range(i0, i1):
                    page = grid.layered.pages[layer, j >> 3, i >> 3]
                    if page < 0:
                        continue
                    cell = page + ((j & 7) << 3) + (i & 7)
                    floor = 0.0 if grid.flat else float(grid.layered.floors[cell])
                    stance = Stance(floor, floor, height_m, step_on_m)
                    if not stops(index, s, stance):
                        continue
                    d = point_segment_distance(
                        grid.layered.x0 + (i + 0.5) * cell_m,
                        grid.layered.y0 + (j + 0.5) * cell_m,
                        ax,
                        ay,
                        bx,
                        by,
                    )[0]
                    field[cell] = min(field[cell], d)
