"""Certain obstacles: the planned ways of other actors, looked up in CT-space."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._geometry_kernels import closest_approach
from planning._jit import kernel

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


@kernel
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
            rx = ax - r.paths[other, k, 0]
            ry = ay - r.paths[other, k, 1]
            ex = bx - r.paths[other, k + 1, 0]
            ey = by - r.paths[other, k + 1, 1]
            reach = r.radii[me] + r.radii[other] + MARGIN_M
            d = closest_approach(rx, ry, ex - rx, ey - ry)
            if d >= reach:
                continue
            if d >= np.hypot(rx, ry) - 1e-9 and np.hypot(ex, ey) > np.hypot(rx, ry):
                continue
            if r.ranks[other] < r.ranks[me]:
                return True, 1.0
            soft += 1.0
    return False, soft
