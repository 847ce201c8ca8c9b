"""Lintels of meshes on bare arrays: what hangs so low that it may hinder, and where it ends.

A ceiling ends at the upright faces at its sides, which are barriers of their own, or at a *hem*: an
edge of a triangle where no other one continues the sheet, and no upright face begins. Hems lie
exactly where the mesh has them. Ceilings that slope change height without either; there lintels
lie between neighbouring cells.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._geometry_kernels import crosses
from esplanade.planning.ground._ledge_kernels import LEAST_STEP_M, append_barrier
from esplanade.planning.ground._mesh_kernels import DOWN
from esplanade.planning.ground._surface_kernels import LEAST_HEADROOM_M, Raster
from esplanade.planning.ground._triangle_kernels import (
    SIDEWAYS,
    Column,
    TriangleBuckets,
    corner_hash,
    edge_key,
    new_column,
    surfaces_at,
)
from esplanade.planning.ground.layered import (
    LINK_COLUMNS,
    LINK_ROWS,
    TILE,
    LayeredArrays,
    cell_index,
)

_HEIGHT_M = 0.2
"""Height of a lintel's barrier: more than the headroom that a body may lack under the lintel, less
than the height of a step on top of it."""
_HIGHEST_M = 2.5
"""Ceilings further above a floor than this hinder nobody."""
_BESIDE_M = 1e-3
_SAME_M = 0.02
"""A ceiling this near in height to a hem is the one that ends there."""
_CHUNK_M = 1.0
"""Long hems are treated in pieces of this length."""
_LEAST_M = 0.05
"""Pieces of a hem shorter than this are not divided further."""
_PIECE_RISE_M = 0.1
"""Pieces of a hem rise by no more than this."""

_CARRIES, _HANGS, _STANDS = 1, 2, 4
"""Triangles that look up, those that look down, and upright ones."""


@inlined
def _look(kind: int) -> int:
    """How a triangle of a kind looks."""
    if kind == SIDEWAYS:
        return _STANDS
    return _HANGS if kind == DOWN else _CARRIES


@kernel
def find_hems(
    triangles: NDArray[np.float64], kinds: NDArray[np.uint8], hems: NDArray[np.uint8]
) -> None:
    """Write the hems among the edges of triangles (T, 3, 3) into `hems` (T,).

    Bit k stands for the edge from corner k. What looks up next to what looks down is a fold, where
    the sheet that looks down ends.
    """
    size = 16
    while size < 6 * len(kinds):
        size *= 2
    table = np.zeros(size, dtype=np.int64)
    looks = np.zeros(size, dtype=np.uint8)
    for search in (False, True):
        for t in range(len(kinds)):
            look = _look(kinds[t])
            if search:
                hems[t] = 0
                if look == _STANDS:
                    continue
            a = corner_hash(triangles[t, 0, 0], triangles[t, 0, 1], triangles[t, 0, 2])
            b = corner_hash(triangles[t, 1, 0], triangles[t, 1, 1], triangles[t, 1, 2])
            c = corner_hash(triangles[t, 2, 0], triangles[t, 2, 1], triangles[t, 2, 2])
            for k in range(3):
                one, two = (a, b) if k == 0 else ((b, c) if k == 1 else (c, a))
                key = edge_key(two, one) if search else edge_key(one, two)
                at = key & np.int64(size - 1)
                while table[at] != 0 and table[at] != key:
                    at = (at + 1) & np.int64(size - 1)
                if not search:
                    table[at] = key
                    looks[at] |= look
                elif table[at] == 0 or (look == _HANGS and looks[at] == _CARRIES):
                    hems[t] |= 1 << k


@inlined
def _may_hinder(
    raster: Raster,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    x: float,
    y: float,
    low: float,
    high: float,
) -> bool:
    """Whether a cell within two cells of a point has a floor that something so high hangs over."""
    i = int(np.floor((x - raster.x0) / raster.cell_m))
    j = int(np.floor((y - raster.y0) / raster.cell_m))
    for jj in range(max(0, j - 2), min(raster.ny, j + 3)):
        first = starts[jj * raster.nx + min(raster.nx - 1, max(0, i - 2))]
        last = starts[jj * raster.nx + min(raster.nx - 1, max(0, i + 2)) + 1]
        for s in range(first, last):
            if low < floors[s] + _HIGHEST_M and high >= floors[s] + LEAST_HEADROOM_M - _SAME_M:
                return True
    return False


@kernel
def _ends_at(
    buckets: TriangleBuckets,
    x: float,
    y: float,
    z: float,
    normal: tuple[float, float],
    column: Column,
) -> bool:
    """Whether a ceiling that may hinder ends at a point of a hem, whose normal leads away from it.

    The space beyond goes on above the hem, and below the hem there is a ceiling at its height.
    """
    nx, ny = normal
    goes_on = False
    for s in range(surfaces_at(buckets, x + _BESIDE_M * nx, y + _BESIDE_M * ny, column)):
        room = z - float(column.floors[s])
        if (
            LEAST_HEADROOM_M - _SAME_M <= room < _HIGHEST_M
            and float(column.ceilings[s]) >= z + LEAST_STEP_M
        ):
            goes_on = True
    if not goes_on:
        return False
    for s in range(surfaces_at(buckets, x - _BESIDE_M * nx, y - _BESIDE_M * ny, column)):
        if abs(float(column.ceilings[s]) - z) < _SAME_M:
            return True
    return False


@kernel
def _add_lintels(
    buckets: TriangleBuckets,
    line: tuple[float, float, float, float],
    heights: tuple[float, float],
    normal: tuple[float, float],
    column: Column,
    stack: NDArray[np.float64],
    out: NDArray[np.void],
    count: int,
) -> int:
    """Append the lintels of a piece of a hem; returns the new number of barriers.

    `heights` are those of its ends. A piece is halved until it is a lintel all along, or nowhere.
    """
    stack[0, 0], stack[0, 1] = 0.0, 1.0
    size = 1
    ax, ay, bx, by = line
    az, bz = heights
    length = np.hypot(bx - ax, by - ay)
    while size > 0:
        size -= 1
        u, v = stack[size]
        m = 0.5 * (u + v)
        x, y, z = ax + m * (bx - ax), ay + m * (by - ay), az + m * (bz - az)
        ends = _ends_at(buckets, x, y, z, normal, column)
        divided = abs(bz - az) * (v - u) > _PIECE_RISE_M
        if (v - u) * length > _LEAST_M and not divided:
            for share in (
                u + 0.05 * (v - u),
                u + 0.3 * (v - u),
                v - 0.3 * (v - u),
                v - 0.05 * (v - u),
            ):
                x, y, z = ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az)
                if _ends_at(buckets, x, y, z, normal, column) != ends:
                    divided = True
                    break
        if divided and size + 2 <= len(stack):
            stack[size, 0], stack[size, 1] = m, v
            stack[size + 1, 0], stack[size + 1, 1] = u, m
            size += 2
        elif ends:
            piece = (ax + u * (bx - ax), ay + u * (by - ay), ax + v * (bx - ax), ay + v * (by - ay))
            low = min(az + u * (bz - az), az + v * (bz - az))
            count = append_barrier(out, count, piece, (low, low + _HEIGHT_M, np.inf))
    return count


@kernel
def lintels_of_hems(
    buckets: TriangleBuckets,
    hems: NDArray[np.uint8],
    raster: Raster,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    out: NDArray[np.void],
) -> int:
    """Write the lintels along the hems (T,) of triangles into `out`, (S,) of `BARRIER`.

    `starts` and `floors` are the surfaces by column (CSR). Returns the number of lintels; those
    beyond the room in `out` are not written.
    """
    count = 0
    column = new_column()
    stack = np.empty((64, 2))
    x1, y1 = raster.x0 + raster.nx * raster.cell_m, raster.y0 + raster.ny * raster.cell_m
    for t in range(len(hems)):
        for k in range(3):
            if not (hems[t] >> k) & 1:
                continue
            ax, ay, az = buckets.triangles[t, k]
            bx, by, bz = buckets.triangles[t, (k + 1) % 3]
            length = np.hypot(bx - ax, by - ay)
            if length < 2.0 * _BESIDE_M:
                continue
            side = -1.0 if buckets.kinds[t] == DOWN else 1.0
            normal = side * (by - ay) / length, -side * (bx - ax) / length
            chunks = int(np.ceil(length / _CHUNK_M))
            for chunk in range(chunks):
                u, v = chunk / chunks, (chunk + 1) / chunks
                px, py, pz = ax + u * (bx - ax), ay + u * (by - ay), az + u * (bz - az)
                qx, qy, qz = ax + v * (bx - ax), ay + v * (by - ay), az + v * (bz - az)
                mx, my = 0.5 * (px + qx), 0.5 * (py + qy)
                ox, oy = mx + _BESIDE_M * normal[0], my + _BESIDE_M * normal[1]
                if not (raster.x0 < ox < x1 and raster.y0 < oy < y1):
                    continue
                if _may_hinder(raster, starts, floors, mx, my, min(pz, qz), max(pz, qz)):
                    line, ends = (px, py, qx, qy), (pz, qz)
                    count = _add_lintels(buckets, line, ends, normal, column, stack, out, count)
    return count


# --- between cells ----------------------------------------------------------------------------


@kernel
def list_in_columns(
    raster: Raster,
    barriers: NDArray[np.void],
    starts: NDArray[np.int64],
    members: NDArray[np.int32],
) -> None:
    """List the barriers (S,) whose bounding boxes meet each column (CSR).

    If `members` is empty, barriers are only counted, into starts[1:].
    """
    fill = len(members) > 0
    used = np.zeros(raster.ny * raster.nx, dtype=np.int32)
    per_m = 1.0 / raster.cell_m
    for s in range(len(barriers)):
        barrier = barriers[s]
        i0 = int((min(barrier["x0"], barrier["x1"]) - raster.x0) * per_m)
        i1 = int((max(barrier["x0"], barrier["x1"]) - raster.x0) * per_m)
        j0 = int((min(barrier["y0"], barrier["y1"]) - raster.y0) * per_m)
        j1 = int((max(barrier["y0"], barrier["y1"]) - raster.y0) * per_m)
        for j in range(max(0, j0), min(raster.ny, j1 + 1)):
            for i in range(max(0, i0), min(raster.nx, i1 + 1)):
                column = j * raster.nx + i
                if fill:
                    members[starts[column] + used[column]] = s
                else:
                    starts[column + 1] += 1
                used[column] += 1


@inlined
def _is_marked(
    barriers: NDArray[np.void],
    starts: NDArray[np.int64],
    members: NDArray[np.int32],
    column: int,
    low: float,
    line: tuple[float, float, float, float],
) -> bool:
    """Whether one of the barriers of a column crosses a line at the height of a ceiling's end."""
    ax, ay, bx, by = line
    for k in range(starts[column], starts[column + 1]):
        barrier = barriers[members[k]]
        if (
            barrier["bottom_m"] <= low + _SAME_M
            and barrier["top_m"] >= low
            and crosses(barrier, ax, ay, bx, by)
        ):
            return True
    return False


@inlined
def _common_edge(
    arrays: LayeredArrays, j: int, i: int, d: int
) -> tuple[float, float, float, float]:
    """The edge x0, y0, x1, y1 between a cell and its neighbour E, N, W or S.

    It leads from south to north, or from west to east.
    """
    dj, di = LINK_ROWS[d], LINK_COLUMNS[d]
    x = arrays.x0 + (i + 0.5 + 0.5 * di) * arrays.cell_m
    y = arrays.y0 + (j + 0.5 + 0.5 * dj) * arrays.cell_m
    h = 0.5 * arrays.cell_m
    return x - h * abs(dj), y - h * abs(di), x + h * abs(dj), y + h * abs(di)


@kernel
def _cells_along(
    arrays: LayeredArrays,
    layer: int,
    line: int,
    d: int,
    headroom: float,
    cells: NDArray[np.int32],
) -> int:
    """Write the cells of a column (d = 0 or 4) or row of a layer in order; returns their number.

    Tiles are left out that are level and have at least that headroom.
    """
    count = 0
    by_column = d in (0, 4)
    length = arrays.ny if by_column else arrays.nx
    for first in range(0, length, TILE):
        tj, ti = (first // TILE, line // TILE) if by_column else (line // TILE, first // TILE)
        page = arrays.pages[layer, tj, ti]
        if page < 0 or arrays.level_headroom[page // (TILE * TILE)] >= headroom:
            continue
        for k in range(first, min(length, first + TILE)):
            j, i = (k, line) if by_column else (line, k)
            cell = cell_index(arrays, layer, j, i)
            if cell >= 0:
                cells[count] = cell
                count += 1
    return count


@kernel
def lintels_between(
    arrays: LayeredArrays,
    d: int,
    exact: NDArray[np.void],
    starts: NDArray[np.int64],
    members: NDArray[np.int32],
    out: NDArray[np.void],
) -> int:
    """Write barriers where ceilings change height between linked cells, low enough to hinder.

    Cells are compared with their neighbours to the east (d = 0) or north (d = 2). Where one of the
    barriers `exact` (S,), listed by column as `list_in_columns` does, lies between the centres,
    there is none. Returns the number of barriers; those beyond the room in `out` are not written.
    """
    count = 0
    cells = np.empty(max(arrays.ny, arrays.nx), dtype=np.int32)
    half = 0.5 * arrays.cell_m
    for layer in range(arrays.pages.shape[0]):
        for line in range(arrays.nx if d == 0 else arrays.ny):
            for cell in cells[: _cells_along(arrays, layer, line, d, _HIGHEST_M, cells)]:
                other = arrays.links[cell, d]
                if other < 0:
                    continue
                above, beside = float(arrays.ceilings[cell]), float(arrays.ceilings[other])
                low, high = min(above, beside), max(above, beside)
                floor = max(arrays.floors[cell], arrays.floors[other])
                if not (high - low >= LEAST_STEP_M and low < floor + _HIGHEST_M):
                    continue
                j, i = arrays.places[cell]["row"], arrays.places[cell]["column"]
                x0, y0, x1, y1 = _common_edge(arrays, j, i, d)
                mx, my = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
                dx, dy = (half, 0.0) if d == 0 else (0.0, half)
                between = (mx - dx, my - dy, mx + dx, my + dy)
                column = j * arrays.nx + i
                then = column + 1 if d == 0 else column + arrays.nx
                if _is_marked(exact, starts, members, column, low, between) or _is_marked(
                    exact, starts, members, then, low, between
                ):
                    continue
                count = append_barrier(out, count, (x0, y0, x1, y1), (low, low + _HEIGHT_M, np.inf))
    return count
