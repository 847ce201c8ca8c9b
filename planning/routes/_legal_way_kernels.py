"""Ways over anchors that leave edges in time, on bare arrays: Huang & Li's M for one body.

The potential of a cell on an edge is that of a body that has come there from stable ground as
directly as it can. For a body that has been on edges for longer another way may be the shortest
that is legal. So states of a cell and a count are searched, as in STABLE_BFP (fig. 6), up to where
the way leaves the edges.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, anchor_at, length
from esplanade.planning.routes._anchor_way_kernels import append_step
from esplanade.planning.routes._potential_kernels import EDGES, PotentialValues, potential_at

STATE = np.dtype(
    [
        ("cell", "i4"),
        ("parent", "i4"),
        ("depth", "i4"),
        ("left_edges", "?"),
        ("count", "f8"),
        ("so_far_m", "f8"),
    ]
)
"""A state of the search: its cell, the state before it, -1 for the first, the steps up to it,
whether the way has left edges, the cells on edges in a row, and the way from the first, metres."""
_MOST_STATES = 4096
_SLOTS = 4 * _MOST_STATES
_LEAST = 0.01
ROUNDING_CELLS = 1.0
"""The way on edges may be so many cells longer where an agent walks than from cell to cell."""


@inlined
def _slot(keys: NDArray[np.int64], cell: int) -> int:
    """The row of a table, (K,) of cells or -1, for a cell; K is a power of two."""
    h = (cell * 0x9E3779B1) & (len(keys) - 1)
    while keys[h] >= 0 and keys[h] != cell:
        h = (h + 1) & (len(keys) - 1)
    return h


@inlined
def _edges_left(potential: PotentialValues, cell: int) -> float:
    """The least number of cells on edges in a row that lie ahead of a cell."""
    return max(0.0, float(potential[cell, EDGES]) - 1.0)


@kernel
def legal_ahead(
    grid: GridArrays,
    potential: PotentialValues,
    body: int,
    cell: int,
    on_edges: float,
    most_edges: float,
    points: NDArray[np.float64],
    cells: NDArray[np.int64],
    counts: NDArray[np.float64],
) -> int:
    """Write the points of the shortest way over anchors that M allows, as `anchors_ahead` does.

    It ends where it leaves edges that it was on; `counts` (K,) receives the cells on edges in a row
    up to each point.

    The body is in a cell and has come `on_edges` cells on edges in a row. Fewer than `most_edges`
    are legal, on edges one more, or as few as possible where these are too few already. Returns the
    number of points, 0 where no way was found. Cost O(states log states), at most some thousand.
    """
    count = 0.0
    bound = most_edges
    if on_edges > 0.0:
        count = on_edges + 0.5
        bound = max(most_edges + ROUNDING_CELLS, count + _edges_left(potential, cell) + _LEAST)
    states = np.empty(_MOST_STATES, dtype=STATE)
    heap_keys = np.empty(_MOST_STATES)
    items = np.empty(_MOST_STATES, dtype=np.int64)
    slots = np.full(_SLOTS, -1, dtype=np.int64)
    least = np.full(_SLOTS, np.inf)
    states[0]["cell"] = cell
    states[0]["parent"] = -1
    states[0]["depth"] = 0
    states[0]["left_edges"] = False
    states[0]["count"] = count
    states[0]["so_far_m"] = 0.0
    made = 1
    size = heap_push(heap_keys, items, 0, 0.0, 0)
    deepest = (len(points) - 1) // 2
    while size > 0:
        now = items[0]
        size = heap_pop(heap_keys, items, size)
        cell = int(states[now]["cell"])
        count = states[now]["count"]
        slot = _slot(slots, cell)
        if count >= least[slot]:
            continue
        slots[slot] = cell
        least[slot] = count
        if (
            states[now]["left_edges"]
            or states[now]["depth"] >= deepest
            or potential[cell, 0] == 0.0
        ):
            return _write(grid, potential, body, states, now, points, cells, counts)
        x, y = anchor_at(grid, body, cell)
        for direction in range(8):
            if not grid.kinds.steps[body, cell] >> direction & 1:
                continue
            other = int(grid.layered.links[cell, direction])
            if potential[other, EDGES] < 0.0:
                continue
            then = count + 1.0 if grid.edges[body, other] else 0.0
            if then > 0.0 and then + _edges_left(potential, other) >= bound:
                continue
            if then >= least[_slot(slots, other)]:
                continue
            cx, cy = anchor_at(grid, body, other)
            left_m = potential_at(potential, other, cx, cy)
            if not np.isfinite(left_m):
                continue
            if made == _MOST_STATES:
                return 0
            states[made]["cell"] = other
            states[made]["parent"] = now
            states[made]["depth"] = states[now]["depth"] + 1
            states[made]["left_edges"] = then == 0.0 and grid.edges[body, cell]
            states[made]["count"] = then
            states[made]["so_far_m"] = states[now]["so_far_m"] + length(cx - x, cy - y)
            size = heap_push(heap_keys, items, size, states[made]["so_far_m"] + left_m, made)
            made += 1
    return 0


@kernel
def _write(
    grid: GridArrays,
    potential: PotentialValues,
    body: int,
    states: NDArray[np.void],
    last: int,
    points: NDArray[np.float64],
    cells: NDArray[np.int64],
    counts: NDArray[np.float64],
) -> int:
    """Write the points of the way to a state, and at last the goal if that is in its cell."""
    depth = states[last]["depth"]
    way = np.empty(depth + 1, dtype=np.int64)
    state = last
    for k in range(depth, -1, -1):
        way[k] = state
        state = states[state]["parent"]
    cell = int(states[way[0]]["cell"])
    points[0] = anchor_at(grid, body, cell)
    cells[0] = cell
    counts[0] = states[way[0]]["count"]
    count = 1
    for k in range(1, depth + 1):
        before = count
        other = int(states[way[k]]["cell"])
        count = append_step(grid, body, cell, other, points, cells, count)
        counts[before:count] = states[way[k]]["count"]
        cell = other
    if potential[cell, 0] == 0.0 and count < len(points):
        points[count] = potential[cell, 1:3]
        cells[count] = cell
        counts[count] = counts[count - 1]
        count += 1
    return count
