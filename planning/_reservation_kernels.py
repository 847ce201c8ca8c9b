"""Certain obstacles: the planned ways of other actors, looked up in CT-space."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._geometry_kernels import closest_approach
from planning._jit import inlined, kernel

MARGIN_M = 0.03
"""Planned ways keep this much more than the sum of the radii."""


class Reservations(NamedTuple):
    """Everyone's planned way and an index of it by bucket, slice by slice.

    `paths` (A, K, 2) m; `layers` (A,); `radii` (A,) m; `ranks` (A,), smaller goes first;
    `starts` (K, buckets + 1) and `members` (K, A) list the actors of a bucket.
    """

    paths: NDArray[np.float64]
    layers: NDArray[np.int64]
    radii: NDArray[np.float64]
    ranks: NDArray[np.int64]
    starts: NDArray[np.int64]
    members: NDArray[np.int64]
    x0: float
    y0: float
    bucket_m: float
    nx: int
    ny: int


@kernel
def index_paths(reservations: Reservations) -> None:
    """Fill `starts` and `members` from `paths` (a counting sort for every slice)."""
    r = reservations
    actors, slices, _ = r.paths.shape
    bucket = np.empty(actors, dtype=np.int64)
    for k in range(slices):
        r.starts[k] = 0
        for a in range(actors):
            i = min(r.nx - 1, max(0, int((r.paths[a, k, 0] - r.x0) / r.bucket_m)))
            j = min(r.ny - 1, max(0, int((r.paths[a, k, 1] - r.y0) / r.bucket_m)))
            bucket[a] = j * r.nx + i
            r.starts[k, bucket[a] + 1] += 1
        for b in range(r.nx * r.ny):
            r.starts[k, b + 1] += r.starts[k, b]
        for a in range(actors - 1, -1, -1):
            r.starts[k, bucket[a] + 1] -= 1
            r.members[k, r.starts[k, bucket[a] + 1]] = a
        for b in range(r.nx * r.ny):
            r.starts[k, b] = r.starts[k, b + 1]
        r.starts[k, r.nx * r.ny] = actors


@inlined
def conflict(
    reservations: Reservations,
    me: int,
    layer: int,
    k: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> tuple[bool, float]:
    """Meetings while moving from a at slice k to b at slice k + 1.

    The first value tells of one with an actor of smaller rank: that is forbidden, unless they
    are too close already and draw apart. The second counts those with actors of larger rank, who
    will yield; they are dear, not forbidden. Swapping places is a meeting.
    """
    r = reservations
    ci = int((bx - r.x0) / r.bucket_m)
    cj = int((by - r.y0) / r.bucket_m)
    soft = 0.0
    i0 = min(r.nx - 1, max(0, ci - 1))
    i1 = min(r.nx - 1, max(0, ci + 1))
    for j in range(max(0, cj - 1), min(r.ny, cj + 2)):
        row = j * r.nx  # buckets of a row are listed one after the other
        for m in range(r.starts[k + 1, row + i0], r.starts[k + 1, row + i1 + 1]):
            other = r.members[k + 1, m]
            if other == me or r.layers[other] != layer:
                continue
            if not _meets(r, me, other, k, ax, ay, bx, by):
                continue
            if r.ranks[other] < r.ranks[me]:
                return True, 1.0
            soft += 1.0
    return False, soft


@inlined
def others_near(
    reservations: Reservations,
    me: int,
    layer: int,
    k: int,
    x: float,
    y: float,
    slice_m: float,
    others: NDArray[np.int64],
) -> int:
    """List whom one may meet who leaves (x, y) at slice k, within two slices; how many they are.

    `slice_m` is how far one gets in a slice. `others` takes as many as it has room for.
    """
    r = reservations
    ci = int((x - r.x0) / r.bucket_m)
    cj = int((y - r.y0) / r.bucket_m)
    i0 = min(r.nx - 1, max(0, ci - 1))
    i1 = min(r.nx - 1, max(0, ci + 1))
    count = 0
    for j in range(max(0, cj - 1), min(r.ny, cj + 2)):
        row = j * r.nx  # buckets of a row are listed one after the other
        for m in range(r.starts[k + 1, row + i0], r.starts[k + 1, row + i1 + 1]):
            o = r.members[k + 1, m]
            if o == me or r.layers[o] != layer:
                continue
            reach = r.radii[me] + r.radii[o] + MARGIN_M + 2.0 * slice_m
            nearest = np.inf
            for s in range(2):
                d = closest_approach(
                    x - r.paths[o, k + s, 0],
                    y - r.paths[o, k + s, 1],
                    r.paths[o, k + s, 0] - r.paths[o, k + s + 1, 0],
                    r.paths[o, k + s, 1] - r.paths[o, k + s + 1, 1],
                )
                nearest = min(nearest, d)
            if nearest < reach and count < len(others):
                others[count] = o
                count += 1
    return count


@inlined
def meetings(
    reservations: Reservations,
    others: NDArray[np.int64],
    count: int,
    me: int,
    k: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    cx: float,
    cy: float,
) -> tuple[bool, float]:
    """`conflict` from a at slice k to b and on to c, with those that `others_near` listed."""
    soft = 0.0
    for n in range(count):
        o = others[n]
        first = _meets(reservations, me, o, k, ax, ay, bx, by)
        second = _meets(reservations, me, o, k + 1, bx, by, cx, cy)
        if (first or second) and reservations.ranks[o] < reservations.ranks[me]:
            return True, 1.0
        soft += (1.0 if first else 0.0) + (1.0 if second else 0.0)
    return False, soft


@inlined
def _meets(
    reservations: Reservations,
    me: int,
    other: int,
    k: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> bool:
    """Whether two touch on their way from slice k to the next, other than by drawing apart."""
    r = reservations
    rx = ax - r.paths[other, k, 0]
    ry = ay - r.paths[other, k, 1]
    ex = bx - r.paths[other, k + 1, 0]
    ey = by - r.paths[other, k + 1, 1]
    reach = r.radii[me] + r.radii[other] + MARGIN_M
    d = closest_approach(rx, ry, ex - rx, ey - ry)
    if d >= reach:
        return False
    before = np.sqrt(rx * rx + ry * ry)
    return not (d >= before - 1e-9 and np.sqrt(ex * ex + ey * ey) > before)
