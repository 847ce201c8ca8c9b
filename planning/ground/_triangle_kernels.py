"""Triangles of a mesh on bare arrays: edges that no two of them share, and what lies at a point.

What lies at a point is found exactly as for the centre of a cell, so that floors of cells and
ledges agree.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._mesh_kernels import DOWN, STEEP, STEEPEST, UP, surfaces_of_hits
from esplanade.planning.ground._solid_ledge_kernels import bucket_at

SIDEWAYS = 3
"""Kind of a triangle that is upright: no vertical meets it."""
_EQUAL_M = 1e-3
"""Corners closer together than this are one."""
_MOST_HITS = 128
"""Greatest number of triangles above one another that are looked at."""


class TriangleBuckets(NamedTuple):
    """Triangles of a mesh, listed by the square buckets that they meet on the plan (CSR)."""

    triangles: NDArray[np.float64]
    """(T, 3, 3), metres."""
    kinds: NDArray[np.uint8]
    """(T,): `DOWN`, `UP`, `STEEP` or `SIDEWAYS`."""
    rims: NDArray[np.uint8]
    """(T,): the edges of a triangle that carries that no other such triangle shares; bit k stands
    for the edge from corner k, bit k + 3 tells that a triangle that is too steep goes on there."""
    starts: NDArray[np.int64]
    members: NDArray[np.int32]
    x0: float
    y0: float
    bucket_m: float
    nx: int
    ny: int


class Column(NamedTuple):
    """Room for the surfaces at one point."""

    heights: NDArray[np.float32]
    kinds: NDArray[np.uint8]
    floors: NDArray[np.float32]
    ceilings: NDArray[np.float32]
    starts: NDArray[np.int64]
    tops: NDArray[np.int32]


@kernel
def new_column() -> Column:
    """Room for the surfaces at one point."""
    return Column(
        np.empty(_MOST_HITS, dtype=np.float32),
        np.empty(_MOST_HITS, dtype=np.uint8),
        np.empty(_MOST_HITS, dtype=np.float32),
        np.empty(_MOST_HITS, dtype=np.float32),
        np.zeros(2, dtype=np.int64),
        np.zeros(2, dtype=np.int32),
    )


@kernel
def kinds_of(triangles: NDArray[np.float64], kinds: NDArray[np.uint8]) -> None:
    """Write the kind of each triangle (T, 3, 3)."""
    for t in range(len(triangles)):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangles[t]
        ux, uy, uz = bx - ax, by - ay, bz - az
        vx, vy, vz = cx - ax, cy - ay, cz - az
        up = ux * vy - uy * vx
        area = np.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + up * up)
        if abs(up) < 1e-12:
            kinds[t] = SIDEWAYS
        elif up < 0.0:
            kinds[t] = DOWN
        else:
            kinds[t] = UP if up >= STEEPEST * area else STEEP


@inlined
def corner_hash(x: float, y: float, z: float) -> int:
    """A number for a corner, the same for corners that round to the same millimetre."""
    h = np.int64(np.floor(x / _EQUAL_M + 0.5)) * np.int64(73856093)
    h = (h ^ (h >> np.int64(29))) + np.int64(np.floor(y / _EQUAL_M + 0.5)) * np.int64(
        1181783497276652981
    )
    h = (h ^ (h >> np.int64(31))) + np.int64(np.floor(z / _EQUAL_M + 0.5)) * np.int64(
        4768777513237032717
    )
    return int(h ^ (h >> np.int64(30)))


@inlined
def edge_key(one: int, two: int) -> int:
    """A number for the edge from one corner to another; its reverse has another one."""
    h = one * np.int64(5871781006564002453) + two * np.int64(2862933555777941757)
    h ^= h >> np.int64(28)
    return int(h) if h != 0 else 1


@kernel
def find_rims(
    triangles: NDArray[np.float64], kinds: NDArray[np.uint8], rims: NDArray[np.uint8]
) -> None:
    """Write `TriangleBuckets.rims` of triangles (T, 3, 3)."""
    count = 0
    for t in range(len(triangles)):
        rims[t] = 0
        count += kinds[t] == UP or kinds[t] == STEEP
    size = 16
    while size < 6 * count:
        size *= 2
    table = np.zeros(size, dtype=np.int64)
    steep = np.zeros(size, dtype=np.bool_)
    for search in (False, True):
        for t in range(len(triangles)):
            if not (kinds[t] == UP or (kinds[t] == STEEP and not search)):
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
                if search:
                    if table[at] == 0:
                        rims[t] |= 1 << k
                    elif steep[at]:
                        rims[t] |= 9 << k
                elif kinds[t] == UP or table[at] == 0:
                    table[at] = key
                    steep[at] = kinds[t] == STEEP


@inlined
def _meets(triangle: NDArray[np.float64], x: float, y: float, half: float) -> bool:
    """Whether a triangle may meet the square around (x, y) on the plan, as its sides tell."""
    area = (triangle[1, 0] - triangle[0, 0]) * (triangle[2, 1] - triangle[0, 1]) - (
        triangle[1, 1] - triangle[0, 1]
    ) * (triangle[2, 0] - triangle[0, 0])
    sign = 1.0 if area > 0.0 else -1.0
    for k in range(3):
        ax, ay = triangle[k, 0], triangle[k, 1]
        ux, uy = triangle[(k + 1) % 3, 0] - ax, triangle[(k + 1) % 3, 1] - ay
        side = sign * (ux * (y - ay) - uy * (x - ax))
        if side < -half * (abs(ux) + abs(uy)):
            return False
    return True


@kernel
def list_triangles(
    triangles: NDArray[np.float64],
    kinds: NDArray[np.uint8],
    place: tuple[float, float, float, int, int],
    starts: NDArray[np.int64],
    members: NDArray[np.int32],
) -> None:
    """List the triangles that meet each bucket; `place` is x0, y0, edge of a bucket, columns, rows.

    If `members` is empty, triangles are only counted, into starts[1:].
    """
    x0, y0, bucket_m, nx, ny = place
    fill = len(members) > 0
    count = np.zeros(nx * ny, dtype=np.int64)
    half = 0.5 * bucket_m + 2e-3
    for t in range(len(triangles)):
        if kinds[t] == SIDEWAYS:
            continue
        (ax, ay, _az), (bx, by, _bz), (cx, cy, _cz) = triangles[t]
        i0, j0 = bucket_at(place, min(ax, bx, cx) - 2e-3, min(ay, by, cy) - 2e-3)
        i1, j1 = bucket_at(place, max(ax, bx, cx) + 2e-3, max(ay, by, cy) + 2e-3)
        few = (i1 - i0) * (j1 - j0) == 0
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                if not few and not _meets(
                    triangles[t], x0 + (i + 0.5) * bucket_m, y0 + (j + 0.5) * bucket_m, half
                ):
                    continue
                b = j * nx + i
                if fill:
                    members[starts[b] + count[b]] = t
                else:
                    starts[b + 1] += 1
                count[b] += 1


@inlined
def surfaces_at(buckets: TriangleBuckets, x: float, y: float, column: Column) -> int:
    """Find the standing surfaces at a point, and write them into `column`; returns their number."""
    place = (buckets.x0, buckets.y0, buckets.bucket_m, buckets.nx, buckets.ny)
    i, j = bucket_at(place, x, y)
    bucket = j * buckets.nx + i
    hits = 0
    for e in range(buckets.starts[bucket], buckets.starts[bucket + 1]):
        t = buckets.members[e]
        corners = buckets.triangles[t]
        ax, ay = corners[0, 0], corners[0, 1]
        ux, uy = corners[1, 0] - ax, corners[1, 1] - ay
        vx, vy = corners[2, 0] - ax, corners[2, 1] - ay
        up = ux * vy - uy * vx
        px, py = x - ax, y - ay
        b = px * vy - py * vx
        c = ux * py - uy * px
        sign = 1.0 if up > 0.0 else -1.0
        least = -1e-9 * abs(up)  # nothing is divided for the many that the vertical passes by
        if (
            sign * b < least
            or sign * c < least
            or sign * (up - b - c) < least
            or hits == _MOST_HITS
        ):
            continue
        az, bz, cz = corners[0, 2], corners[1, 2], corners[2, 2]
        b /= up
        c /= up
        column.heights[hits] = az + b * (bz - az) + c * (cz - az)
        column.kinds[hits] = buckets.kinds[t]
        hits += 1
    if hits == 0:
        return 0
    column.starts[1] = hits
    return surfaces_of_hits(
        column.starts, column.heights, column.kinds, column.floors, column.ceilings, column.tops
    )
