"""Costs of a whole path and its recursive perturbation, Lei & Li, figs. 7-9, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._cost_kernels import Near, step_parts
from esplanade.planning.agents._reservation_kernels import conflict
from esplanade.planning.agents._task_kernels import (
    SUB,
    TOO_MANY,
    Task,
    World,
    count_edges,
    is_there,
    metres_left,
    needed_clearance,
    risk_price,
    way_left,
)
from esplanade.planning.compiled.jit import borrowing, inlined, kernel
from esplanade.planning.grid._grid_kernels import (
    GridArrays,
    clearance_at,
    floor_of,
    follow,
    follow_path,
    length,
)
from esplanade.planning.people._risk_kernels import risk_at
from esplanade.planning.routes._potential_kernels import PotentialValues, potential_at

_MOST_EDGES = 1e9


class PathCost(NamedTuple):
    """The cost of a whole path."""

    seconds: float
    mean_risk: float
    legal: bool
    """Whether all of it is legal, as `stretch_edges` says of a stretch."""
    legal_steps: int
    """The number of steps before the first that is not."""


class PerturbationRoom(NamedTuple):
    """Room for perturbing a path of K slices."""

    cells: NDArray[np.int64]
    """(K,): the cells that the path is in."""
    risks: NDArray[np.float64]
    """(K,): its risks."""
    trial: NDArray[np.float64]
    """(K, 2): a bend."""
    trial_risks: NDArray[np.float64]
    stretches: NDArray[np.int64]
    """(S, 2): the first and the last slice of each stretch that is still to be looked at."""


@kernel
def room_to_perturb(slices: int) -> PerturbationRoom:
    """Room for perturbing paths of so many slices."""
    return PerturbationRoom(
        np.empty(slices, dtype=np.int64),
        np.empty(slices),
        np.empty((slices, 2)),
        np.empty(slices),
        np.empty((64, 2), dtype=np.int64),
    )


@inlined
def slice_risk(
    world: World, task: Task, k: int, cell: int, ax: float, ay: float, bx: float, by: float
) -> float:
    """Risk at b, in a cell, slice k, having come from a in one slice; none where nobody stands."""
    if cell < 0:
        return 0.0
    ds = world.step_s / SUB
    return risk_at(
        world.grid,
        world.risk,
        task.contact,
        k,
        cell,
        bx,
        by,
        (bx - ax) / ds,
        (by - ay) / ds,
        task.closing_weight,
    )


@inlined
def risks_along(
    world: World,
    task: Task,
    cell: int,
    path: NDArray[np.float64],
    first: int,
    last: int,
    most: float,
    out: NDArray[np.float64],
) -> bool:
    """Fill `out` (K,) with the risks of slices first + 1 ... last; False if their sum is not below
    `most`, beyond which they are not asked.

    The path is in `cell` at slice first.
    """
    total = 0.0
    for k in range(first + 1, last + 1):
        x = path[k, 0]
        y = path[k, 1]
        cell = follow(world.grid, cell, x, y)
        out[k] = slice_risk(world, task, k, cell, path[k - 1, 0], path[k - 1, 1], x, y)
        total += out[k]
        if total >= most:
            return False
    return True


@inlined
def _may_go(task: Task, need: float, moved: float, room: float, left_m: float, ds: float) -> bool:
    """Whether a slice is free of walls, within the speed limit, with a path to the goal."""
    return (
        moved <= task.max_speed_mps * ds + 1e-9
        and room >= need
        and bool(task.hold or np.isfinite(left_m))
    )


@inlined
def _edges_at(
    grid: GridArrays,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    cells: NDArray[np.int64],
    slice_: int,
) -> float:
    """The way on edges, in cells, at a slice of a path that is in `cells` (K,)."""
    edges = task.on_edges
    if not grid.flat:
        for k in range(slice_):
            dx = path[k + 1, 0] - path[k, 0]
            dy = path[k + 1, 1] - path[k, 1]
            edges = count_edges(grid, potential, task, cells[k], cells[k + 1], dx, dy, edges)
            if edges == TOO_MANY:
                return TOO_MANY
    return edges


@inlined
def stretch_edges(
    world: World,
    potential: PotentialValues,
    task: Task,
    need: float,
    cell: int,
    edges: float,
    path: NDArray[np.float64],
    first: int,
    last: int,
) -> float:
    """The way on edges, in cells, at the end of a stretch of a path; `TOO_MANY` if it is illegal.

    It is legal if it keeps clear of walls and of certain obstacles, keeps the limits of speed and
    of cells on edges, and the goal can be reached from all of it. The path is in `cell` at slice
    first, after a way on edges of `edges` cells.
    """
    grid = world.grid
    ds = world.step_s / SUB
    for k in range(first, last):
        ax = path[k, 0]
        ay = path[k, 1]
        bx = path[k + 1, 0]
        by = path[k + 1, 1]
        moved = length(bx - ax, by - ay)
        feet_m = floor_of(grid, cell)
        before = cell
        cell = follow(grid, cell, bx, by)
        room = clearance_at(grid, task.body, cell, bx, by)
        if not _may_go(task, need, moved, room, potential_at(potential, cell, bx, by), ds):
            return TOO_MANY
        edges = count_edges(grid, potential, task, before, cell, bx - ax, by - ay, edges)
        if edges == TOO_MANY:
            return TOO_MANY
        if conflict(world.reservations, task.me, feet_m, k, ax, ay, bx, by)[0]:
            return TOO_MANY
    return edges


@borrowing
def path_cost(
    world: World, potential: PotentialValues, task: Task, path: NDArray[np.float64], near: Near
) -> PathCost:
    """Cost of a whole path; `near` is room.

    It is that of its steps, and of the way that is left: for the same path it is what the search
    adds up.
    """
    grid = world.grid
    need = needed_clearance(world, task)
    ds = world.step_s / SUB
    cell = task.cell
    vx = task.vx
    vy = task.vy
    cost = 0.0
    risk = 0.0
    left_m = metres_left(potential, task, cell, task.x, task.y)
    edges = task.on_edges
    legal_steps = 0
    steps = (len(path) - 1) // SUB
    for step in range(steps):
        k = step * SUB
        parts = step_parts(world, potential, task, path, step, cell, vx, vy, near)
        price = risk_price(task, step * world.step_s, left_m) * ds
        cost += parts.seconds + parts.turning + parts.wall + price * (parts.soft + parts.risk)
        risk += parts.risk
        left_m = parts.left_m
        half_x = path[k + 1, 0] - path[k, 0]
        half_y = path[k + 1, 1] - path[k, 1]
        end_x = path[k + 2, 0] - path[k + 1, 0]
        end_y = path[k + 2, 1] - path[k + 1, 1]
        half_m = metres_left(potential, task, parts.half, path[k + 1, 0], path[k + 1, 1])
        edges = count_edges(grid, potential, task, cell, parts.half, half_x, half_y, edges)
        if edges != TOO_MANY:
            edges = count_edges(grid, potential, task, parts.half, parts.end, end_x, end_y, edges)
        if (
            legal_steps == step
            and edges != TOO_MANY
            and not parts.blocked
            and _may_go(task, need, length(half_x, half_y), parts.half_room, half_m, ds)
            and _may_go(task, need, length(end_x, end_y), parts.end_room, left_m, ds)
        ):
            legal_steps += 1
        cell = parts.end
        vx = end_x / ds
        vy = end_y / ds
    cost += way_left(task, left_m, length(vx, vy))
    return PathCost(cost, risk / (steps * SUB), legal_steps == steps, legal_steps)


@inlined
def _bend(
    old: NDArray[np.float64],
    new: NDArray[np.float64],
    first: int,
    middle: int,
    last: int,
    mx: float,
    my: float,
) -> None:
    """Write P[first]-m' and m'-P[last], evenly in space and time, into `new`."""
    for k in range(first, last + 1):
        if k <= middle:
            u = (k - first) / (middle - first)
            new[k, 0] = (1.0 - u) * old[first, 0] + u * mx
            new[k, 1] = (1.0 - u) * old[first, 1] + u * my
        else:
            u = (k - middle) / (last - middle)
            new[k, 0] = (1.0 - u) * mx + u * old[last, 0]
            new[k, 1] = (1.0 - u) * my + u * old[last, 1]


@inlined
def perturb_path(
    world: World,
    potential: PotentialValues,
    task: Task,
    need: float,
    path: NDArray[np.float64],
    first: int,
    last: int,
    room: PerturbationRoom,
) -> bool:
    """Replace a stretch by the first bend that is legal and less risky by `least_risk`; fig. 8.

    Candidates lie on the normal through the chord's midpoint, nearest first, either side in turn.
    The printed test accepts equal risk too, with which the recursion need not settle. The cells
    and risks of `room` are those of the path.
    """
    rules = world.rules[0]
    cells, risks, trial = room.cells, room.risks, room.trial
    if last - first < 2:  # there is nothing between its ends
        return False
    begin = cells[first]
    total = 0.0
    for k in range(first + 1, last + 1):
        total += risks[k]
    least = (last - first) * rules["least_risk"]
    if total <= least:
        return False
    cx = path[last, 0] - path[first, 0]
    cy = path[last, 1] - path[first, 1]
    chord = np.hypot(cx, cy)
    if chord < 1e-6:
        return False
    middle = (first + last) // 2
    edges = _edges_at(world.grid, potential, task, path, cells, first)
    most_edges = _edges_at(world.grid, potential, task, path, cells, last)
    for n in range(2 * rules["offsets"]):
        offset = rules["offset_m"] * (n // 2 + 1) * (1.0 if n % 2 == 0 else -1.0)
        mx = path[first, 0] + 0.5 * cx - offset * cy / chord
        my = path[first, 1] + 0.5 * cy + offset * cx / chord
        _bend(path, trial, first, middle, last, mx, my)
        if risks_along(
            world, task, begin, trial, first, last, total - least, room.trial_risks
        ) and stretch_edges(world, potential, task, need, begin, edges, trial, first, last) <= min(
            most_edges + 1.0, _MOST_EDGES
        ):
            for k in range(first + 1, last + 1):
                risks[k] = room.trial_risks[k]
                path[k, 0] = trial[k, 0]
                path[k, 1] = trial[k, 1]
            follow_path(world.grid, path, cells, first, last)
            return True
    return False


@inlined
def _arrival(
    potential: PotentialValues, task: Task, path: NDArray[np.float64], cells: NDArray[np.int64]
) -> int:
    """Slice at which a path arrives at the goal, its last if it does not."""
    last = len(path) - 1
    if not task.hold:
        for k in range(1, last):
            left_m = metres_left(potential, task, cells[k], path[k, 0], path[k, 1])
            if is_there(task, left_m):
                return k
    return last


@borrowing
def update_path(
    world: World,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    room: PerturbationRoom,
) -> int:
    """Fig. 7: perturb the whole path, else its halves, and so on; returns how many bends held.

    The recursion is a stack of stretches; the earlier half comes first, as printed. The
    stretch after the arrival at the goal is left alone: a bend over it would arrive later and
    later.
    """
    cells, stack = room.cells, room.stretches
    cells[0] = task.cell
    follow_path(world.grid, path, cells, 0, len(path) - 1)
    need = needed_clearance(world, task)
    risks_along(world, task, task.cell, path, 0, len(path) - 1, np.inf, room.risks)
    stack[0, 0] = 0
    stack[0, 1] = _arrival(potential, task, path, cells)
    height = 1
    bends = 0
    while height > 0:
        height -= 1
        first = stack[height, 0]
        last = stack[height, 1]
        if perturb_path(world, potential, task, need, path, first, last, room):
            bends += 1
        elif last - first >= world.rules[0]["shortest_stretch"]:
            middle = (first + last) // 2
            stack[height, 0] = middle
            stack[height, 1] = last
            stack[height + 1, 0] = first
            stack[height + 1, 1] = middle
            height += 2
    return bends
