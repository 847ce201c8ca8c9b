"""Wave fronts over links, on bare arrays: NF1 across layers."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground.layered import LINK_COLUMNS, LINK_ROWS
from esplanade.planning.traversal._stability_kernels import FORBIDDEN
from esplanade.planning.traversal.traversability import Traversability

STRAIGHT = 70
DIAGONAL = 99
"""Lengths of steps in units of 1/70 of a cell; 99/70 is the square root of 2 within 0.01 %. Whole
numbers make equally long ways exactly equal."""
UNREACHED = np.int32(2**30)
_BUCKETS = 256
"""A power of two, more than a step and the estimate of what is left grow together."""


@kernel
def spread(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    classes: NDArray[np.uint8],
    goal: int,
    left: NDArray[np.int32],
) -> None:
    """Write the shortest ways to a goal over steps between cells that are not Forbidden.

    Steps lead both ways, so those out of a cell are those into it. Cells are settled in order of
    their way, so those reached by a straight step leave one queue in that order, those by a
    diagonal another: Dijkstra without a heap. No cell enters a queue twice.
    """
    left[:] = UNREACHED
    cells = np.empty((2, len(left)), dtype=np.int32)
    ways = np.empty((2, len(left)), dtype=np.int32)
    cells[0, 0] = goal
    ways[0, 0] = 0
    left[goal] = 0
    head0, head1, tail0, tail1 = 0, 0, 1, 0
    while head0 < tail0 or head1 < tail1:
        if head1 == tail1 or (head0 < tail0 and ways[0, head0] <= ways[1, head1]):
            cell = cells[0, head0]
            way = ways[0, head0]
            head0 += 1
        else:
            cell = cells[1, head1]
            way = ways[1, head1]
            head1 += 1
        if way > left[cell]:
            continue
        for d in range(8):
            if not steps[cell] >> d & 1:
                continue
            other = links[cell, d]
            then = way + (DIAGONAL if d & 1 else STRAIGHT)
            if then >= left[other] or classes[other] == FORBIDDEN:
                continue
            left[other] = then
            if d & 1:
                cells[1, tail1] = other
                ways[1, tail1] = then
                tail1 += 1
            else:
                cells[0, tail0] = other
                ways[0, tail0] = then
                tail0 += 1


@inlined
def _at_least(rows: int, columns: int) -> int:
    """The shortest way over so many rows and columns if nothing is between."""
    a, b = abs(rows), abs(columns)
    return STRAIGHT * max(a, b) + (DIAGONAL - STRAIGHT) * min(a, b)


@kernel
def spread_toward(
    traversability: Traversability, goal: int, start: int, longer: float, left: NDArray[np.int32]
) -> None:
    """`spread`, but straight for a start, and no further than its way `longer` times over.

    Cells are settled in order of their way plus the least that is left to the start: A*. The
    sum never falls and grows by less than `_BUCKETS` a step, so cells wait in a ring of lists,
    the latest first. What is written for cells that are not settled may be too much.
    """
    links, places = traversability.arrays.links, traversability.arrays.places
    steps, classes = traversability.steps, traversability.classes
    left[:] = UNREACHED
    left[goal] = 0
    heads = np.full(_BUCKETS, -1, dtype=np.int32)
    entries = np.empty((len(left) + 8, 3), dtype=np.int32)
    row, column = places[start, 1], places[start, 2]
    total = _at_least(places[goal, 1] - row, places[goal, 2] - column)
    entries[0] = (goal, 0, -1)
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
        cell, way, heads[total % _BUCKETS] = entries[entry]
        if way > left[cell]:
            continue
        if cell == start:
            if longer <= 1.0:
                break
            longest = longer * way
        if used + 8 > len(entries):
            entries = np.concatenate((entries, np.empty_like(entries)))
        rows, columns = places[cell, 1] - row, places[cell, 2] - column
        for diagonal in range(2):
            then = way + (DIAGONAL if diagonal else STRAIGHT)
            for d in range(diagonal, 8, 2):
                if not steps[cell] >> d & 1:
                    continue
                other = links[cell, d]
                if then >= left[other] or classes[other] == FORBIDDEN:
                    continue
                left[other] = then
                bucket = then + _at_least(rows + LINK_ROWS[d], columns + LINK_COLUMNS[d])
                bucket %= _BUCKETS
                entries[used, 0] = other
                entries[used, 1] = then
                entries[used, 2] = heads[bucket]
                heads[bucket] = used
                used += 1


@kernel
def number_regions(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    classes: NDArray[np.uint8],
    regions: NDArray[np.int32],
) -> None:
    """Number what hangs together by steps between cells that are not Forbidden; -1: Forbidden."""
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
