"""Wave fronts that lead to a goal, on bare arrays.

All kinds fill the same array: for each cell a *waypoint* and its distance to the goal, so that the
potential anywhere in the cell is that distance plus the distance to the waypoint.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import (
    HALF_DIAGONAL,
    GridArrays,
    anchor_at,
    follow,
    length,
    line_is_clear,
    spread_allowed,
)
from esplanade.planning.grid._side_kernels import cells_to_begin_at, is_barred, is_cut_off
from esplanade.planning.traversal._anchor_kernels import SLACK_M

PotentialValues = NDArray[np.float32]
"""(N, 4): metres from the waypoint to the goal, waypoint x, waypoint y, and the least number of
cells on edges in a row from the cell on, on any way to the goal: 0 where they are not counted, less
where they are and no way leads. The metres are inf where no path leads."""
EDGES = 3
"""The column of that number."""


@inlined
def potential_at(potential: PotentialValues, cell: int, x: float, y: float) -> float:
    """Metres from a point, in a cell, to the goal; inf where no path leads."""
    if cell < 0:
        return np.inf
    g = potential[cell]
    return float(g[0] + length(g[1] - x, g[2] - y))


@inlined
def direction_at(
    grid: GridArrays, potential: PotentialValues, cell: int, x: float, y: float
) -> tuple[float, float, float]:
    """Unit vector and distance to the waypoint; zeros at the goal or where no path leads.

    Within a quarter of a cell of a waypoint, the next waypoint is taken.
    """
    if cell < 0:
        return 0.0, 0.0, 0.0
    left, wx, wy, _ = potential[cell]
    if not np.isfinite(left):
        return 0.0, 0.0, 0.0
    leg = length(wx - x, wy - y)
    if leg < 0.25 * grid.layered.cell_m and left > 0.0:
        there = follow(grid, cell, wx, wy)
        if there >= 0:
            left, wx, wy, _ = potential[there]
            leg = length(wx - x, wy - y)
    if leg < 1e-4:  # waypoints are rounded to float32
        return 0.0, 0.0, 0.0
    return (wx - x) / leg, (wy - y) / leg, leg


@inlined
def sees_goal(
    grid: GridArrays,
    body: int,
    goal_cell: int,
    goal_x: float,
    goal_y: float,
    cell: int,
    x: float,
    y: float,
    enough: float,
) -> bool:
    """Whether a goal is seen from the anchor of a cell beside its own, at a height to step from.

    A goal may be where the body fits, in a cell whose anchor is elsewhere and has no step: a wave
    leaves the goal's cell by sight as well.
    """
    rise = abs(grid.layered.floors[cell] - grid.layered.floors[goal_cell])
    return bool(
        rise <= grid.kinds.measures[body]["step_on_m"]
        and line_is_clear(grid, body, cell, x, y, goal_x, goal_y, enough)
    )


@inlined
def spread_beside(
    spread: float, here: float, x: float, y: float, wx: float, wy: float, cx: float, cy: float
) -> float:
    """A lower bound of `spread_allowed` of the straight line from c to a waypoint w.

    The line from (x, y) to w has `spread`, and a disc that stands at (x, y) has room for `here` m.
    Each point of the new line has one of the other that is as far from w, and lies aside of it by
    the distance to w times the distance of the two directions. Points further from w than (x, y)
    are no further from (x, y) than c is.
    """
    way = length(wx - x, wy - y)
    new = length(wx - cx, wy - cy)
    if new <= 0.0:
        return -1.0
    beyond = (here - length(cx - x, cy - y)) / new
    if way <= 0.0:
        return beyond
    turned = length((wx - x) / way - (wx - cx) / new, (wy - y) / way - (wy - cy) / new)
    return spread - turned if new <= way else min(spread - turned, beyond)


@kernel
def begin_wave(
    goal_cell: int,
    goal_x: float,
    goal_y: float,
    potential: PotentialValues,
    settled: NDArray[np.uint8],
    spreads: NDArray[np.float32],
    keys: NDArray[np.float64],
    items: NDArray[np.int64],
    state: NDArray[np.int64],
) -> None:
    """Make the arrays of a wave ready for `grow_wave`; nothing but the goal is reached yet.

    `state` (2,) holds the number of entries in the heap and the number of cells reached.
    """
    potential[:, 0] = np.inf
    potential[:, 1:] = 0.0
    settled[:] = 0
    spreads[goal_cell] = -1.0
    potential[goal_cell, 0] = 0.0
    potential[goal_cell, 1] = goal_x
    potential[goal_cell, 2] = goal_y
    state[0] = heap_push(keys, items, 0, 0.0, goal_cell)
    state[1] = 0


@kernel
def grow_wave(
    grid: GridArrays,
    body: int,
    radius: float,
    longest_sight: float,
    potential: PotentialValues,
    settled: NDArray[np.uint8],
    spreads: NDArray[np.float32],
    keys: NDArray[np.float64],
    items: NDArray[np.int64],
    state: NDArray[np.int64],
    targets: NDArray[np.int64],
    margin: float,
    within: float,
    most: int,
) -> bool:
    """Let a wave spread on; returns whether it has gone as far as it is wanted, or is over.

    The wave spreads from anchor to anchor over the steps of a kind of body. A cell that sees its
    neighbour's waypoint within `longest_sight` metres takes that waypoint over, else the neighbour
    itself is its waypoint; at zero sight this is NF1. A cell is asked whether it sees its waypoint
    once, when it leaves the heap. On flat ground its line is traced only where the line of its
    neighbour does not answer: `spreads` (N,) are lower bounds of `spread_allowed`. Elsewhere that
    line says nothing, since what is a barrier depends on the height that one comes from. `keys` and
    `items` hold 8 entries a cell plus one.

    It is wanted up to `margin` metres further than the nearest of the cells `targets` (K,); without
    any it spreads over all cells. It is never wanted further than `within` metres from the goal. At
    most `most` cells are settled in one call. Wherever a wave is
    stopped, the cells that it has settled are as they will be when it is over.
    """
    steps, links = grid.kinds.steps[body], grid.layered.links
    enough = radius - SLACK_M
    size = state[0]
    reached = state[1]
    until = within
    for k in range(len(targets)):
        target = targets[k]
        if settled[target]:
            tx, ty = anchor_at(grid, body, target)
            until = min(until, potential_at(potential, target, tx, ty) + margin)
    last = reached + most
    room_lost_m = enough + HALF_DIAGONAL * grid.layered.cell_m  # from a cell's centre
    while size > 0:
        if keys[0] > until or reached >= last:
            break
        cell = items[0]
        size = heap_pop(keys, items, size)
        if settled[cell]:
            continue
        x, y = anchor_at(grid, body, cell)
        left = potential[cell, 0]
        wx = potential[cell, 1]
        wy = potential[cell, 2]
        spread = float(spreads[cell])
        seen = longest_sight == 0.0 or spread >= 0.0
        if not seen:
            spread = spread_allowed(grid, body, cell, x, y, wx, wy, enough)
            seen = spread >= 0.0
        if reached > 0 and not seen:
            left = np.float32(np.inf)
            for direction in range(8):
                other = links[cell, direction]
                if not steps[cell] >> direction & 1 or not settled[other]:
                    continue
                cx, cy = anchor_at(grid, body, other)
                further = potential_at(potential, other, cx, cy)
                if further + length(cx - x, cy - y) < left + length(wx - x, wy - y):
                    left = np.float32(further)
                    wx = np.float32(cx)
                    wy = np.float32(cy)
            potential[cell, 0] = left
            potential[cell, 1] = wx
            potential[cell, 2] = wy
            if not np.isfinite(left):
                continue
        settled[cell] = 1
        reached += 1
        here = grid.clearance[body, cell] - room_lost_m
        for k in range(len(targets)):
            if targets[k] == cell:
                until = min(until, potential_at(potential, cell, x, y) + margin)
        for direction in range(8):
            other = links[cell, direction]
            if other < 0 or settled[other]:
                continue
            cx, cy = anchor_at(grid, body, other)
            if not steps[cell] >> direction & 1 and not (
                reached == 1
                and longest_sight > 0.0
                and sees_goal(grid, body, cell, wx, wy, other, cx, cy, enough)
            ):
                continue
            from_m = float(left)
            tx = float(wx)
            ty = float(wy)
            if length(tx - cx, ty - cy) > longest_sight:
                from_m += length(tx - x, ty - y)
                tx = x
                ty = y
            cost = from_m + length(tx - cx, ty - cy)
            if cost < potential_at(potential, other, cx, cy):
                potential[other, 0] = from_m
                potential[other, 1] = tx
                potential[other, 2] = ty
                spreads[other] = -1.0
                if grid.flat:
                    spreads[other] = spread_beside(spread, here, x, y, tx, ty, cx, cy)
                size = heap_push(keys, items, size, cost, other)
    state[0] = size
    state[1] = reached
    return bool(size == 0 or keys[0] > until)


@kernel
def extend_into_obstacles(
    grid: GridArrays,
    body: int,
    potential: PotentialValues,
    settled: NDArray[np.uint8],
) -> None:
    """Lead out of cells that are not free but lie next to reached ones, three rings deep.

    An agent closer to a wall than its radius then still finds the path, on its side of the wall.
    Distances over such cells count threefold. Cells that are settled beyond these rings are left as
    they are.
    """
    step_on_m = grid.kinds.measures[body]["step_on_m"]
    for ring in range(1, 4):
        for cell in range(len(settled)):
            if settled[cell] or grid.layered.floors[cell] != grid.layered.floors[cell]:
                continue
            x, y = anchor_at(grid, body, cell)
            best = np.inf
            for direction in range(8):
                other = grid.layered.links[cell, direction]
                if other < 0 or settled[other] == 0 or settled[other] > ring:
                    continue
                if abs(grid.layered.floors[other] - grid.layered.floors[cell]) > step_on_m:
                    continue
                cx, cy = anchor_at(grid, body, other)
                way = length(cx - x, cy - y)
                left = potential_at(potential, other, cx, cy) + 2.0 * way
                if left + way < best and not is_barred(grid, body, cell, x, y, cx, cy):
                    best = left + way
                    potential[cell, 0] = left
                    potential[cell, 1] = cx
                    potential[cell, 2] = cy
            if np.isfinite(best):
                settled[cell] = ring + 1


@kernel
def way_out(
    grid: GridArrays,
    potential: PotentialValues,
    body: int,
    radius: float,
    cell: int,
    x: float,
    y: float,
) -> tuple[int, float]:
    """The cell next to a point by whose anchor a way leads to the goal, and its length in metres.

    It is for points that are cut off from the anchor of their own cell, whose potential is that of
    the other side of a wall. Without any such cell it is -1, and the length inf.
    """
    best = -1
    least = np.inf
    for other in cells_to_begin_at(grid, body, radius, cell, x, y):
        cx, cy = anchor_at(grid, body, other)
        left = potential_at(potential, other, cx, cy) + length(cx - x, cy - y)
        if left < least:
            least = left
            best = other
    return best, least


@kernel
def distances(
    grid: GridArrays,
    potential: PotentialValues,
    body: int,
    radius: float,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out` (N,) with `potential_at` of cells (N,) and positions (N, 2), or by `way_out`."""
    for k in range(len(positions)):
        x, y = positions[k]
        if is_cut_off(grid, body, cells[k], x, y):
            out[k] = way_out(grid, potential, body, radius, cells[k], x, y)[1]
        else:
            out[k] = potential_at(potential, cells[k], x, y)


@kernel
def directions(
    grid: GridArrays,
    potential: PotentialValues,
    body: int,
    radius: float,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out` (N, 2) with the vectors of `direction_at`, for cells (N,), positions (N, 2).

    From points that are cut off from the anchors of their cells they are those of `way_out`.
    """
    for k in range(len(positions)):
        x, y = positions[k]
        if is_cut_off(grid, body, cells[k], x, y):
            out[k] = 0.0
            other = way_out(grid, potential, body, radius, cells[k], x, y)[0]
            if other >= 0:
                cx, cy = anchor_at(grid, body, other)
                way = length(cx - x, cy - y)
                out[k, 0] = (cx - x) / way
                out[k, 1] = (cy - y) / way
            continue
        dx, dy, _ = direction_at(grid, potential, cells[k], x, y)
        out[k, 0] = dx
        out[k, 1] = dy
