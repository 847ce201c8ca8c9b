"""Wave fronts over links, on bare arrays: NF1 across layers."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground.layered import LINK_COLUMNS, LINK_ROWS
from esplanade.planning.traversal._stability_kernels import FORBIDDEN
from esplanade.planning.traversal.traversability import Traversability

STRAIGHT = 70
DIAGONAL = 99
"""Lengths of steps in units of 1/70 of a cell; 99/70 is the square root of 2 within 0.01 %. As they
are whole numbers, equally long paths are exactly equal."""
UNREACHED = np.int32(2**30)
_BUCKETS = 256
"""Number of buckets in the ring of `spread_toward`: a power of two above the greatest sum of a step
and a change of the estimate."""

_WAITING = np.dtype([("cell", "i4"), ("distance", "i4"), ("next", "i4")])
"""A cell that waits in a bucket, its distance, and the next entry of the bucket or -1."""


@kernel
def spread(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    classes: NDArray[np.uint8],
    goal: int,
    distances: NDArray[np.int32],
) -> None:
    """Write the shortest distances to a goal over steps between cells that are not Forbidden.

    Steps lead in both directions, so the steps out of a cell are the steps into it. Cells are
    settled in order of distance; those reached by a straight step leave one queue in that order,
    those reached by a diagonal step another. This is Dijkstra's algorithm without a heap. No cell
    enters a queue twice.
    """
    distances[:] = UNREACHED
    cells = np.empty((2, len(distances)), dtype=np.int32)
    queued = np.empty((2, len(distances)), dtype=np.int32)
    cells[0, 0] = goal
    queued[0, 0] = 0
    distances[goal] = 0
    head0, head1, tail0, tail1 = 0, 0, 1, 0
    while head0 < tail0 or head1 < tail1:
        if head1 == tail1 or (head0 < tail0 and queued[0, head0] <= queued[1, head1]):
            cell = cells[0, head0]
            distance = queued[0, head0]
            head0 += 1
        else:
            cell = cells[1, head1]
            distance = queued[1, head1]
            head1 += 1
        if distance > distances[cell]:
            continue
        for d in range(8):
            if not steps[cell] >> d & 1:
                continue
            other = links[cell, d]
            then = distance + (DIAGONAL if d & 1 else STRAIGHT)
            if then >= distances[other] or classes[other] == FORBIDDEN:
                continue
            distances[other] = then
            if d & 1:
                cells[1, tail1] = other
                queued[1, tail1] = then
                tail1 += 1
            else:
                cells[0, tail0] = other
                queued[0, tail0] = then
                tail0 += 1


@inlined
def _least_distance(rows: int, columns: int) -> int:
    """The shortest distance over a number of rows and columns if no obstacle is between."""
    a, b = abs(rows), abs(columns)
    return STRAIGHT * max(a, b) + (DIAGONAL - STRAIGHT) * min(a, b)


@kernel
def spread_toward(
    traversability: Traversability,
    goal: int,
    start: int,
    longer: float,
    distances: NDArray[np.int32],
) -> None:
    """`spread`, but towards a start, and no further than `longer` times the start's distance.

    Cells are settled in order of their distance plus the least distance to the start: A*. The sum
    never falls and grows by less than `_BUCKETS` in a step, so cells wait in a ring of buckets,
    the latest first. Distances of cells that are not settled may be too great.
    """
    links, places = traversability.arrays.links, traversability.arrays.places
    steps, classes = traversability.steps, traversability.classes
    distances[:] = UNREACHED
    distances[goal] = 0
    heads = np.full(_BUCKETS, -1, dtype=np.int32)
    entries = np.empty(len(distances) + 8, dtype=_WAITING)
    row, column = places[start]["row"], places[start]["column"]
    total = _least_distance(places[goal]["row"] - row, places[goal]["column"] - column)
    entries[0]["cell"] = goal
    entries[0]["distance"] = 0
    entries[0]["next"] = -1
    heads[total % _BUCKETS] = 0
    used = 1
    longest = np.inf
    empty = 0
    while empty < _BUCKETS and total <= longest:
        entry = heads[total % _BUCKETS]
        if entry < 0:
            total += 1
            empty += 1
            continue
        empty = 0
        cell, distance = entries[entry]["cell"], entries[entry]["distance"]
        heads[total % _BUCKETS] = entries[entry]["next"]
        if distance > distances[cell]:
            continue
        if cell == start:
            if longer <= 1.0:
                break
            longest = longer * distance
        if used + 8 > len(entries):
            entries = np.concatenate((entries, np.empty_like(entries)))
        rows, columns = places[cell]["row"] - row, places[cell]["column"] - column
        for diagonal in range(2):
            then = distance + (DIAGONAL if diagonal else STRAIGHT)
            for d in range(diagonal, 8, 2):
                if not steps[cell] >> d & 1:
                    continue
                other = links[cell, d]
                if then >= distances[other] or classes[other] == FORBIDDEN:
                    continue
                distances[other] = then
                bucket = then + _least_distance(rows + LINK_ROWS[d], columns + LINK_COLUMNS[d])
                bucket %= _BUCKETS
                entries[used]["cell"] = other
                entries[used]["distance"] = then
                entries[used]["next"] = heads[bucket]
                heads[bucket] = used
                used += 1


@kernel
def number_regions(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    classes: NDArray[np.uint8],
    regions: NDArray[np.int32],
) -> None:
    """Number the regions (N,) that steps between cells connect; -1 in Forbidden cells."""
    queue = np.empty(len(regions), dtype=np.int32)
    regions[:] = -1
    count = 0
    for seed in range(len(regions)):
        if regions[seed] >= 0 or classes[seed] == FORBIDDEN:
            continue
        regions[seed] = count
        queue[0] = seed
        head, tail = 0, 1
        while head < tail:
            cell = queue[head]
            head += 1
            for d in range(8):
                if not steps[cell] >> d & 1:
                    continue
                other = links[cell, d]
                if regions[other] < 0 and classes[other] != FORBIDDEN:
                    regions[other] = count
                    queue[tail] = other
                    tail += 1
        count += 1
