"""Walking on layers and deriving clearances, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.handle import Handle
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, corners, follow, surface_at
from esplanade.planning.ground._barrier_kernels import (
    Measures,
    height_to_climb,
    point_barrier_distance,
)
from esplanade.planning.ground._geometry_kernels import (
    LOW_ROOM_M,
    TOLERANCE_M,
    BarrierIndex,
    Placement,
    point_segment_distance,
    slide,
)
from esplanade.planning.ground.layered import TILE

_SHORTEST_M = 0.05
"""Where the floor ahead is too high or low, shorter pieces than this are not tried."""


class GroundArrays(NamedTuple):
    """The grid of a zone, and the barriers that stop bodies on it."""

    grid: GridArrays
    barriers: BarrierIndex


@kernel
def cell_at(ground: Handle[GroundArrays], x: float, y: float, z: float) -> int:
    """`surface_at` for one place."""
    return surface_at(ground.value.grid, x, y, z)


@inlined
def _support(grid: GridArrays, cell: int, x: float, y: float, step_on_m: float) -> float:
    """Height of the highest floor around a point that a body in a cell can step on.

    Stairs rise within a cell: a body at its border may have a foot on the next tread already.
    """
    floor = grid.layered.floors[cell]
    beside, over, across, _, _ = corners(grid, cell, x, y)
    top = floor
    for other in (beside, over, across):
        if top < grid.layered.floors[other] <= floor + step_on_m:
            top = grid.layered.floors[other]
    return float(top)


@inlined
def _may_step(grid: GridArrays, cell: int, other: int, step_on_m: float) -> bool:
    """Whether the floors of two cells differ by no more than a step; not without a floor."""
    if other < 0:
        return False
    return bool(abs(grid.layered.floors[other] - grid.layered.floors[cell]) <= step_on_m + 1e-4)


@inlined
def _cell_ahead(
    grid: GridArrays, cell: int, x: float, y: float, ux: float, uy: float, step_on_m: float
) -> int:
    """The cell of a point that a body in a cell comes to along the unit vector u; -1 if none.

    A column without a floor, such as the steep side of a step in a mesh, is passed where the next
    floor along the way is no higher or lower than a step; over it the body keeps its cell. Barriers
    stop it where a floor really ends.
    """
    other = follow(grid, cell, x, y)
    if other >= 0 or cell < 0:
        return other
    cell_m = grid.layered.cell_m
    beyond = follow(grid, cell, x + cell_m * ux, y + cell_m * uy)
    return cell if _may_step(grid, cell, beyond, step_on_m) else -1


@inlined
def walk(
    grid: GridArrays,
    index: BarrierIndex,
    height_m: float,
    step_on_m: float,
    leg_length_m: float,
    cell: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    clearance: float,
) -> tuple[int, float, float]:
    """Move a body by (dx, dy); it slides along barriers and steps up and down where it can.

    The body stays where there is no floor ahead. Unless the grid is flat, the movement is cut into
    pieces of at most a cell, since it depends on the floor which barriers stop a body. Returns the
    cell and position that the body comes to.
    """
    bounds = (grid.layered.x0, grid.layered.y0, grid.layered.x1, grid.layered.y1)
    if grid.flat:
        placement = Placement(0.0, 0.0, height_m, step_on_m, leg_length_m)
        nx, ny = slide(index, placement, bounds, x, y, dx, dy, clearance)
        return follow(grid, cell, nx, ny), nx, ny
    way_m = np.hypot(dx, dy)
    ux, uy = (dx / way_m, dy / way_m) if way_m > 0.0 else (0.0, 0.0)
    part = 1.0 / max(1, int(np.ceil(way_m / (0.8 * grid.layered.cell_m))))
    done = 0.0
    while done < 1.0 - 1e-9:
        part = min(part, 1.0 - done)
        support = _support(grid, cell, x, y, step_on_m)
        floor = float(grid.layered.floors[cell])
        ahead = follow(grid, cell, x + part * dx, y + part * dy)
        if ahead >= 0:  # up or down, its head passes what is above from the lower floor
            floor = min(floor, float(grid.layered.floors[ahead]))
        placement = Placement(floor, support, height_m, step_on_m, leg_length_m)
        nx, ny = slide(index, placement, bounds, x, y, part * dx, part * dy, clearance)
        other = _cell_ahead(grid, cell, nx, ny, ux, uy, step_on_m)
        if not _may_step(grid, cell, other, step_on_m):
            if part * way_m > _SHORTEST_M:
                part *= 0.5  # two treads at once are too high, one after the other they are not
                continue
            # It goes on along the border of the cell that is too high or low.
            along = (dx, 0.0) if abs(dx) >= abs(dy) else (0.0, dy)
            for _ in range(2):
                nx, ny = slide(
                    index, placement, bounds, x, y, part * along[0], part * along[1], clearance
                )
                other = follow(grid, cell, nx, ny)
                if _may_step(grid, cell, other, step_on_m):
                    break
                along = (dx - along[0], dy - along[1])
            if not _may_step(grid, cell, other, step_on_m):
                break
        done += part
        cell = other
        x = nx
        y = ny
    return cell, x, y


@kernel
def walk_many(
    grid: GridArrays,
    index: BarrierIndex,
    height_m: float,
    step_on_m: float,
    leg_length_m: float,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    displacements: NDArray[np.float64],
    clearance: float,
) -> None:
    """`walk` for N bodies, in place: cells (N,), positions (N, 2), displacements (N, 2)."""
    for n in range(len(cells)):
        if cells[n] < 0 and not grid.flat:
            continue
        cells[n], positions[n, 0], positions[n, 1] = walk(
            grid,
            index,
            height_m,
            step_on_m,
            leg_length_m,
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
    index: BarrierIndex,
    body: Measures,
    reach: float,
    box: tuple[float, float, float, float],
    field: NDArray[np.float32],
) -> None:
    """Lower a field (N,), preset to `reach`, to the distances of cells from barriers, in metres.

    Barriers that do not stop the body are ignored, low ones count as further away (`room_at`). Only
    cells whose centres lie in `box` (x0, y0, x1, y1) are lowered.
    """
    layered, barriers = grid.layered, index.barriers
    pages, cell_m = layered.pages, layered.cell_m
    tile_m = TILE * cell_m
    x0, y0, x1, y1 = box
    highest = np.full(len(layered.level_headroom), reach, dtype=np.float32)
    for s in range(len(barriers)):
        barrier = barriers[s]
        if body.step_on_m >= barrier["climb_m"]:
            continue
        ax, ay, bx, by = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        i0 = max(0, int((max(x0, min(ax, bx) - reach) - layered.x0) / cell_m) - 1)
        i1 = min(layered.nx, int((min(x1, max(ax, bx) + reach) - layered.x0) / cell_m) + 2)
        j0 = max(0, int((max(y0, min(ay, by) - reach) - layered.y0) / cell_m) - 1)
        j1 = min(layered.ny, int((min(y1, max(ay, by) + reach) - layered.y0) / cell_m) + 2)
        for tj in range(j0 // TILE, (j1 - 1) // TILE + 1):
            for ti in range(i0 // TILE, (i1 - 1) // TILE + 1):
                x, y = layered.x0 + (ti + 0.5) * tile_m, layered.y0 + (tj + 0.5) * tile_m
                nearest = point_segment_distance(x, y, ax, ay, bx, by) - 0.71 * tile_m
                if nearest > reach:
                    continue
                rows = max(j0, tj * TILE), min(j1, (tj + 1) * TILE)
                columns = max(i0, ti * TILE), min(i1, (ti + 1) * TILE)
                for layer in range(len(pages)):
                    page = pages[layer, tj, ti]
                    tile = page // (TILE * TILE)
                    if page >= 0 and nearest < highest[tile]:
                        _lower_tile(grid, barrier, body, page, rows, columns, field)
                        highest[tile] = field[page : page + TILE * TILE].max()


@inlined
def _lower_tile(
    grid: GridArrays,
    barrier: np.void,
    body: Measures,
    page: int,
    rows: tuple[int, int],
    columns: tuple[int, int],
    field: NDArray[np.float32],
) -> None:
    """`lower_to_barriers` for one barrier and some cells of one tile."""
    layered = grid.layered
    low_m = max(0.0, body.radius_m - LOW_ROOM_M)
    for j in range(rows[0], rows[1]):
        for i in range(columns[0], columns[1]):
            cell = page + (j % TILE) * TILE + i % TILE
            floor = 0.0 if grid.flat else float(layered.floors[cell])
            climb = height_to_climb(barrier, floor, floor, body.height_m)
            if climb <= body.step_on_m + TOLERANCE_M:
                continue
            x = layered.x0 + (i + 0.5) * layered.cell_m
            y = layered.y0 + (j + 0.5) * layered.cell_m
            d = point_barrier_distance(barrier, x, y)
            if climb <= body.leg_length_m + TOLERANCE_M:
                d += low_m
            field[cell] = min(field[cell], d)
