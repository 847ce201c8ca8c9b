"""Costs of a whole path and its recursive perturbation, Lei & Li, figs. 7-9, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from planning._grid_kernels import clearance_at
from planning._jit import kernel
from planning._potential_kernels import Guide, potential_at
from planning._reservation_kernels import conflict
from planning._risk_kernels import risk_at
from planning._search_kernels import (
    SUB,
    Task,
    World,
    needed_clearance,
    risk_price,
    time_cost,
    wall_cost,
    way_left,
)

SHORTEST_STRETCH = 4
"""Stretches of fewer slices are not split further."""
OFFSETS = 3
"""Candidates m' on either side of the middle."""
OFFSET_M = 0.2
"""Distance between candidates, metres."""


@kernel
def slice_risk(
    world: World, task: Task, k: int, ax: float, ay: float, bx: float, by: float
) -> float:
    """Risk at b, slice k, having come from a in one slice."""
    ds = world.step_s / SUB
    return risk_at(
        world.grid,
        world.fields,
        k,
        task.layer,
        bx,
        by,
        (bx - ax) / ds,
        (by - ay) / ds,
        task.closing_weight,
    )


@kernel
def average_risk(
    world: World, task: Task, path: NDArray[np.float64], first: int, last: int
) -> float:
    """Mean risk of the slices first + 1 ... last."""
    total = 0.0
    for k in range(first + 1, last + 1):
        total += slice_risk(world, task, k, path[k - 1, 0], path[k - 1, 1], path[k, 0], path[k, 1])
    return total / (last - first)


@kernel
def stretch_is_legal(
    world: World,
    guide: Guide,
    task: Task,
    need: float,
    path: NDArray[np.float64],
    first: int,
    last: int,
) -> bool:
    """Free of walls, within the speed limit, clear of certain obstacles, with a way to the goal."""
    ds = world.step_s / SUB
    for k in range(first, last):
        ax = path[k, 0]
        ay = path[k, 1]
        bx = path[k + 1, 0]
        by = path[k + 1, 1]
        if np.hypot(bx - ax, by - ay) > task.max_speed_mps * ds + 1e-9:
            return False
        if clearance_at(world.grid, task.layer, bx, by) < need:
            return False
        if not task.hold and not np.isfinite(potential_at(world.grid, guide, task.layer, bx, by)):
            return False
        if conflict(world.reservations, task.me, task.layer, k, ax, ay, bx, by)[0]:
            return False
    return True


@kernel
def path_cost(
    world: World, guide: Guide, task: Task, path: NDArray[np.float64]
) -> tuple[float, float]:
    """Cost of a whole path as the search counts it (its length and time among it), mean risk."""
    ds = world.step_s / SUB
    slices = len(path) - 1
    vx = task.vx
    vy = task.vy
    cost = 0.0
    risk = 0.0
    for k in range(slices):
        ax = path[k, 0]
        ay = path[k, 1]
        bx = path[k + 1, 0]
        by = path[k + 1, 1]
        moved = np.hypot(bx - ax, by - ay)
        ux = (bx - ax) / ds
        uy = (by - ay) / ds
        r = slice_risk(world, task, k + 1, ax, ay, bx, by)
        soft = conflict(world.reservations, task.me, task.layer, k, ax, ay, bx, by)[1]
        risk += r
        cost += (
            time_cost(task, bx, by, moved / ds, ds)
            + risk_price(task, (k // SUB) * world.step_s) * ds * (r + soft)
            + task.turn_weight * np.hypot(ux - vx, uy - vy)
            + wall_cost(task, clearance_at(world.grid, task.layer, bx, by), ds)
        )
        vx = ux
        vy = uy
    x = path[slices, 0]
    y = path[slices, 1]
    cost += way_left(world, guide, task, task.layer, x, y, np.hypot(vx, vy))
    return cost, risk / slices


@kernel
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


@kernel
def perturb_path(
    world: World,
    guide: Guide,
    task: Task,
    need: float,
    path: NDArray[np.float64],
    first: int,
    last: int,
    trial: NDArray[np.float64],
) -> bool:
    """Replace a stretch by the first bend that is legal and strictly less risky; fig. 8.

    Candidates lie on the normal through the chord's midpoint, nearest first, either side in turn.
    The printed test accepts equal risk too, with which the recursion need not settle.
    """
    risk = average_risk(world, task, path, first, last)
    if risk <= 1e-9:
        return False
    cx = path[last, 0] - path[first, 0]
    cy = path[last, 1] - path[first, 1]
    chord = np.hypot(cx, cy)
    if chord < 1e-6:
        return False
    middle = (first + last) // 2
    for n in range(2 * OFFSETS):
        offset = OFFSET_M * (n // 2 + 1) * (1.0 if n % 2 == 0 else -1.0)
        mx = path[first, 0] + 0.5 * cx - offset * cy / chord
        my = path[first, 1] + 0.5 * cy + offset * cx / chord
        _bend(path, trial, first, middle, last, mx, my)
        if average_risk(world, task, trial, first, last) < risk - 1e-9 and stretch_is_legal(
            world, guide, task, need, trial, first, last
        ):
            path[first : last + 1] = trial[first : last + 1]
            return True
    return False


@kernel
def _arrival(task: Task, path: NDArray[np.float64]) -> int:
    """Slice at which a path arrives at the goal, its last if it does not."""
    last = len(path) - 1
    if not task.hold:
        for k in range(1, last):
            away = np.hypot(path[k, 0] - task.goal_x, path[k, 1] - task.goal_y)
            if away <= task.goal_tolerance_m:
                return k
    return last


@kernel
def update_path(
    world: World,
    guide: Guide,
    task: Task,
    path: NDArray[np.float64],
    trial: NDArray[np.float64],
) -> int:
    """Fig. 7: perturb the whole path, else its halves, and so on; returns how many bends held.

    The recursion is a stack of stretches; the earlier half comes first, as printed. What lies
    after the arrival at the goal is left alone: a bend over it would arrive later and later.
    """
    need = needed_clearance(world, task)
    stack = np.empty((64, 2), dtype=np.int64)
    stack[0, 0] = 0
    stack[0, 1] = _arrival(task, path)
    height = 1
    bends = 0
    while height > 0:
        height -= 1
        first = stack[height, 0]
        last = stack[height, 1]
        if perturb_path(world, guide, task, need, path, first, last, trial):
            bends += 1
        elif last - first >= SHORTEST_STRETCH:
            middle = (first + last) // 2
            stack[height, 0] = middle
            stack[height, 1] = last
            stack[height + 1, 0] = first
            stack[height + 1, 1] = middle
            height += 2
    return bends
