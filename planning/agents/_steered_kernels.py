"""Agents whose velocity is decided elsewhere, on bare arrays: they plan nothing."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._search_kernels import FOUND
from esplanade.planning.agents._step_kernels import limited
from esplanade.planning.agents._task_kernels import SUB, Task, World
from esplanade.planning.agents.agents import ARRIVED, BLOCKED, MOVING, WAITING, Agents, Decisions
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import clearance_at, follow, length
from esplanade.planning.routes._potential_kernels import potential_at


@kernel
def steer(
    world: World,
    potential: NDArray[np.float32],
    agents: Agents,
    task: Task,
    ux: float,
    uy: float,
    tick_s: float,
    out: Decisions,
) -> None:
    """Let an agent wish for a velocity (ux, uy), m/s, within its limits of speed and acceleration.

    Others expect that it goes straight on at that velocity up to where its body does not fit.
    """
    a = task.me
    speed = length(ux, uy)
    if speed > task.max_speed_mps:
        ux *= task.max_speed_mps / speed
        uy *= task.max_speed_mps / speed
    wx, wy = limited(task, ux, uy, tick_s)
    out.wishes[a, 0] = wx
    out.wishes[a, 1] = wy
    path = out.paths[a]
    slice_s = world.step_s / SUB
    cell = task.cell
    x = task.x
    y = task.y
    need = min(task.radius_m, clearance_at(world.grid, task.body, cell, x, y))
    path[0, 0] = x
    path[0, 1] = y
    for k in range(1, len(path)):
        there = follow(world.grid, cell, x + ux * slice_s, y + uy * slice_s)
        fits = clearance_at(world.grid, task.body, there, x + ux * slice_s, y + uy * slice_s)
        if there >= 0 and fits >= need - 1e-6:
            cell = there
            x += ux * slice_s
            y += uy * slice_s
        path[k, 0] = x
        path[k, 1] = y
    out.statuses[a] = FOUND
    out.expansions[a] = 0
    out.renewed[a] = True
    out.replanned[a] = False
    out.reasons[a] = _reason(potential, agents, task, length(wx, wy))


@inlined
def _reason(potential: NDArray[np.float32], agents: Agents, task: Task, speed: float) -> int:
    if agents.potential_rows[task.me] >= 0:
        if not np.isfinite(potential_at(potential, task.cell, task.x, task.y)):
            return BLOCKED
        if task.hold and not agents.waits[task.me]:
            return ARRIVED
    return MOVING if speed >= 0.15 * task.speed_mps else WAITING
