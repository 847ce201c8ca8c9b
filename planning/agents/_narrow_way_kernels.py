"""Ways of agents through passages hardly wider than they are, on bare arrays.

Each move of the search is straight and some decimetres long, and no move of that length may get an
agent into a narrow passage that it comes to obliquely, or around a bend of a corridor. Where its
path leads nowhere, and where an agent stands that wants to walk, the way over anchors is weighed
against the path, by the same cost.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._cost_kernels import room_for_near
from esplanade.planning.agents._perturb_kernels import path_cost, stretch_edges
from esplanade.planning.agents._step_kernels import control_toward
from esplanade.planning.agents._task_kernels import SUB, TOO_MANY, Task, World, needed_clearance
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import follow_path, length
from esplanade.planning.routes._anchor_way_kernels import anchors_ahead, leads_exactly
from esplanade.planning.routes._potential_kernels import PotentialValues, potential_at

_MOST_POINTS = 24
"""Points that are looked ahead over: some three metres."""
_LESS_M = 0.015
"""A line of sight may pass barriers by this much too closely: the body slides along them."""
_REACHED_M = 0.01
"""An agent so near to a point of its way goes on to the next."""


@inlined
def _stands(world: World, task: Task) -> bool:
    return bool(length(task.vx, task.vy) < world.rules[0]["stands_mps"])


@inlined
def leads_nowhere(
    world: World,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    cells: NDArray[np.int64],
) -> bool:
    """Whether an agent stands, or a path (K, 2) hardly brings it nearer to its goal.

    `cells` (K,) is room. It is false for an agent that stays around, or that no path leads to.
    """
    left_m = potential_at(potential, task.cell, task.x, task.y)
    if task.hold or not np.isfinite(left_m):
        return False
    if _stands(world, task):
        return True
    last = len(path) - 1
    far_m = task.speed_mps * last * world.step_s / SUB
    if length(path[last, 0] - task.x, path[last, 1] - task.y) >= 0.5 * far_m:
        return False
    cells[0] = task.cell
    follow_path(world.grid, path, cells, 0, last)
    then_m = potential_at(potential, cells[last], path[last, 0], path[last, 1])
    return bool(not left_m - then_m >= world.rules[0]["narrow_part"] * min(left_m, far_m))


@kernel
def lead_over_anchors(
    world: World,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    out: NDArray[np.float64],
) -> tuple[bool, float, float]:
    """Fill `out` (K, 2) with a path over anchors; whether it is better than a given path (K, 2).

    If so, the velocity to aim at is returned too: it leads straight to the first point of the way
    that cannot be cut short.
    """
    rules = world.rules[0]
    points = np.empty((_MOST_POINTS, 2))
    cells = np.empty(_MOST_POINTS, dtype=np.int64)
    count, _ = anchors_ahead(world.grid, potential, task.body, task.cell, points, cells)
    if count == 0:
        return False, 0.0, 0.0
    first = _first_to_go_to(world, task, points, count)
    slice_m = rules["narrow_pace"] * task.speed_mps * world.step_s / SUB
    _walk_along(task.x, task.y, points[first:count], slice_m, out)
    need = needed_clearance(world, task) - _LESS_M
    last = len(path) - 1
    edges = stretch_edges(world, potential, task, need, task.cell, task.on_edges, out, 0, last)
    if edges == TOO_MANY:
        return False, 0.0, 0.0
    near = room_for_near()
    most_s = path_cost(world, potential, task, path, near).seconds
    if _stands(world, task):
        most_s += rules["narrow_over_s"]
    if not path_cost(world, potential, task, out, near).seconds < most_s:
        return False, 0.0, 0.0
    px, py = points[first]
    away = length(px - task.x, py - task.y)
    if away <= SUB * slice_m:
        seconds = max(away / (SUB * slice_m), 0.1) * world.step_s
        ux, uy = control_toward(task, px, py, seconds)
    else:
        ux, uy = control_toward(task, out[SUB, 0], out[SUB, 1], world.step_s)
    return True, ux, uy


@kernel
def _first_to_go_to(world: World, task: Task, points: NDArray[np.float64], count: int) -> int:
    """The furthest of the points ahead that an agent may go to straight; the first without any."""
    for k in range(count - 1, 0, -1):
        px, py = points[k]
        if leads_exactly(world.grid, task.body, task.cell, task.x, task.y, px, py, _LESS_M):
            return k
    if count > 1 and length(points[0, 0] - task.x, points[0, 1] - task.y) < _REACHED_M:
        return 1
    return 0


@kernel
def _walk_along(
    x: float, y: float, points: NDArray[np.float64], slice_m: float, path: NDArray[np.float64]
) -> None:
    """Write places (K, 2), `slice_m` apart, on the way from a place over points (N, 2)."""
    path[0, 0] = x
    path[0, 1] = y
    n = 0
    for k in range(1, len(path)):
        room = slice_m
        while n < len(points):
            away = length(points[n, 0] - x, points[n, 1] - y)
            if away > room:
                x += (points[n, 0] - x) * room / away
                y += (points[n, 1] - y) * room / away
                break
            room -= away
            x = points[n, 0]
            y = points[n, 1]
            n += 1
        path[k, 0] = x
        path[k, 1] = y
