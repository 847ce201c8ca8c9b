"""STABLE_BFP on bare arrays: Huang & Li, fig. 6."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import kernel
from esplanade.planning.traversal._stability_kernels import FORBIDDEN, STABLE
from esplanade.planning.traversal._wavefront_kernels import DIAGONAL, STRAIGHT
from esplanade.planning.traversal.traversability import Traversability

STATE = np.dtype([("cell", "i4"), ("count", "i4"), ("distance", "i4"), ("parent", "i4")])
"""A state of the search: its cell, the cells on edges in a row, the distance from the start in 1/70
of a cell, and the state before it, -1 for the start."""


@kernel
def search(
    traversability: Traversability, left: NDArray[np.int32], start: int, goal: int, longest: float
) -> tuple[NDArray[np.int32], NDArray[np.int32], int]:
    """Cells (K,) from start to goal, the count on edges in each (K,), and the expansions.

    There are no cells if no path is as short as `longest`. A state is a cell and a count. States
    leave the queue in order of their distance so far plus the distance that is left. A state that
    comes to a cell by a longer path is only expanded if its count is lower than all counts before,
    since otherwise it can get nowhere that the others cannot.
    """
    links, steps, classes = (
        traversability.arrays.links,
        traversability.steps,
        traversability.classes,
    )
    least = np.full(len(steps), traversability.edge_cells, dtype=np.int16)
    states = np.empty(1024, dtype=STATE)
    keys = np.empty(1024, dtype=np.float64)
    items = np.empty(1024, dtype=np.int64)
    states[0]["cell"] = start
    states[0]["count"] = 0
    states[0]["distance"] = 0
    states[0]["parent"] = -1
    made = 1
    size = heap_push(keys, items, 0, float(left[start]), 0)
    expansions = 0
    while size > 0:
        now = -items[0]
        size = heap_pop(keys, items, size)
        cell, count, distance = states[now]["cell"], states[now]["count"], states[now]["distance"]
        if count >= least[cell]:
            continue
        if cell == goal:
            return _trace_back(states, now, expansions)
        least[cell] = count
        expansions += 1
        if made + 8 > len(states):
            states = _doubled(states)
        if size + 8 > len(keys):
            keys = np.concatenate((keys, np.empty_like(keys)))
            items = np.concatenate((items, np.empty_like(items)))
        for d in range(8):
            if not steps[cell] >> d & 1:
                continue
            other = links[cell, d]
            if classes[other] == FORBIDDEN:
                continue
            then = 0 if classes[other] == STABLE else count + 1
            if then >= least[other]:
                continue
            so_far = distance + (DIAGONAL if d & 1 else STRAIGHT)
            states[made]["cell"] = other
            states[made]["count"] = then
            states[made]["distance"] = so_far
            states[made]["parent"] = now
            key = float(so_far + left[other])
            if key > longest:
                continue
            size = heap_push(keys, items, size, key, -made)
            made += 1
    return np.empty(0, dtype=np.int32), np.empty(0, dtype=np.int32), expansions


@kernel
def _doubled(states: NDArray[np.void]) -> NDArray[np.void]:
    """The same states with room for twice as many."""
    wider = np.empty(2 * len(states), dtype=STATE)
    wider[: len(states)] = states
    return wider


@kernel
def _trace_back(
    states: NDArray[np.void], last: int, expansions: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], int]:
    """The cells and counts from the start to the last state, and the number of expansions."""
    length = 0
    state = last
    while state >= 0:
        length += 1
        state = states[state]["parent"]
    cells = np.empty(length, dtype=np.int32)
    counts = np.empty(length, dtype=np.int32)
    state = last
    for k in range(length - 1, -1, -1):
        cells[k] = states[state]["cell"]
        counts[k] = states[state]["count"]
        state = states[state]["parent"]
    return cells, counts, expansions
