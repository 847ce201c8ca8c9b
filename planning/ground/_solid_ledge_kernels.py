"""Ledges of solids on bare arrays: where the exact outlines of floors, steps and ramps drop.

A ledge follows from the outlines alone, so that it lies where the building has it, wherever cells
lie. An edge of an outline is cut where the outline of another solid meets it; then each piece has
the same neighbours from end to end.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._ledge_kernels import (
    LEAST_STEP_M,
    PIECE_RISE_M,
    ledge_heights,
    write_barrier,
)
from esplanade.planning.ground._surface_kernels import LEAST_HEADROOM_M, SolidArrays, top_at
from esplanade.planning.ground.layered import LINK_M

_SAME_M = 1e-4
"""Heights and lengths that differ by less are equal."""
_BESIDE_M = 1e-3
"""The ground beside an edge is looked up this far from it."""


class SolidBuckets(NamedTuple):
    """The solids of a scene, listed by the square buckets that their boxes meet (CSR)."""

    starts: NDArray[np.int64]
    members: NDArray[np.int64]
    x0: float
    y0: float
    bucket_m: float
    nx: int
    ny: int


@kernel
def list_solids(
    solids: SolidArrays,
    place: tuple[float, float, float, int, int],
    starts: NDArray[np.int64],
    members: NDArray[np.int64],
) -> None:
    """List the solids that meet each bucket; `place` is x0, y0, edge of a bucket, columns, rows.

    If `members` is empty, solids are only counted, into starts[1:].
    """
    nx, ny = place[3], place[4]
    count = np.zeros(nx * ny, dtype=np.int64)
    for k in range(len(solids.bottoms)):
        ring = solids.points[solids.starts[k] : solids.starts[k + 1]]
        i0, j0 = bucket_at(place, ring[:, 0].min() - 0.01, ring[:, 1].min() - 0.01)
        i1, j1 = bucket_at(place, ring[:, 0].max() + 0.01, ring[:, 1].max() + 0.01)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                b = j * nx + i
                if len(members):
                    members[starts[b] + count[b]] = k
                else:
                    starts[b + 1] += 1
                count[b] += 1


@kernel
def bucket_at(place: tuple[float, float, float, int, int], x: float, y: float) -> tuple[int, int]:
    """Column and row of the bucket of a point; of the nearest one outside of all."""
    x0, y0, bucket_m, nx, ny = place
    i = min(nx - 1, max(0, int(np.floor((x - x0) / bucket_m))))
    j = min(ny - 1, max(0, int(np.floor((y - y0) / bucket_m))))
    return i, j


@inlined
def _contains(solids: SolidArrays, k: int, x: float, y: float) -> bool:
    """Whether a point lies in the outline of a solid."""
    inside = False
    first, last = solids.starts[k], solids.starts[k + 1]
    b = last - 1
    for a in range(first, last):
        ay, by = solids.points[a, 1], solids.points[b, 1]
        if (ay > y) != (by > y):
            ax, bx = solids.points[a, 0], solids.points[b, 0]
            if x < ax + (y - ay) * (bx - ax) / (by - ay):
                inside = not inside
        b = a
    return inside


@inlined
def _turn(solids: SolidArrays, k: int) -> float:
    """1 for an outline that goes around against the clock, else -1."""
    first, last = solids.starts[k], solids.starts[k + 1]
    area = 0.0
    b = last - 1
    for a in range(first, last):
        area += solids.points[b, 0] * solids.points[a, 1]
        area -= solids.points[a, 0] * solids.points[b, 1]
        b = a
    return 1.0 if area > 0.0 else -1.0


@inlined
def _drop(solids: SolidArrays, buckets: SolidBuckets, own: float, x: float, y: float) -> float:
    """Height of a drop from a floor to what lies beside it at a point; 0 where there is none.

    There is none to a floor as high, or higher, nor where a solid stands beside the floor.
    """
    place = (buckets.x0, buckets.y0, buckets.bucket_m, buckets.nx, buckets.ny)
    i, j = bucket_at(place, x, y)
    b = j * buckets.nx + i
    below = 0.0
    for e in range(buckets.starts[b], buckets.starts[b + 1]):
        m = buckets.members[e]
        if solids.bottoms[m] >= own + LEAST_HEADROOM_M:
            continue
        top = top_at(solids, m, x, y)
        if top <= below or not _contains(solids, m, x, y):
            continue
        if top > own - LEAST_STEP_M:
            return 0.0
        if solids.standable[m]:
            below = top
    return own - below


@inlined
def _ceiling(solids: SolidArrays, buckets: SolidBuckets, own: float, x: float, y: float) -> float:
    """Height of the ceiling over a floor at a point."""
    place = (buckets.x0, buckets.y0, buckets.bucket_m, buckets.nx, buckets.ny)
    i, j = bucket_at(place, x, y)
    b = j * buckets.nx + i
    ceiling = np.inf
    for e in range(buckets.starts[b], buckets.starts[b + 1]):
        m = buckets.members[e]
        above = top_at(solids, m, x, y) > own + _SAME_M
        if above and solids.bottoms[m] < ceiling and _contains(solids, m, x, y):
            ceiling = solids.bottoms[m]
    return ceiling


@kernel
def _cuts(
    solids: SolidArrays,
    buckets: SolidBuckets,
    k: int,
    edge: tuple[float, float, float, float],
    seen: NDArray[np.int64],
    stamp: int,
) -> NDArray[np.float64]:
    """Shares of an edge of a solid at which outlines of other solids meet it, in order, 0 to 1."""
    ax, ay, bx, by = edge
    ux, uy = bx - ax, by - ay
    length2 = ux * ux + uy * uy
    cuts = np.empty(16)
    cuts[0], cuts[1] = 0.0, 1.0
    count = 2
    place = (buckets.x0, buckets.y0, buckets.bucket_m, buckets.nx, buckets.ny)
    i0, j0 = bucket_at(place, min(ax, bx) - 0.01, min(ay, by) - 0.01)
    i1, j1 = bucket_at(place, max(ax, bx) + 0.01, max(ay, by) + 0.01)
    for j in range(j0, j1 + 1):
        for i in range(i0, i1 + 1):
            bucket = j * buckets.nx + i
            for e in range(buckets.starts[bucket], buckets.starts[bucket + 1]):
                m = buckets.members[e]
                if m == k or seen[m] == stamp:
                    continue
                seen[m] = stamp
                first, last = solids.starts[m], solids.starts[m + 1]
                q = last - 1
                for p in range(first, last):
                    if count + 3 > len(cuts):
                        cuts = np.concatenate((cuts, np.empty_like(cuts)))
                    px, py = solids.points[p] - np.array((ax, ay))
                    qx, qy = solids.points[q] - np.array((ax, ay))
                    q = p
                    side_p, side_q = ux * py - uy * px, ux * qy - uy * qx
                    slack = _BESIDE_M * np.sqrt(length2)
                    if abs(side_p) <= slack:
                        cuts[count] = (px * ux + py * uy) / length2
                        count += 1
                    if (side_p > slack and side_q < -slack) or (side_p < -slack and side_q > slack):
                        u = side_p / (side_p - side_q)
                        x, y = px + u * (qx - px), py + u * (qy - py)
                        cuts[count] = (x * ux + y * uy) / length2
                        count += 1
    return np.sort(np.minimum(1.0, np.maximum(0.0, cuts[:count])))


@kernel
def ledges_of_solids(
    solids: SolidArrays,
    buckets: SolidBuckets,
    bounds: tuple[float, float, float, float],
    out: NDArray[np.void],
) -> int:
    """Write the ledges along the outlines of solids that carry somebody into `out`, of `BARRIER`.

    Returns the number of ledges; those beyond the room in `out` are not written.
    """
    count = 0
    seen = np.full(len(solids.bottoms), -1, dtype=np.int64)
    for k in range(len(solids.bottoms)):
        if not solids.standable[k]:
            continue
        turn = _turn(solids, k)
        first, last = solids.starts[k], solids.starts[k + 1]
        for a in range(first, last):
            b = a + 1 if a + 1 < last else first
            ax, ay = solids.points[a]
            bx, by = solids.points[b]
            length = np.hypot(bx - ax, by - ay)
            if length < _SAME_M:
                continue
            nx, ny = turn * (by - ay) / length * _BESIDE_M, -turn * (bx - ax) / length * _BESIDE_M
            cuts = _cuts(solids, buckets, k, (ax, ay, bx, by), seen, a)
            for cut in range(len(cuts) - 1):
                u, v = cuts[cut], cuts[cut + 1]
                if (v - u) * length < _SAME_M:
                    continue
                low = top_at(solids, k, ax + u * (bx - ax), ay + u * (by - ay))
                high = top_at(solids, k, ax + v * (bx - ax), ay + v * (by - ay))
                pieces = max(1, int(np.ceil(abs(high - low) / PIECE_RISE_M - 1e-9)))
                for piece in range(pieces):
                    s = u + (v - u) * piece / pieces
                    t = u + (v - u) * (piece + 1) / pieces
                    line = (
                        ax + s * (bx - ax),
                        ay + s * (by - ay),
                        ax + t * (bx - ax),
                        ay + t * (by - ay),
                    )
                    mx, my = 0.5 * (line[0] + line[2]), 0.5 * (line[1] + line[3])
                    ox, oy = mx + nx, my + ny
                    if not (bounds[0] < ox < bounds[2] and bounds[1] < oy < bounds[3]):
                        continue
                    own = top_at(solids, k, mx, my)
                    drop = _drop(solids, buckets, own, ox, oy)
                    if drop < LEAST_STEP_M:
                        continue
                    ceiling = _ceiling(solids, buckets, own, mx - nx, my - ny)
                    if ceiling < own + LEAST_HEADROOM_M:
                        continue
                    climb = drop if drop <= LINK_M else np.inf
                    if count < len(out):
                        write_barrier(out[count], line, ledge_heights(own, ceiling, climb))
                    count += 1
    return count
