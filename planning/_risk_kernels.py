"""Risk fields on bare arrays, Lei & Li, eq. (5)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._grid_kernels import GridArrays, corners
from planning._jit import inlined, kernel
from planning._prediction_kernels import Prediction
from planning._reservation_kernels import OVERLAP_M


class RadialTables(NamedTuple):
    """What one predicted person adds at a distance, by deviation (rows) and distance (columns).

    Columns are even in the squared distance, so that no root has to be drawn. `near` is the
    proximity term; `toward` the factor of the closing speed over the distance, so that its
    product with the offset is the factor times n. Both are means over the person's likely range.
    `reaches` holds for each row how many columns matter.
    """

    near: NDArray[np.float32]
    toward: NDArray[np.float32]
    reaches: NDArray[np.int64]
    sigma_step_m: float
    squared_step_m2: float


RiskFields = NDArray[np.float32]
"""(K, N, 4): proximity, closing factor times n (x, y), closing factor times v_o·n, at the centres
of cells; slice by slice."""


@inlined
def _row_of(tables: RadialTables, sigma: float) -> float:
    """Row of a deviation, between two as a rule."""
    return min(len(tables.near) - 1.000001, max(0.0, sigma / tables.sigma_step_m))


@inlined
def _columns(tables: RadialTables, row: float) -> int:
    """How many columns matter there."""
    return int(max(tables.reaches[int(row)], tables.reaches[int(row) + 1]))


@inlined
def _blend_rows(
    tables: RadialTables, row: float, near: NDArray[np.float32], toward: NDArray[np.float32]
) -> None:
    """Tables for one deviation into two rows."""
    r = int(row)
    w1 = np.float32(row - r)
    w0 = np.float32(1.0) - w1
    for c in range(_columns(tables, row) + 1):
        near[c] = w0 * tables.near[r, c] + w1 * tables.near[r + 1, c]
        toward[c] = w0 * tables.toward[r, c] + w1 * tables.toward[r + 1, c]


@kernel
def _matters(
    x: float, y: float, reach: float, seconds: float, seekers: NDArray[np.float64]
) -> bool:
    """Whether any seeker may come within reach of a point by then; without seekers all matters."""
    for s in range(len(seekers)):
        room = reach + seekers[s, 2] * seconds
        if (seekers[s, 0] - x) ** 2 + (seekers[s, 1] - y) ** 2 <= room * room:
            return True
    return len(seekers) == 0


@kernel
def _box(
    grid: GridArrays, seconds: float, seekers: NDArray[np.float64]
) -> tuple[int, int, int, int]:
    """Rows and columns (j0, j1, i0, i1) that any seeker may look at by then."""
    ny = grid.layered.ny
    nx = grid.layered.nx
    j0, j1, i0, i1 = (ny, 0, nx, 0) if len(seekers) else (0, ny, 0, nx)
    for s in range(len(seekers)):
        room = seekers[s, 2] * seconds + 2.0 * grid.layered.cell_m
        x = seekers[s, 0] - grid.layered.x0
        y = seekers[s, 1] - grid.layered.y0
        j0 = min(j0, max(0, int((y - room) / grid.layered.cell_m)))
        j1 = max(j1, min(ny, int((y + room) / grid.layered.cell_m) + 1))
        i0 = min(i0, max(0, int((x - room) / grid.layered.cell_m)))
        i1 = max(i1, min(nx, int((x + room) / grid.layered.cell_m) + 1))
    return j0, j1, i0, i1


@kernel
def _clear(
    grid: GridArrays, j0: int, j1: int, i0: int, i1: int, field: NDArray[np.float32]
) -> None:
    """Zero a window of a field (N, 4) on every layer."""
    for layer in range(len(grid.layered.pages)):
        for j in range(j0, j1):
            i = i0
            while i < i1:
                page = grid.layered.pages[layer, j >> 3, i >> 3]
                last = min(i1, (i | 7) + 1)
                if page >= 0:
                    first = page + ((j & 7) << 3) + (i & 7)
                    field[first : first + last - i] = 0.0
                i = last


@kernel
def fill_slices(
    grid: GridArrays,
    tables: RadialTables,
    prediction: Prediction,
    seekers: NDArray[np.float64],
    slice_s: float,
    last_wider: int,
    first: int,
    step: int,
    windows: NDArray[np.int64],
    fields: RiskFields,
) -> None:
    """Fill slices first, first + step, ... Only cells near people are touched.

    `seekers` (S, 3) are places and greatest speeds of those who will look things up: what nobody
    can reach by the time of a slice is left out. After slice `last_wider` deviations grow no
    more. `windows` (K, P', 4) remembers what was written (j0, j1, i0, i1) so that the next call
    clears no more than that; rows with j0 -1 are empty.
    """
    people = len(prediction.means)
    columns = tables.near.shape[1]
    near = np.zeros(columns, dtype=np.float32)
    toward = np.zeros(columns, dtype=np.float32)
    cell_m = np.float32(grid.layered.cell_m)
    per_column = np.float32(1.0 / tables.squared_step_m2)
    for k in range(first, len(fields), step):
        for w in range(windows.shape[1]):
            j0, j1, i0, i1 = windows[k, w]
            if j0 < 0:
                break
            _clear(grid, j0, j1, i0, i1, fields[k])
            windows[k, w, 0] = -1
        written = 0
        box_j0, box_j1, box_i0, box_i1 = _box(grid, k * slice_s, seekers)
        for p in range(people):
            mx = prediction.means[p, k, 0]
            my = prediction.means[p, k, 1]
            vx = np.float32(prediction.velocities[p, k, 0])
            vy = np.float32(prediction.velocities[p, k, 1])
            blended = _row_of(tables, prediction.sigmas[p, min(k, last_wider)])
            reach = float(np.sqrt(_columns(tables, blended) * tables.squared_step_m2))
            if not _matters(mx, my, reach + 2.0 * grid.layered.cell_m, k * slice_s, seekers):
                continue
            i0 = max(box_i0, int(np.floor((mx - reach - grid.layered.x0) / grid.layered.cell_m)))
            i1 = min(
                box_i1, int(np.floor((mx + reach - grid.layered.x0) / grid.layered.cell_m)) + 1
            )
            j0 = max(box_j0, int(np.floor((my - reach - grid.layered.y0) / grid.layered.cell_m)))
            j1 = min(
                box_j1, int(np.floor((my + reach - grid.layered.y0) / grid.layered.cell_m)) + 1
            )
            if i0 >= i1 or j0 >= j1:
                continue
            _blend_rows(tables, blended, near, toward)
            windows[k, written, 0] = j0
            windows[k, written, 1] = j1
            windows[k, written, 2] = i0
            windows[k, written, 3] = i1
            written += 1
            feet = np.float32(prediction.heights[p, k])
            most = np.float32(reach * reach)
            for layer in range(len(grid.layered.pages)):
                for j in range(j0, j1):
                    ry = np.float32(grid.layered.y0 + (j + 0.5) * grid.layered.cell_m - my)
                    vy_ry = vy * ry
                    ry2 = ry * ry
                    i = i0
                    while i < i1:
                        page = grid.layered.pages[layer, j >> 3, i >> 3]
                        last = min(i1, (i | 7) + 1)
                        if page < 0:
                            i = last
                            continue
                        cell = page + ((j & 7) << 3) + (i & 7)
                        rx = np.float32(grid.layered.x0 + (i + 0.5) * grid.layered.cell_m - mx)
                        while i < last:
                            d2 = rx * rx + ry2
                            apart = feet - grid.layered.floors[cell]
                            if d2 < most and (grid.flat or abs(apart) < OVERLAP_M):
                                u = d2 * per_column
                                c = int(u)
                                w1 = u - np.float32(c)
                                w0 = np.float32(1.0) - w1
                                t = w0 * toward[c] + w1 * toward[c + 1]
                                here = fields[k, cell]
                                here[0] += w0 * near[c] + w1 * near[c + 1]
                                here[1] += t * rx
                                here[2] += t * ry
                                here[3] += t * (vx * rx + vy_ry)
                            rx += cell_m
                            cell += 1
                            i += 1


@inlined
def risk_at(
    grid: GridArrays,
    fields: RiskFields,
    k: int,
    cell: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    closing_weight: float,
) -> float:
    """Risk of being at (x, y), in a cell, with velocity (vx, vy) at slice k, in closed form O(1).

    proximity + closing_weight * max(0, sum of p (v_o - v_r)·n), n from the person to here.
    """
    beside, over, across, u, v = corners(grid, cell, x, y)
    a = fields[k, cell]
    b = fields[k, beside]
    c = fields[k, over]
    d = fields[k, across]
    wa = (1.0 - u) * (1.0 - v)
    wb = u * (1.0 - v)
    wc = (1.0 - u) * v
    wd = u * v
    near = wa * a[0] + wb * b[0] + wc * c[0] + wd * d[0]
    if near == 0.0:
        return 0.0
    nx = wa * a[1] + wb * b[1] + wc * c[1] + wd * d[1]
    ny = wa * a[2] + wb * b[2] + wc * c[2] + wd * d[2]
    vo = wa * a[3] + wb * b[3] + wc * c[3] + wd * d[3]
    closing = vo - vx * nx - vy * ny
    return float(near + closing_weight * max(0.0, closing))


@kernel
def risk_many(
    grid: GridArrays,
    fields: RiskFields,
    k: int,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    velocities: NDArray[np.float64],
    closing_weight: float,
    out: NDArray[np.float64],
) -> None:
    """`risk_at` for (N,), (N, 2), (N, 2) -> out (N,); 0 where nobody can stand."""
    for n in range(len(positions)):
        out[n] = 0.0
        if cells[n] >= 0:
            out[n] = risk_at(
                grid,
                fields,
                k,
                cells[n],
                positions[n, 0],
                positions[n, 1],
                velocities[n, 0],
                velocities[n, 1],
                closing_weight,
            )
