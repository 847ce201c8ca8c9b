"""Runs of cells on edges, on bare arrays: how long they may be, and how deep in them a cell is."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel


@kernel
def _farthest(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    edges: NDArray[np.bool_],
    start: int,
    away: NDArray[np.int32],
    queue: NDArray[np.int32],
) -> int:
    """Write the number of steps over edges from a cell into `away` (N,); returns the cells reached.

    They are in `queue` (N,), the farthest last. `away` must be -1 in all of them.
    """
    away[start] = 0
    queue[0] = start
    head, tail = 0, 1
    while head < tail:
        cell = queue[head]
        head += 1
        for d in range(8):
            if not steps[cell] >> d & 1:
                continue
            other = links[cell, d]
            if edges[other] and away[other] < 0:
                away[other] = away[cell] + 1
                queue[tail] = other
                tail += 1
    return tail


@kernel
def longest_run(
    links: NDArray[np.int32], steps: NDArray[np.uint8], edges: NDArray[np.bool_]
) -> float:
    """No shortest path stays on edges for more cells in a row than this; cost O(cells on edges).

    Of each connected region of edges it is the width, told by the cells furthest from one about in
    its middle, in steps and at worst in steps that are all diagonal.
    """
    away = np.full(len(edges), -1, dtype=np.int32)
    seen = np.zeros(len(edges), dtype=np.bool_)
    queue = np.empty(len(edges), dtype=np.int32)
    longest = 0.0
    for first in range(len(edges)):
        if not edges[first] or seen[first]:
            continue
        start = first
        reached = 0
        for sweep in range(3):
            reached = _farthest(links, steps, edges, start, away, queue)
            end = queue[reached - 1]
            if sweep == 1:  # from one end to the other: go back to the middle
                half = away[end] // 2
                while away[end] > half:
                    for d in range(8):
                        other = links[end, d]
                        if steps[end] >> d & 1 and edges[other] and away[other] == away[end] - 1:
                            end = other
                            break
            start = end
            most = away[queue[reached - 1]]
            for k in range(reached):
                seen[queue[k]] = True
                away[queue[k]] = -1
        longest = max(longest, min(float(reached), 1.0 + 2.0 * np.sqrt(2.0) * most))
    return longest


@kernel
def cells_in(
    links: NDArray[np.int32], steps: NDArray[np.uint8], edges: NDArray[np.bool_]
) -> NDArray[np.int32]:
    """The least number of cells on edges, int32 (N,), on the way from stable ground to a cell.

    The cell itself counts; it is 0 on stable ground, and a great number where no stable ground is
    connected.
    """
    depth = np.full(len(edges), 2**30, dtype=np.int32)
    queue = np.empty(len(edges), dtype=np.int32)
    tail = 0
    for cell in range(len(edges)):
        if edges[cell]:
            for d in range(8):
                if steps[cell] >> d & 1 and not edges[links[cell, d]]:
                    depth[cell] = 1
                    queue[tail] = cell
                    tail += 1
                    break
        else:
            depth[cell] = 0
    head = 0
    while head < tail:
        cell = queue[head]
        head += 1
        for d in range(8):
            if not steps[cell] >> d & 1:
                continue
            other = links[cell, d]
            if depth[other] > depth[cell] + 1:
                depth[other] = depth[cell] + 1
                queue[tail] = other
                tail += 1
    return depth
