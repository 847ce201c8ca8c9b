"""Wave fronts over links, on bare arrays: NF1 across layers."""

import numpy as np
from numpy.typing import NDArray

from planning._jit import kernel
from planning._stability_kernels import FORBIDDEN

STRAIGHT = 70
DIAGONAL = 99
"""Lengths of steps in units of 1/70 of a cell; 99/70 is the square root of 2 within 0.01 %. Whole
numbers make equally long ways exactly equal."""
UNREACHED = np.int32(2**30)


@kernel
def spread(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    classes: NDArray[np.uint8],
    goal: int,
    start: int,
    left: NDArray[np.int32],
) -> int:
    """Write the shortest ways to a goal over steps between cells that are not Forbidden.

    Waits for no one but `start`: once it is reached, what is further away is left unreached; -1:
    everything is wanted. Returns the number of cells that are settled.

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
    settled = 0
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
        settled += 1
        if cell == start:
            break
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
    return settled
