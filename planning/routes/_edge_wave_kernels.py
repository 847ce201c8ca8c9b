"""A wave front that counts cells on edges, on bare arrays: Huang & Li's M in the potential.

A cell on an edge may be reached by several ways: a shorter one that stays on edges for long, and a
longer one that leaves them soon. Each is a label, a distance and a number of cells on edges in a
row. As in STABLE_BFP (fig. 6), a later label is of use only where its number is lower.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import (
    GridArrays,
    anchor_at,
    clearance_at,
    follow,
    length,
)
from esplanade.planning.routes._potential_kernels import (
    EDGES,
    PotentialValues,
    potential_at,
    sees_goal,
)
from esplanade.planning.traversal._anchor_kernels import SLACK_M
from esplanade.planning.traversal._edge_run_kernels import cells_in
from esplanade.planning.traversal._stability_kernels import FORBIDDEN, STABLE

LABEL = np.dtype([("cell", "i4"), ("edges", "i4"), ("left", "f4"), ("x", "f4"), ("y", "f4")])
"""A way from a cell to the goal: cells on edges in a row at its beginning, metres from the waypoint
to the goal, and the waypoint."""

_REACHED = 1
"""A cell from which a legal way leads to the goal for whoever comes there from stable ground."""
_BEGUN_AT = 2
"""A cell from which one does only for a body that begins there; a mark of this wave alone."""

_EDGE_COST = 1.02
"""A metre on edges counts so many: of ways about as long, the one that leaves them soon is taken,
and others can leave them there as well."""


@kernel
def _sees_stably(
    grid: GridArrays,
    body: int,
    edges: NDArray[np.bool_],
    cell: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    radius: float,
) -> bool:
    """Whether a disc may move straight from a, in `cell`, to b without coming to an edge."""
    way = length(bx - ax, by - ay)
    shortest = 0.5 * grid.layered.cell_m
    s = 0.0
    while True:
        u = s / way if way > 0.0 else 0.0
        x = ax + u * (bx - ax)
        y = ay + u * (by - ay)
        cell = follow(grid, cell, x, y)
        if cell < 0 or edges[cell] or clearance_at(grid, body, cell, x, y) < radius:
            return False
        if s >= way:
            return True
        s = min(way, s + shortest)


@kernel
def spread_over_edges(
    grid: GridArrays,
    body: int,
    radius: float,
    most_edges: int,
    longest_sight: float,
    goal_cell: int,
    classes: NDArray[np.uint8],
    potential: PotentialValues,
    settled: NDArray[np.uint8],
) -> int:
    """Let a wave spread from a goal over all cells, counting those on edges; returns the reached.

    `classes` (N,) are the `Stability` of each cell for the kind of body; `potential` (N, 4) and
    `settled` (N,) must be as `begin_wave` leaves them. A way is legal in a cell
    if the cells on edges from stable ground to it and from it to stable ground are fewer than
    `most_edges` together; the first legal way to reach a cell is its potential. A cell without one
    has the first that is legal for a body that begins there; `settled` is 1 in both. The number of
    cells on edges that is kept with it is the least of any way from there, -1 without any. Lines of
    sight, of at most `longest_sight` metres, lead over stable ground only; the goal's cell is left
    by sight if its anchor has no step at all.
    """
    steps, links = grid.kinds.steps[body], grid.layered.links
    enough = radius - SLACK_M
    edges = (classes != STABLE) & (classes != FORBIDDEN)
    inside = cells_in(links, steps, edges)
    nearest = np.full(len(edges), np.inf)
    least = np.full(len(edges), most_edges + 1, dtype=np.int32)
    labels = np.empty(1024, dtype=LABEL)
    keys = np.empty(1024, dtype=np.float64)
    items = np.empty(1024, dtype=np.int64)
    labels[0]["cell"] = goal_cell
    labels[0]["edges"] = 1 if edges[goal_cell] else 0
    labels[0]["left"] = 0.0
    labels[0]["x"] = potential[goal_cell, 1]
    labels[0]["y"] = potential[goal_cell, 2]
    potential[goal_cell, 0] = np.inf
    made = 1
    size = heap_push(keys, items, 0, 0.0, 0)
    reached = 0
    while size > 0:
        now = items[0]
        size = heap_pop(keys, items, size)
        cell = labels[now]["cell"]
        row = labels[now]["edges"]
        if row >= least[cell]:
            continue
        x, y = anchor_at(grid, body, cell)
        left = labels[now]["left"]
        wx = labels[now]["x"]
        wy = labels[now]["y"]
        if (
            now > 0
            and row == 0
            and longest_sight > 0.0
            and not _sees_stably(grid, body, edges, cell, x, y, wx, wy, radius)
        ):
            # The waypoint was the neighbour's, and is not seen from here: go to a neighbour.
            best = np.inf
            for d in range(8):
                other = links[cell, d]
                if not steps[cell] >> d & 1 or settled[other] != _REACHED:
                    continue
                cx, cy = anchor_at(grid, body, other)
                way = length(cx - x, cy - y)
                if edges[other]:
                    way *= _EDGE_COST
                there = potential_at(potential, other, cx, cy)
                if there + way < best:
                    best = there + way
                    left = there + way - length(cx - x, cy - y)
                    wx = cx
                    wy = cy
            if not np.isfinite(best):
                continue
        least[cell] = row
        legal = row == 0 or inside[cell] + row - 1 < most_edges
        if settled[cell] != _REACHED and (legal or settled[cell] == 0):
            reached += settled[cell] == 0
            settled[cell] = _REACHED if legal else _BEGUN_AT
            potential[cell, 0] = left
            potential[cell, 1] = wx
            potential[cell, 2] = wy
        potential[cell, EDGES] = row  # the numbers of later labels are lower
        if made + 8 > len(labels):
            wider = np.empty(2 * len(labels), dtype=LABEL)
            wider[: len(labels)] = labels
            labels = wider
        if size + 8 > len(keys):
            keys = np.concatenate((keys, np.empty_like(keys)))
            items = np.concatenate((items, np.empty_like(items)))
        own = left + length(wx - x, wy - y)
        sighted = now == 0 and longest_sight > 0.0 and steps[cell] == 0
        for d in range(8):
            other = links[cell, d]
            by_step = steps[cell] >> d & 1
            if other < 0 or not (by_step or sighted):
                continue
            then = 0
            if edges[other]:
                then = row + 1
            elif row >= most_edges:
                continue
            if then >= least[other] or classes[other] == FORBIDDEN:
                continue
            cx, cy = anchor_at(grid, body, other)
            ox = wx
            oy = wy
            there = left
            if not by_step:
                if not sees_goal(grid, body, cell, wx, wy, other, cx, cy, enough):
                    continue
                if row > 0 or then > 0:
                    there += (_EDGE_COST - 1.0) * length(wx - cx, wy - cy)
            elif row > 0 or then > 0 or length(wx - cx, wy - cy) > longest_sight:
                ox = x
                oy = y
                there = own
                if row > 0 or then > 0:
                    there += (_EDGE_COST - 1.0) * length(x - cx, y - cy)
            key = there + length(ox - cx, oy - cy)
            if then == 0:
                if key >= nearest[other]:
                    continue
                nearest[other] = key
            labels[made]["cell"] = other
            labels[made]["edges"] = then
            labels[made]["left"] = there
            labels[made]["x"] = ox
            labels[made]["y"] = oy
            size = heap_push(keys, items, size, key, made)
            made += 1
    for cell in range(len(settled)):
        if settled[cell] == _BEGUN_AT:
            settled[cell] = _REACHED
        elif settled[cell] == 0:
            potential[cell, EDGES] = -1.0
    return reached
