"""Best-first search in CT-space on bare arrays, Lei & Li, fig. 5."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._branch_kernels import (
    HALF_X,
    HALF_Y,
    LEFT,
    SPEED,
    STRIDE,
    TURNED,
    VX,
    VY,
    Moves,
    X,
    Y,
    branch_out,
    look_up,
)
from esplanade.planning.agents._cost_kernels import (
    NOT_COUNTED,
    Near,
    look_around,
    motion_cost,
    others_weight,
    people_risk,
    step_parts,
)
from esplanade.planning.agents._task_kernels import (
    SUB,
    TOO_MANY,
    Task,
    World,
    count_edges,
    metres_left,
    needed_clearance,
    risk_price,
    wall_cost,
    way_left,
)
from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import borrowing, inlined
from esplanade.planning.grid._grid_kernels import clearance_at, follow, length
from esplanade.planning.routes._potential_kernels import PotentialValues, direction_at

FOUND = 0
PARTIAL = 1
NO_PATH = 2
"""Statuses of a search, those of `SearchStatus`."""


NODE = np.dtype(
    [
        ("x", "f8"),
        ("y", "f8"),
        ("vx", "f8"),
        ("vy", "f8"),
        ("cost_s", "f8"),
        ("half_x", "f8"),
        ("half_y", "f8"),
    ]
)
"""Position and velocity of a node, its cost so far in seconds, and the position half a step before;
metres, metres a second."""


class Workspace(NamedTuple):
    """Memory of one search at a time; `node_*` (N,) are nodes in the order they were made.

    `table_*` is a hash table of the best node so far in each cell and step. The best node has the
    least sum of cost so far and cost left: positions differ within a cell, and the cost so far
    alone would favour nodes that have made less progress.
    """

    node_state: NDArray[np.void]
    """(N,) of `NODE`."""
    node_cell: NDArray[np.int64]
    node_edge: NDArray[np.float64]
    """The way on edges since stable ground, in cells."""
    node_parent: NDArray[np.int64]
    node_step: NDArray[np.int64]
    node_order: NDArray[np.int64]
    """Number of a node's expansion; what is there of a node that was not expanded means nothing."""
    heap_keys: NDArray[np.float64]
    heap_items: NDArray[np.int64]
    table_key: NDArray[np.int64]
    table_worth: NDArray[np.float64]
    table_stamp: NDArray[np.int64]
    stamp: NDArray[np.int64]
    near: Near
    """Those near the node that is expanded."""
    branches: NDArray[np.float64]
    """(`BRANCH_ROWS`, M + 1): the steps that it branches into."""
    branch_cells: NDArray[np.int64]
    """(2, M + 1): the cells half-way and at the end of them."""
    worths: NDArray[np.float64]
    """(N,): the cost so far and that left of the nodes that a search begins with."""
    ends: NDArray[np.int64]
    """(3,): nodes that were made, those of them left in the queue, and the last one of the path."""


class Outcome(NamedTuple):
    """Result of a search: a status, its expansions, and what the path costs in seconds.

    The cost is that of `path_cost` if the path reaches the horizon, and the key of its last node in
    the printed form.
    """

    status: int
    expansions: int
    cost: float


@inlined
def depth_bonus(rules: np.void, excess: float, steps: int) -> float:
    """Seconds that each step ahead is expected to cost beyond its time.

    The excess of a known path over its bare time tells how crowded the route is. Since a part of
    it, `excess`, is expected of every other path, the search ignores most nodes that merely begin
    well.
    """
    if excess < np.inf:
        return float(max(rules["depth_bonus_s"], excess / steps))
    return float(rules["depth_bonus_s"])


@inlined
def _slot(workspace: Workspace, key: int) -> int:
    """Row of the table for a key, existing or new; -1 if the table is full."""
    size = len(workspace.table_key)
    stamp = workspace.stamp[0]
    h = (key * 0x9E3779B1) & (size - 1)
    for _ in range(size):
        if workspace.table_stamp[h] != stamp:
            workspace.table_stamp[h] = stamp
            workspace.table_key[h] = key
            workspace.table_worth[h] = np.inf
            return h
        if workspace.table_key[h] == key:
            return h
        h = (h + 1) & (size - 1)
    return -1


@inlined
def begin_search(task: Task, workspace: Workspace) -> None:
    """Make the start the first node of a search."""
    workspace.stamp[0] += 1
    _set_node(workspace, 0, task.x, task.y, task.vx, task.vy, task.x, task.y, 0.0)
    workspace.node_cell[0] = task.cell
    workspace.node_edge[0] = task.on_edges
    workspace.node_parent[0] = -1
    workspace.node_step[0] = 0


@borrowing
def lay_known(
    world: World,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    steps: int,
    workspace: Workspace,
) -> None:
    """Make the first `steps` of a path (K, 2), which are legal, the nodes after the start."""
    ds = world.step_s / SUB
    cell = task.cell
    vx, vy = task.vx, task.vy
    cost = 0.0
    edges = task.on_edges
    left_m = metres_left(potential, task, cell, task.x, task.y)
    for n in range(1, steps + 1):
        k = n * SUB
        parts = step_parts(world, potential, task, path, n - 1, cell, vx, vy, workspace.near)
        price = risk_price(task, (n - 1) * world.step_s, left_m) * ds
        cost += parts.seconds + parts.turning + parts.wall + price * (parts.soft + parts.risk)
        x, y = path[k, 0], path[k, 1]
        hx, hy = path[k - 1, 0], path[k - 1, 1]
        dx, dy = x - path[k - 2, 0], y - path[k - 2, 1]
        edges = count_edges(world.grid, potential, task, cell, parts.end, dx, dy, edges)
        cell = parts.end
        left_m = parts.left_m
        vx, vy = (x - hx) / ds, (y - hy) / ds
        _set_node(workspace, n, x, y, vx, vy, hx, hy, cost)
        workspace.node_cell[n] = cell
        workspace.node_edge[n] = edges
        workspace.node_parent[n] = n - 1
        workspace.node_step[n] = n
        workspace.worths[n] = cost + way_left(task, parts.left_m, length(vx, vy))


@inlined
def _set_node(
    workspace: Workspace,
    n: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    half_x: float,
    half_y: float,
    cost_s: float,
) -> None:
    new = workspace.node_state[n]
    new["x"] = x
    new["y"] = y
    new["vx"] = vx
    new["vy"] = vy
    new["cost_s"] = cost_s
    new["half_x"] = half_x
    new["half_y"] = half_y


@inlined
def search(
    world: World,
    potential: PotentialValues,
    moves: Moves,
    task: Task,
    accumulate: bool,
    bound: float,
    expected: float,
    begun: int,
    workspace: Workspace,
    path: NDArray[np.float64],
) -> Outcome:
    """Fill `path` (K, 2) with positions slice by slice, the start first: Lei & Li, fig. 5.

    With `accumulate` the key of a node is f = cost so far + cost left, where the cost is time plus
    prices of risk, turning, haste and walls; otherwise it is the printed U(q') = potential(q') +
    Risk(q'). Nodes that cannot end below `bound`, in seconds, are left out.

    The start is a node already (`begin_search`), and so are `begun` steps of a path that was known
    (`lay_known`). That path costs `expected` seconds, and inf if none was known.
    """
    grid = world.grid
    steps = (len(path) - 1) // SUB
    step_s = world.step_s
    ds = step_s / SUB
    need = needed_clearance(world, task)
    a_max = task.max_acceleration_mps2
    per_a = 1.0 / a_max
    most_m = task.max_speed_mps * step_s
    open_m = task.radius_m + task.wall_room_m + most_m + 1.5 * grid.layered.cell_m
    node = workspace.node_state
    near = workspace.near
    capacity = len(node)
    cells = len(grid.layered.floors)
    rules = world.rules[0]
    path[:, 0] = task.x
    path[:, 1] = task.y
    workspace.ends[:] = 0
    speed = length(task.vx, task.vy)
    start = way_left(task, metres_left(potential, task, task.cell, task.x, task.y), speed)
    if not np.isfinite(start):
        return Outcome(NO_PATH, 0, np.inf)
    # Without a legal path any will do: all of what the illegal one costs is expected.
    part = rules["likely_part"] if bound < np.inf else 1.0
    bonus = depth_bonus(rules, part * (expected - start), steps)
    size = heap_push(workspace.heap_keys, workspace.heap_items, 0, start, 0)
    for n in range(1, begun + 1):
        slot = _slot(workspace, n * cells + workspace.node_cell[n])
        workspace.table_worth[slot] = workspace.worths[n]
        key = workspace.worths[n] - bonus * n
        size = heap_push(workspace.heap_keys, workspace.heap_items, size, key, n)
    count = begun + 1
    expansions = 0
    best = 0
    best_step = 0
    best_key = np.inf
    status = NO_PATH
    while size > 0:
        key = workspace.heap_keys[0]
        n = workspace.heap_items[0]
        size = heap_pop(workspace.heap_keys, workspace.heap_items, size)
        step = workspace.node_step[n]
        cell = workspace.node_cell[n]
        x = node[n]["x"]
        y = node[n]["y"]
        vx = node[n]["vx"]
        vy = node[n]["vy"]
        if n > 0 and accumulate:
            slot = _slot(workspace, step * cells + cell)
            if slot < 0 or workspace.table_worth[slot] < key + bonus * step - 1e-9:
                continue
        if step > best_step or (step == best_step and key < best_key):
            best = n
            best_step = step
            best_key = key
        away = metres_left(potential, task, cell, x, y)
        at_goal = away <= task.goal_tolerance_m
        if step == steps or (at_goal and not accumulate and not task.hold):
            best = n
            best_step = step
            best_key = key
            status = FOUND
            break
        if expansions == task.max_expansions:
            status = PARTIAL
            break
        workspace.node_order[n] = expansions
        expansions += 1
        gx, gy, leg = direction_at(grid, potential, cell, x, y)
        if task.hold:
            gx = task.goal_x - x
            gy = task.goal_y - y
            leg = away
            if leg > 1e-9:
                gx /= leg
                gy /= leg
        if not moves.relative or leg <= 1e-9:
            gx = 1.0
            gy = 0.0
        price = risk_price(task, step * step_s, away) * ds
        k = step * SUB
        counts = NOT_COUNTED
        before_x = vx if n == 0 else (x - node[n]["half_x"]) / ds
        before_y = vy if n == 0 else (y - node[n]["half_y"]) / ds
        # Clearance falls by no more than the distance: far from walls no child is checked.
        in_the_open = clearance_at(grid, task.body, cell, x, y) >= open_m
        # The rest of the path is expected to cost as much beyond its time as the known path.
        room_s = bound - bonus * (steps - step - 1) if accumulate else bound
        branches = workspace.branches
        last = len(moves.speeds) if step < rules["fine_steps"] else moves.coarse
        branch_out(
            moves, last, per_a, step_s, ds, gx, gy, away, x, y, vx, vy, before_x, before_y, branches
        )
        look_up(grid, potential, task, cell, branches, last, workspace.branch_cells)
        for m in range(last + 1):
            hx = branches[HALF_X, m]
            hy = branches[HALF_Y, m]
            ex = branches[X, m]
            ey = branches[Y, m]
            half = workspace.branch_cells[0, m]
            end = workspace.branch_cells[1, m]
            left_m = branches[LEFT, m]
            left = way_left(task, left_m, branches[SPEED, m] if accumulate else task.speed_mps)
            seconds, turning = motion_cost(
                task, left_m, branches[STRIDE, m], branches[TURNED, m], step_s
            )
            cost = node[n]["cost_s"] + seconds + turning
            if not cost + left < room_s or end < 0:
                continue
            edge = count_edges(
                grid, potential, task, cell, end, ex - x, ey - y, workspace.node_edge[n]
            )
            if edge == TOO_MANY:
                continue
            slot = _slot(workspace, (step + 1) * cells + end)
            if slot < 0:
                continue
            least = workspace.table_worth[slot] - 1e-12
            if accumulate and cost + left >= least:
                continue
            if grid.flat:
                half = follow(grid, cell, hx, hy)
                if half < 0:  # bounds without a wall do not show in the clearance
                    continue
            if not in_the_open:
                room = min(
                    clearance_at(grid, task.body, half, hx, hy),
                    clearance_at(grid, task.body, end, ex, ey),
                )
                if room < need:
                    continue
                cost += wall_cost(task, room, step_s)
            worth = cost + left if accumulate else 0.0
            if worth >= least:
                continue
            # Risk is never negative, so a node that already costs too much is given up at once.
            most = (min(room_s, least) - worth) / price if accumulate and price > 0.0 else np.inf
            if counts.met < 0:  # most nodes of a good path have no child that comes so far
                counts = look_around(world, task, k, cell, x, y, length(vx, vy), near)
            blocked, soft = others_weight(world, task, near, counts, k, x, y, hx, hy, ex, ey)
            if blocked or soft >= most:
                continue
            risk = people_risk(
                world,
                task,
                near,
                counts,
                k,
                hx,
                hy,
                ex,
                ey,
                (hx - x) / ds,
                (hy - y) / ds,
                (ex - hx) / ds,
                (ey - hy) / ds,
                most - soft,
            )
            if risk == np.inf:
                continue
            minded = soft + risk
            if accumulate:
                cost += price * minded
                worth += price * minded
                key = worth - bonus * (step + 1)
            else:
                key = left + price * minded
            if count == capacity:
                continue
            workspace.table_worth[slot] = worth
            _set_node(workspace, count, ex, ey, branches[VX, m], branches[VY, m], hx, hy, cost)
            workspace.node_cell[count] = end
            workspace.node_edge[count] = edge
            workspace.node_parent[count] = n
            workspace.node_step[count] = step + 1
            size = heap_push(workspace.heap_keys, workspace.heap_items, size, key, count)
            count += 1
    if status == NO_PATH and best_step > 0:
        status = PARTIAL
    workspace.ends[0] = count
    workspace.ends[1] = size
    workspace.ends[2] = best
    _trace(workspace, best, path)
    return Outcome(status, expansions, best_key + bonus * best_step if accumulate else best_key)


@inlined
def _trace(workspace: Workspace, last: int, path: NDArray[np.float64]) -> None:
    """Write the path to a node; after the node it stays at the node's position."""
    k = workspace.node_step[last] * SUB
    node = workspace.node_state
    path[k:, 0] = node[last]["x"]
    path[k:, 1] = node[last]["y"]
    n = last
    while workspace.node_parent[n] >= 0:
        k = workspace.node_step[n] * SUB
        path[k, 0] = node[n]["x"]
        path[k, 1] = node[n]["y"]
        path[k - 1, 0] = node[n]["half_x"]
        path[k - 1, 1] = node[n]["half_y"]
        n = workspace.node_parent[n]
