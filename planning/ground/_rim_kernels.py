"""Ledges of meshes on bare arrays: where the exact edges of triangles that carry drop.

A rim is an edge of such a triangle that no other one shares. It is cut where the rims of others
meet it; then each piece has the same neighbours from end to end. Floors are drawn room by room,
with slits under walls, and risers lean: so what lies beyond a rim is looked up at several
distances.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._ledge_kernels import (
    LEAST_STEP_M,
    PIECE_RISE_M,
    append_barrier,
    ledge_heights,
)
from esplanade.planning.ground._solid_ledge_kernels import bucket_at
from esplanade.planning.ground._surface_kernels import LEAST_HEADROOM_M, Raster
from esplanade.planning.ground._triangle_kernels import (
    Column,
    TriangleBuckets,
    new_column,
    surfaces_at,
)
from esplanade.planning.ground.layered import LINK_M

SLIT_M = 0.45
"""Everybody steps across a slit between level floors that is no wider than this."""
_STEP_ACROSS_M = 0.25
"""A step to another height leads no further than this across nothing."""
_NARROW_M = 0.1
"""A trench no wider than this between level floors is none."""
_BESIDE_M = 1e-3
_OWN_M = 0.05
"""A surface this near in height to a rim is the one that the rim bounds."""
_CHUNK_M = 1.0
"""Long rims are treated in pieces of this length."""
_LEAST_M = 0.25
"""Pieces shorter than this are not divided further."""
_FLOOR_NEAR_M = 0.6
"""A rim without a cell's floor this near in height concerns nobody."""
_NONE = -1.0

_LOOKS_M = np.array([1e-3, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45])
"""Distances from a rim at which surfaces beyond it are looked up."""


@kernel
def _drop(
    buckets: TriangleBuckets,
    own: float,
    x: float,
    y: float,
    nx: float,
    ny: float,
    column: Column,
) -> float:
    """Height of a drop beyond a rim at (x, y); `_NONE` where there is none, inf where it is deep.

    (nx, ny) leads away from the rim.
    """
    drop = np.inf
    reach = SLIT_M
    for look in _LOOKS_M:
        if look > reach + 1e-9:
            break
        count = surfaces_at(buckets, x + look * nx, y + look * ny, column)
        lower = -np.inf
        higher = False
        for s in range(count):
            step = column.floors[s] - own
            if abs(step) < LEAST_STEP_M:
                return _NONE
            if LEAST_STEP_M <= step <= LINK_M:
                higher = True
            elif -LINK_M <= step < 0.0:
                lower = step
        if drop < np.inf or look > _STEP_ACROSS_M + 1e-9:
            continue
        if higher:
            return _NONE
        if lower > -np.inf:
            if -lower <= 1.001 * look:
                return _NONE
            drop = -lower
            if look <= _BESIDE_M:
                reach = _NARROW_M
    return drop


@kernel
def _near_rim(
    buckets: TriangleBuckets,
    line: tuple[float, float, float, float],
    normal: tuple[float, float],
    heights: tuple[float, float],
    seen: NDArray[np.int32],
    stamp: int,
    near: NDArray[np.int32],
) -> int:
    """List the triangles with rims beside a line that matter between two heights; their number.

    If there is not enough room in `near`, the result is its length plus one.
    """
    px, py, qx, qy = line
    ox, oy = SLIT_M * normal[0], SLIT_M * normal[1]
    x0, x1 = min(px, qx, px + ox, qx + ox) - 2e-3, max(px, qx, px + ox, qx + ox) + 2e-3
    y0, y1 = min(py, qy, py + oy, qy + oy) - 2e-3, max(py, qy, py + oy, qy + oy) + 2e-3
    place = (buckets.x0, buckets.y0, buckets.bucket_m, buckets.nx, buckets.ny)
    i0, j0 = bucket_at(place, x0, y0)
    i1, j1 = bucket_at(place, x1, y1)
    count = 0
    for j in range(j0, j1 + 1):
        for i in range(i0, i1 + 1):
            bucket = j * buckets.nx + i
            for e in range(buckets.starts[bucket], buckets.starts[bucket + 1]):
                t = buckets.members[e]
                if buckets.rims[t] == 0 or seen[t] == stamp:
                    continue
                seen[t] = stamp
                ax, ay, az = buckets.triangles[t, 0]
                bx, by, bz = buckets.triangles[t, 1]
                cx, cy, cz = buckets.triangles[t, 2]
                if (
                    max(az, bz, cz) < heights[0]
                    or min(az, bz, cz) > heights[1]
                    or max(ax, bx, cx) < x0
                    or min(ax, bx, cx) > x1
                    or max(ay, by, cy) < y0
                    or min(ay, by, cy) > y1
                ):
                    continue
                if count == len(near):
                    return count + 1
                near[count] = t
                count += 1
    return count


@kernel
def _cuts(
    buckets: TriangleBuckets,
    near: NDArray[np.int32],
    own: int,
    line: tuple[float, float, float, float],
    heights: tuple[float, float],
    normal: tuple[float, float],
) -> NDArray[np.float64]:
    """Shares of a line at which rims of other triangles meet it or end beyond it, from 0 to 1.

    `heights` are the lowest and highest that matter.
    """
    ax, ay, bx, by = line
    nx, ny = normal
    length = np.hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / length, (by - ay) / length
    cuts = np.empty(16)
    cuts[0], cuts[1] = 0.0, length
    count = 2
    for t in near:
        if t == own:
            continue
        for k in range(3):
            if not (buckets.rims[t] >> k) & 1:
                continue
            px, py, pz = buckets.triangles[t, k]
            qx, qy, qz = buckets.triangles[t, (k + 1) % 3]
            if max(pz, qz) < heights[0] or min(pz, qz) > heights[1]:
                continue
            px -= ax
            py -= ay
            qx -= ax
            qy -= ay
            out_p, out_q = px * nx + py * ny, qx * nx + qy * ny
            along_p, along_q = px * ux + py * uy, qx * ux + qy * uy
            if count + 3 > len(cuts):
                cuts = np.concatenate((cuts, np.empty_like(cuts)))
            if -2.0 * _BESIDE_M < out_p < SLIT_M and 0.0 < along_p < length:
                cuts[count] = along_p
                count += 1
            if -2.0 * _BESIDE_M < out_q < SLIT_M and 0.0 < along_q < length:
                cuts[count] = along_q
                count += 1
            if (out_p < 0.0) != (out_q < 0.0) and abs(out_p - out_q) > _BESIDE_M:
                along = along_p + out_p / (out_p - out_q) * (along_q - along_p)
                if 0.0 < along < length:
                    cuts[count] = along
                    count += 1
    cuts = np.sort(cuts[:count])
    kept = 1
    for k in range(1, count):
        if cuts[k] - cuts[kept - 1] >= 2.0 * _BESIDE_M:
            cuts[kept] = cuts[k]
            kept += 1
    cuts[kept - 1 if kept > 1 else 1] = length
    shares: NDArray[np.float64] = cuts[: max(2, kept)] / length
    return shares


@inlined
def _has_floor_near(
    raster: Raster,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    x: float,
    y: float,
    z: float,
) -> bool:
    """Whether a cell within two cells of a point has a floor near a height."""
    i = int(np.floor((x - raster.x0) / raster.cell_m))
    j = int(np.floor((y - raster.y0) / raster.cell_m))
    for jj in range(max(0, j - 2), min(raster.ny, j + 3)):
        first = starts[jj * raster.nx + min(raster.nx - 1, max(0, i - 2))]
        last = starts[jj * raster.nx + min(raster.nx - 1, max(0, i + 2)) + 1]
        for s in range(first, last):
            if abs(floors[s] - z) < _FLOOR_NEAR_M:
                return True
    return False


@kernel
def _bounded(
    buckets: TriangleBuckets,
    x: float,
    y: float,
    z: float,
    normal: tuple[float, float],
    column: Column,
) -> tuple[float, float]:
    """Drop beyond a rim at (x, y, z), and the ceiling over the surface that it bounds.

    The drop is `_NONE` where nobody can stand beside the rim.
    """
    nx, ny = normal
    for s in range(surfaces_at(buckets, x - _BESIDE_M * nx, y - _BESIDE_M * ny, column)):
        if abs(column.floors[s] - z) < _OWN_M:
            ceiling = float(column.ceilings[s])
            return _drop(buckets, z, x, y, nx, ny, column), ceiling
    return _NONE, np.inf


@kernel
def _add_ledges(
    buckets: TriangleBuckets,
    line: tuple[float, float, float, float],
    heights: tuple[float, float],
    normal: tuple[float, float],
    column: Column,
    stack: NDArray[np.float64],
    out: NDArray[np.void],
    count: int,
) -> int:
    """Append the ledges of a piece of a rim; returns the new number of barriers.

    `heights` are those of its ends. A long piece is halved until what lies beyond it is the same
    throughout.
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
        drop, ceiling = _bounded(buckets, x, y, z, normal, column)
        divided = abs(bz - az) * (v - u) > PIECE_RISE_M
        if (v - u) * length > _LEAST_M and not divided:
            for share in (u + 0.1 * (v - u), v - 0.1 * (v - u)):
                x, y = ax + share * (bx - ax), ay + share * (by - ay)
                height = az + share * (bz - az)
                other = _bounded(buckets, x, y, height, normal, column)[0]
                if other != drop and (min(other, drop) < 0.0 or abs(other - drop) > PIECE_RISE_M):
                    divided = True
                    break
        if divided and size + 2 <= len(stack):
            stack[size, 0], stack[size, 1] = m, v
            stack[size + 1, 0], stack[size + 1, 1] = u, m
            size += 2
        elif drop != _NONE:
            piece = (ax + u * (bx - ax), ay + u * (by - ay), ax + v * (bx - ax), ay + v * (by - ay))
            count = append_barrier(out, count, piece, ledge_heights(z, ceiling, drop))
    return count


@kernel
def ledges_of_rims(
    buckets: TriangleBuckets,
    raster: Raster,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    out: NDArray[np.void],
) -> int:
    """Write the ledges along the rims of triangles that carry into `out`, (S,) of `BARRIER`.

    `starts` and `floors` are the surfaces by column (CSR). Returns the number of ledges; those
    beyond the room in `out` are not written.
    """
    count = 0
    seen = np.full(len(buckets.kinds), -1, dtype=np.int32)
    near = np.empty(256, dtype=np.int32)
    column = new_column()
    stack = np.empty((32, 2))
    whole = np.array([0.0, 1.0])
    stamp = 0
    x1, y1 = raster.x0 + raster.nx * raster.cell_m, raster.y0 + raster.ny * raster.cell_m
    for t in range(len(buckets.kinds)):
        if buckets.rims[t] == 0:
            continue
        for k in range(3):
            if not (buckets.rims[t] >> k) & 1:
                continue
            ax, ay, az = buckets.triangles[t, k]
            bx, by, bz = buckets.triangles[t, (k + 1) % 3]
            length = np.hypot(bx - ax, by - ay)
            if length < _BESIDE_M:
                continue
            normal = (by - ay) / length, -(bx - ax) / length
            chunks = int(np.ceil(length / _CHUNK_M))
            for chunk in range(chunks):
                u, v = chunk / chunks, (chunk + 1) / chunks
                px, py, pz = ax + u * (bx - ax), ay + u * (by - ay), az + u * (bz - az)
                qx, qy, qz = ax + v * (bx - ax), ay + v * (by - ay), az + v * (bz - az)
                mx, my = 0.5 * (px + qx), 0.5 * (py + qy)
                ox, oy = mx + _BESIDE_M * normal[0], my + _BESIDE_M * normal[1]
                if not (raster.x0 < ox < x1 and raster.y0 < oy < y1):
                    continue
                if not _has_floor_near(raster, starts, floors, mx, my, 0.5 * (pz + qz)):
                    continue
                cuts = whole
                if length > _LEAST_M and not (buckets.rims[t] >> k) & 8:
                    line = (px, py, qx, qy)
                    matters = (min(pz, qz) - LINK_M - 0.1, max(pz, qz) + LEAST_HEADROOM_M)
                    while True:
                        stamp += 1
                        found = _near_rim(buckets, line, normal, matters, seen, stamp, near)
                        if found <= len(near):
                            break
                        near = np.empty(2 * len(near), dtype=np.int32)
                    cuts = _cuts(buckets, near[:found], t, line, matters, normal)
                for cut in range(len(cuts) - 1):
                    s, e = cuts[cut], cuts[cut + 1]
                    piece = (
                        px + s * (qx - px),
                        py + s * (qy - py),
                        px + e * (qx - px),
                        py + e * (qy - py),
                    )
                    ends = (pz + s * (qz - pz), pz + e * (qz - pz))
                    count = _add_ledges(buckets, piece, ends, normal, column, stack, out, count)
    return count
