"""Triangles of a mesh on bare arrays: surfaces to stand on, and faces too steep for that."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel
from esplanade.planning.ground._surface_kernels import LEAST_HEADROOM_M, Raster

STEEPEST = np.cos(np.pi / 4.0)
"""Up-component of the normal of the steepest face that carries anyone: 45 degrees."""
_TOGETHER_M = 0.01
"""Faces of one column closer together than this are one."""
_TOLERANCE = 1e-9
_HEADROOM_M = 2.5
"""Faces further above a floor than this touch nobody."""
_STEP_M = 0.05
"""Faces that rise no higher above a floor than this are no obstacle."""
_BUCKET_M = 0.1
"""Surfaces wait in buckets of this height while a region grows."""

DOWN, UP, STEEP = 0, 1, 2
"""Kinds of hits: an underside, a top that carries, a top that is too steep to carry."""


@kernel
def hits_of_triangles(
    raster: Raster,
    triangles: NDArray[np.float64],
    fill: bool,
    starts: NDArray[np.int64],
    heights: NDArray[np.float32],
    kinds: NDArray[np.uint8],
) -> None:
    """Find where triangles (T, 3, 3) meet the verticals through the centres of columns.

    It is called first without `fill`, to count the hits of column c in starts[c + 1], then, once
    `starts` have been summed, with `fill`: starts[c] then moves to the end of column c.
    """
    for t in range(len(triangles)):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangles[t]
        ux, uy, uz = bx - ax, by - ay, bz - az
        vx, vy, vz = cx - ax, cy - ay, cz - az
        up = ux * vy - uy * vx
        if abs(up) < 1e-12:
            continue
        area = np.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + up * up)
        kind = DOWN if up < 0.0 else (UP if up >= STEEPEST * area else STEEP)
        i0 = max(0, int(np.ceil((min(ax, bx, cx) - raster.x0) / raster.cell_m - 0.5 - _TOLERANCE)))
        j0 = max(0, int(np.ceil((min(ay, by, cy) - raster.y0) / raster.cell_m - 0.5 - _TOLERANCE)))
        i1 = int(np.floor((max(ax, bx, cx) - raster.x0) / raster.cell_m - 0.5 + _TOLERANCE)) + 1
        j1 = int(np.floor((max(ay, by, cy) - raster.y0) / raster.cell_m - 0.5 + _TOLERANCE)) + 1
        for j in range(j0, min(raster.ny, j1)):
            y = raster.y0 + (j + 0.5) * raster.cell_m - ay
            for i in range(i0, min(raster.nx, i1)):
                x = raster.x0 + (i + 0.5) * raster.cell_m - ax
                # On an edge the triangles on both sides count, so that no hit is missed.
                b = (x * vy - y * vx) / up
                c = (ux * y - uy * x) / up
                if b < -_TOLERANCE or c < -_TOLERANCE or b + c > 1.0 + _TOLERANCE:
                    continue
                column = j * raster.nx + i
                if fill:
                    heights[starts[column]] = az + b * uz + c * vz
                    kinds[starts[column]] = kind
                    starts[column] += 1
                else:
                    starts[column + 1] += 1


@kernel
def _sort_hits(heights: NDArray[np.float32], kinds: NDArray[np.uint8]) -> None:
    """Sort the hits of a column by height, in place."""
    for a in range(1, len(heights)):
        z, kind = heights[a], kinds[a]
        b = a
        while b > 0 and heights[b - 1] > z:
            heights[b] = heights[b - 1]
            kinds[b] = kinds[b - 1]
            b -= 1
        heights[b] = z
        kinds[b] = kind


@kernel
def surfaces_of_hits(
    starts: NDArray[np.int64],
    heights: NDArray[np.float32],
    kinds: NDArray[np.uint8],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
    surface_starts: NDArray[np.int32],
) -> int:
    """Find the standing surfaces of every column, lowest first; returns their number.

    Hits close together are one. A hit that is a top and an underside at once is either a floor
    that something stands on, or a plane with two faces. In the first case the next hit above is a
    top alone, and the floor is buried.
    """
    used = 0
    columns = len(starts) - 1
    for column in range(columns):
        surface_starts[column] = used
        first, last = starts[column], starts[column + 1]
        _sort_hits(heights[first:last], kinds[first:last])
        below = -1
        two_faced = False
        a = first
        while a < last:
            b = a
            down, top, carries = False, False, False
            while b < last and heights[b] - heights[a] < _TOGETHER_M:
                down = down or kinds[b] == DOWN
                top = top or kinds[b] != DOWN
                carries = carries or kinds[b] == UP
                b += 1
            if below >= 0:
                buried = two_faced and not down
                if heights[a] - floors[below] < LEAST_HEADROOM_M or buried:
                    used -= 1
                else:
                    ceilings[below] = heights[a]
            below = -1
            if carries:
                floors[used] = heights[b - 1]
                ceilings[used] = np.inf
                below = used
                two_faced = down
                used += 1
            a = b
    surface_starts[columns] = used
    return used


@kernel
def _cut(shape: NDArray[np.float64], count: int, axis: int, limit: float, sign: float) -> int:
    """Cut a polygon (K, 3) to where sign * (coordinate - limit) <= 0, in place; its new length."""
    kept = np.empty((12, 3))
    new = 0
    for a in range(count):
        b = (a + 1) % count
        da = sign * (shape[a, axis] - limit)
        db = sign * (shape[b, axis] - limit)
        if da <= 0.0:
            kept[new] = shape[a]
            new += 1
        if (da < 0.0 < db) or (db < 0.0 < da):
            kept[new] = shape[a] + (da / (da - db)) * (shape[b] - shape[a])
            new += 1
    shape[:new] = kept[:new]
    return new


@kernel
def _matters(
    raster: Raster,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    place: tuple[int, int, int],
    low: float,
    high: float,
) -> bool:
    """Whether a body that stands near (row, column, cells around) could touch low .. high."""
    j, i, reach = place
    for jj in range(max(0, j - reach), min(raster.ny, j + reach + 1)):
        row = jj * raster.nx
        first = starts[row + max(0, i - reach)]
        last = starts[row + min(raster.nx - 1, i + reach) + 1]
        for s in range(first, last):
            if low < floors[s] + _HEADROOM_M and high > floors[s] + _STEP_M:
                return True
    return False


@kernel
def steep_faces(
    raster: Raster,
    triangles: NDArray[np.float64],
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    out: NDArray[np.void],
) -> int:
    """Cut triangles (T, 3, 3) that are too steep to stand on into pieces, one for each column.

    `out` (R,) of `FACE` receives each piece that anyone could touch. A piece that is not upright
    is taken for the level line through its middle. Returns the number of pieces; those beyond the
    room in `out` are not written.
    """
    count = 0
    cell = raster.cell_m
    reach = int(np.ceil(0.5 / cell))
    shape = np.empty((12, 3))
    for t in range(len(triangles)):
        corners = triangles[t]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        size = np.sqrt((normal * normal).sum())
        level = np.hypot(normal[0], normal[1])
        if size < 1e-12 or abs(normal[2]) >= STEEPEST * size:
            continue
        nx, ny = normal[0] / level, normal[1] / level
        away = corners[:, 0] * nx + corners[:, 1] * ny
        low, high = corners[:, 2].min(), corners[:, 2].max()
        i0 = max(0, int((corners[:, 0].min() - raster.x0) / cell))
        i1 = min(raster.nx - 1, int((corners[:, 0].max() - raster.x0) / cell))
        j0 = max(0, int((corners[:, 1].min() - raster.y0) / cell))
        j1 = min(raster.ny - 1, int((corners[:, 1].max() - raster.y0) / cell))
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                x0, y0 = raster.x0 + i * cell, raster.y0 + j * cell
                middle = (x0 + 0.5 * cell) * nx + (y0 + 0.5 * cell) * ny
                half = 0.5 * cell * (abs(nx) + abs(ny)) + _TOLERANCE
                if middle + half < away.min() or middle - half > away.max():
                    continue
                if not _matters(raster, starts, floors, (j, i, reach), low, high):
                    continue
                shape[:3] = corners
                n = _cut(shape, 3, 0, x0, -1.0)
                n = _cut(shape, n, 0, x0 + cell, 1.0) if n else 0
                n = _cut(shape, n, 1, y0, -1.0) if n else 0
                n = _cut(shape, n, 1, y0 + cell, 1.0) if n else 0
                if n < 3:
                    continue
                piece = shape[:n]
                along = piece[:, 1] * nx - piece[:, 0] * ny
                a, b = along.min(), along.max()
                z0, z1 = piece[:, 2].min(), piece[:, 2].max()
                if b - a < 1e-4 or not _matters(raster, starts, floors, (j, i, reach), z0, z1):
                    continue
                m = 0.5 * ((piece[:, 0] * nx + piece[:, 1] * ny).min())
                m += 0.5 * ((piece[:, 0] * nx + piece[:, 1] * ny).max())
                if count < len(out):
                    face = out[count]
                    face["x0"] = m * nx - a * ny
                    face["y0"] = m * ny + a * nx
                    face["x1"] = m * nx - b * ny
                    face["y1"] = m * ny + b * nx
                    face["bottom_m"] = z0
                    face["top_m"] = z1
                    face["column"] = j * raster.nx + i
                count += 1
    return count


@kernel
def join_faces(starts: NDArray[np.int64], faces: NDArray[np.void], kept: NDArray[np.bool_]) -> None:
    """Join faces of one wall in one column, which lie on one line and touch above one another.

    `faces` (R,) of `FACE` are listed by column (CSR) and joined in place; `kept` (R,) receives
    which of them remain.
    """
    for column in range(len(starts) - 1):
        for a in range(starts[column], starts[column + 1]):
            kept[a] = True
            for b in range(starts[column], a):
                if kept[b] and _same_line(faces[a], faces[b]):
                    faces[a]["bottom_m"] = min(faces[a]["bottom_m"], faces[b]["bottom_m"])
                    faces[a]["top_m"] = max(faces[a]["top_m"], faces[b]["top_m"])
                    kept[b] = False


@kernel
def _same_line(a: np.void, b: np.void) -> bool:
    """Whether two faces lie on one line, in either direction, and touch in height."""
    near = 1e-3
    straight = (
        abs(a["x0"] - b["x0"]) + abs(a["y0"] - b["y0"]) < near
        and abs(a["x1"] - b["x1"]) + abs(a["y1"] - b["y1"]) < near
    ) or (
        abs(a["x0"] - b["x1"]) + abs(a["y0"] - b["y1"]) < near
        and abs(a["x1"] - b["x0"]) + abs(a["y1"] - b["y0"]) < near
    )
    return bool(
        straight
        and a["bottom_m"] < b["top_m"] + _TOGETHER_M
        and b["bottom_m"] < a["top_m"] + _TOGETHER_M
    )


@kernel
def grow_regions(
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    floors: NDArray[np.float32],
    links: NDArray[np.int32],
    order: NDArray[np.int64],
    layers: NDArray[np.int16],
) -> int:
    """Group S surfaces into `layers` (S,); returns the number of layers.

    From the lowest surface on, a region grows along links, its lowest surface first, wherever it
    does not lie above or below itself. It goes to the first layer that has nothing above or below
    it. `order` (S,) are the surfaces by height.
    """
    count = 0
    layers[:] = -1
    if len(floors) == 0:
        return 0
    base = floors[order[0]]
    buckets = int((floors[order[-1]] - base) / _BUCKET_M) + 1
    heads = np.full(buckets, -1, dtype=np.int32)
    following = np.empty(len(floors), dtype=np.int32)
    waiting = np.zeros(len(floors), dtype=np.bool_)
    taken = np.zeros(len(starts) - 1, dtype=np.bool_)
    region = np.empty(len(floors), dtype=np.int32)
    for seed in order:
        if layers[seed] >= 0:
            continue
        size = 0
        bucket = int((floors[seed] - base) / _BUCKET_M)
        heads[bucket] = seed
        following[seed] = -1
        waiting[seed] = True
        while bucket < buckets:
            s = heads[bucket]
            if s < 0:
                bucket += 1
                continue
            heads[bucket] = following[s]
            waiting[s] = False
            if taken[columns[s]]:
                continue
            taken[columns[s]] = True
            region[size] = s
            size += 1
            for d in range(8):
                t = links[s, d]
                if t >= 0 and layers[t] < 0 and not waiting[t] and not taken[columns[t]]:
                    k = int((floors[t] - base) / _BUCKET_M)
                    following[t] = heads[k]
                    heads[k] = t
                    waiting[t] = True
                    bucket = min(bucket, k)
        free = np.ones(count + 1, dtype=np.bool_)
        for k in range(size):
            c = columns[region[k]]
            taken[c] = False
            for s in range(starts[c], starts[c + 1]):
                if layers[s] >= 0:
                    free[layers[s]] = False
        layer = 0
        while not free[layer]:
            layer += 1
        for k in range(size):
            layers[region[k]] = layer
        count = max(count, layer + 1)
    return count
