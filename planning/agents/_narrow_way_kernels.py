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
from esplanade.planning.agents._task_kernels import (
    SUB,
    TOO_MANY,
    Task,
    World,
    further_on_edges,
    needed_clearance,
)
from esplanade.planning.agents.agents import Agents
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import (
    GridArrays,
    anchor_at,
    follow,
    follow_path,
    length,
)
from esplanade.planning.routes._anchor_way_kernels import anchors_ahead, leads_exactly
from esplanade.planning.routes._legal_way_kernels import legal_ahead
from esplanade.planning.routes._potential_kernels import EDGES, PotentialValues, potential_at

_MOST_POINTS = 24
"""Points that are looked ahead over: some three metres."""
_LESS_M = 0.015
"""A line of sight may pass barriers by this much too closely: the body slides along them."""
_HELD_UP_M = 0.001
"""A body that barriers hold up is nearer to them than allowed, by no more than this."""
_RINGS = 3
_MOST_NEAR = (2 * _RINGS + 1) ** 2
"""A way begins at an anchor no further away than so many cells."""
_BRAKING_SLICES = 5
"""An agent slows down within so many slices from where a way over edges turns."""
_EVERY = 2
"""Every such slice of a path is looked at for edges."""
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
    held: bool,
) -> bool:
    """Whether an agent stands, has been held up for a while, or a path (K, 2) hardly brings it
    nearer to its goal.

    `cells` (K,) is room. It is false for an agent that stays around, or that no path leads to.
    """
    left_m = potential_at(potential, task.cell, task.x, task.y)
    if task.hold or not np.isfinite(left_m):
        return False
    if held or _stands(world, task):
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
def is_held_alone(world: World, agents: Agents, me: int, stalled_s: float) -> bool:
    """Whether an agent has come no nearer to its goal for a while, and no other one is near.

    It may have slid into a gap that is just too narrow. O(agents), for those who are held up.
    """
    rules = world.rules[0]
    if stalled_s < rules["narrow_held_s"]:
        return False
    x, y = agents.positions[me]
    for other in range(len(agents.positions)):
        ox, oy = agents.positions[other]
        if other != me and length(ox - x, oy - y) < rules["narrow_alone_m"]:
            return False
    return True


@kernel
def leads_over_edges(
    world: World, potential: PotentialValues, task: Task, path: NDArray[np.float64]
) -> bool:
    """Whether an agent is on edges whose cells are counted, or its path (K, 2) leads over some."""
    if world.grid.flat or task.hold or task.cell < 0:
        return False
    cell = task.cell
    for k in range(0, len(path), _EVERY):
        cell = follow(world.grid, cell, path[k, 0], path[k, 1])
        if cell < 0:
            return False
        if potential[cell, EDGES] > 0.0:
            return True
    return False


@kernel
def lead_over_anchors(
    world: World,
    potential: PotentialValues,
    task: Task,
    most_edges: float,
    path: NDArray[np.float64],
    out: NDArray[np.float64],
    held: bool,
) -> tuple[bool, float, float]:
    """Fill `out` (K, 2) with a path over anchors; whether it is better than a given path (K, 2).

    If so, the velocity to aim at is returned too: it leads straight to the first point of the way
    that cannot be cut short. Where cells on edges are counted, the way has fewer than `most_edges`,
    and is better if nobody is nearer to it. For an agent that is `held` up by barriers alone, lines
    are exact, and the way is better if nobody is near: the given path is not gone at all.
    """
    rules = world.rules[0]
    points = np.empty((_MOST_POINTS, 2))
    cells = np.empty(_MOST_POINTS, dtype=np.int64)
    begin = _cell_to_begin_at(world, potential, task) if held else task.cell
    count, _ = anchors_ahead(world.grid, potential, task.body, begin, points, cells)
    counts = np.zeros(_MOST_POINTS)
    counted = False
    for cell in cells[:count]:
        counted = counted or (cell >= 0 and potential[cell, EDGES] > 0.0)
    if counted:
        count = legal_ahead(
            world.grid,
            potential,
            task.body,
            task.cell,
            task.on_edges,
            most_edges,
            points,
            cells,
            counts,
        )
    if count == 0:
        return False, 0.0, 0.0
    slice_m = rules["narrow_pace"] * task.speed_mps * world.step_s / SUB
    need = needed_clearance(world, task) - _LESS_M
    last = len(path) - 1
    nearest = 0
    if count > 1 and length(points[0, 0] - task.x, points[0, 1] - task.y) < _REACHED_M:
        nearest = 1
    first = count
    edges = TOO_MANY
    while edges == TOO_MANY and first > nearest and (counted or first == count):
        first = _last_to_go_to(world, task, points, counts, counted, nearest, first, held)
        if counted:
            slice_m = _slice_toward(world, task, points[first])
        _walk_along(task.x, task.y, points[first:count], slice_m, out)
        edges = stretch_edges(world, potential, task, need, task.cell, task.on_edges, out, 0, last)
    if edges == TOO_MANY:
        return False, 0.0, 0.0
    near = room_for_near()
    most = path_cost(world, potential, task, path, near)
    most_s = most.seconds
    if _stands(world, task):
        most_s += rules["narrow_over_s"]
    cost = path_cost(world, potential, task, out, near)
    # The potential ahead of the given path does not know how long the agent was on edges.
    calm = counted and cost.mean_risk <= most.mean_risk + rules["least_risk"]
    calm = calm or (held and max(cost.mean_risk, most.mean_risk) <= rules["least_risk"])
    if not (cost.seconds < most_s or calm):
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
def _goes_to(world: World, task: Task, x: float, y: float, less_m: float) -> bool:
    """Whether barriers let an agent go straight to a point, if it is smaller by `less_m`."""
    return bool(leads_exactly(world.grid, task.body, task.cell, task.x, task.y, x, y, less_m))


@kernel
def _cell_to_begin_at(world: World, potential: PotentialValues, task: Task) -> int:
    """The cell over whose anchor a way to the goal begins for an agent: its own, if it gets there.

    A point of a cell may be cut off from the cell's anchor by a gap that is just too narrow. From
    there the way begins at the anchor near by, of those that the agent gets to, from which the goal
    is nearest; without any it is that of its own cell.
    """
    ax, ay = anchor_at(world.grid, task.body, task.cell)
    if _goes_to(world, task, ax, ay, _HELD_UP_M):
        return task.cell
    links = world.grid.layered.links
    seen = np.empty(_MOST_NEAR, dtype=np.int64)
    seen[0] = task.cell
    first, last = 0, 1
    best = task.cell
    least_m = np.inf
    for _ in range(_RINGS):
        end = last
        for k in range(first, last):
            for direction in range(8):
                other = links[seen[k], direction]
                known = other < 0 or end == _MOST_NEAR
                for j in range(end):
                    known = known or seen[j] == other
                if known:
                    continue
                seen[end] = other
                end += 1
                ax, ay = anchor_at(world.grid, task.body, other)
                left_m = potential_at(potential, other, ax, ay)
                left_m += length(ax - task.x, ay - task.y)
                if left_m < least_m and _goes_to(world, task, ax, ay, _HELD_UP_M):
                    best = other
                    least_m = left_m
        first, last = last, end
    return best


@inlined
def _slice_toward(world: World, task: Task, point: NDArray[np.float64]) -> float:
    """Metres that an agent goes in a slice to a point, at which it may have to turn sharply."""
    full_m = task.speed_mps * world.step_s / SUB
    if length(point[0] - task.x, point[1] - task.y) > _BRAKING_SLICES * full_m:
        return full_m
    return float(world.rules[0]["narrow_pace"] * full_m)


@kernel
def _last_to_go_to(
    world: World,
    task: Task,
    points: NDArray[np.float64],
    counts: NDArray[np.float64],
    counted: bool,
    nearest: int,
    end: int,
    exactly: bool,
) -> int:
    """The furthest point before `end` that an agent may go to straight; `nearest` without any.

    If cells on edges are `counted`, it may have come no further on them than by the way.
    """
    less_m = _HELD_UP_M if exactly else _LESS_M
    for k in range(end - 1, nearest, -1):
        px, py = points[k]
        if _goes_to(world, task, px, py, less_m) and not (
            counted and _exceeds(world.grid, task, px, py, counts[: k + 1])
        ):
            return k
    return nearest


@kernel
def _exceeds(
    grid: GridArrays, task: Task, px: float, py: float, counts: NDArray[np.float64]
) -> bool:
    """Whether an agent that goes straight to a point comes further on edges than the way to it.

    `counts` (K,) are the cells on edges in a row on the way, the last of them at the point.
    """
    most = counts.max()
    edges = task.on_edges
    cell = task.cell
    way = length(px - task.x, py - task.y)
    pieces = int(way / (0.5 * grid.layered.cell_m)) + 1
    dx, dy = (px - task.x) / pieces, (py - task.y) / pieces
    for k in range(1, pieces + 1):
        there = follow(grid, cell, task.x + k * dx, task.y + k * dy)
        edges = further_on_edges(grid, task.body, cell, there, dx, dy, edges)
        if there < 0 or edges > most:
            return True
        cell = there
    return bool(edges > counts[-1])


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
