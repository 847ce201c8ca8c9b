"""STABLE_BFP on bare arrays: Huang & Li, fig. 6."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import kernel
from esplanade.planning.traversal._stability_kernels import FORBIDDEN, STABLE
from esplanade.planning.traversal._wavefront_kernels import DIAGONAL, STRAIGHT
from esplanade.planning.traversal.traversability import Traversability


@kernel
def search(
    traversability: Traversability, left: NDArray[np.int32], start: int, goal: int, longest: float
) -> tuple[NDArray[np.int32], NDArray[np.int32], int]:
    """Cells from start to goal, the count on edges in each, and the number of expansions.

    No cells at all: there is no way as short as `longest`. A state is a cell and a count. States
    leave the queue in order of way so far + way left; whoever comes to a cell by a longer way is
    only let in with a lower count than all before: with any other it can get nowhere that they
    cannot. So each cell is closed once it was seen with the least count that leads to it.
    """
    links, steps, classes = (
        traversability.arrays.links,
        traversability.steps,
        traversability.classes,
    )
    least = np.full(len(steps), traversability.edge_cells, dtype=np.int16)
    states = np.empty((1024, 4), dtype=np.int32)
    keys = np.empty(1024, dtype=np.float64)
    items = np.empty(1024, dtype=np.int64)
    states[0] = (start, 0, 0, -1)
    made = 1
    size = heap_push(keys, items, 0, float(left[start]), 0)
    expansions = 0
    while size > 0:
        now = -items[0]
        size = heap_pop(keys, items, size)
        cell, count, way, _ = states[now]
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
            so_far = way + (DIAGONAL if d & 1 else STRAIGHT)
            states[made, 0] = other
            states[made, 1] = then
            states[made, 2] = so_far
            states[made, 3] = now
            key = float(so_far + left[other])
            if key > longest:
                continue
            size = heap_push(keys, items, size, key, -made)
            made += 1
    return np.empty(0, dtype=np.int32), np.empty(0, dtype=np.int32), expansions


@kernel
def _doubled(states: NDArray[np.int32]) -> NDArray[np.int32]:
    wider = np.empty((2 * len(states), states.shape[1]), dtype=np.int32)
    wider[: len(states)] = states
    return wider


@kernel
def _trace_back(
    states: NDArray[np.int32], last: int, expansions: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], int]:
    length = 0
    state = last
    while state >= 0:
        length += 1
        state = states[state, 3]
    cells = np.empty(length, dtype=np.int32)
    counts = np.empty(length, dtype=np.int32)
    state = last
    for k in range(length - 1, -1, -1):
        cells[k] = states[state, 0]
        counts[k] = states[state, 1]
        state = states[state, 3]
    return cells, counts, expansions
