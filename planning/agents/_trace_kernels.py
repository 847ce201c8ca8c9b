"""The parts of a decision, for those who look at it between two ticks, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._cost_kernels import room_for_near, step_parts
from esplanade.planning.agents._decide_kernels import make_task
from esplanade.planning.agents._perturb_kernels import path_cost
from esplanade.planning.agents._task_kernels import (
    SUB,
    Task,
    World,
    is_there,
    metres_left,
    risk_price,
    way_left,
)
from esplanade.planning.agents._tick_kernels import Zone
from esplanade.planning.compiled.handle import Handle
from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import floor_of, length
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.people._risk_kernels import RiskArrays, index_people, risk_at
from esplanade.planning.routes._potential_kernels import PotentialValues, potential_at

TIME, RISK, OTHERS, TURN, WALL, HURRY, KEEP_RIGHT, TOTAL, MEAN_RISK, LEGAL = range(10)
"""Columns of what `price_paths` fills in; seconds, but for mean risk and whether it is legal."""
COLUMNS = 10


@kernel
def price_paths(
    zone: Handle[Zone],
    a: int,
    tick_s: float,
    paths: NDArray[np.float64],
    prices: NDArray[np.float64],
) -> None:
    """Fill `prices` (N, 10) with the parts that costs of paths (N, K, 3) are made of.

    `paths` holds x and y, and gets the heights of the floor. The total is that of `path_cost`. The
    zone's agents must be as they were before the tick; nothing of them is changed.
    """
    z = zone.value
    agents = z.agents
    left_m = agents.left_m[a]
    behind_s = agents.behind_s[a]
    contested = z.world.reservations.contested[a]
    tolerance_m = agents.parameters[a]["goal_tolerance_m"]
    task = make_task(z.potentials, agents, z.world.rules[0], a, tolerance_m, tick_s, contested)
    agents.left_m[a] = left_m
    agents.behind_s[a] = behind_s
    slot = agents.potential_rows[a]
    potential = z.potentials[slot] if slot >= 0 else z.no_potential
    path = np.empty((paths.shape[1], 2))
    near = room_for_near()
    for n in range(len(paths)):
        path[:, 0] = paths[n, :, 0]
        path[:, 1] = paths[n, :, 1]
        cost = path_cost(z.world, potential, task, path, near)
        prices[n] = 0.0
        _price(z.world, potential, task, path, paths[n], prices[n])
        prices[n, TOTAL] = cost.seconds
        prices[n, MEAN_RISK] = cost.mean_risk
        prices[n, LEGAL] = cost.legal


@kernel
def _price(
    world: World,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    places: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """The parts of `path_cost`, which this follows step by step, and the heights of a path."""
    grid = world.grid
    ds = world.step_s / SUB
    near = room_for_near()
    cell = task.cell
    vx = task.vx
    vy = task.vy
    left_m = metres_left(potential, task, cell, task.x, task.y)
    bare_m = 0.0
    places[0, 2] = floor_of(grid, cell)
    for step in range((len(path) - 1) // SUB):
        k = step * SUB
        parts = step_parts(world, potential, task, path, step, cell, vx, vy, near)
        for s, on in ((1, parts.half), (2, parts.end)):
            places[k + s, 2] = floor_of(grid, on) if on >= 0 else places[k + s - 1, 2]
        price = risk_price(task, step * world.step_s, left_m) * ds
        left_m = parts.left_m
        ex, ey = path[k + 2]
        bare_m = left_m if task.hold else potential_at(potential, parts.end, ex, ey)
        speed = length(ex - path[k, 0], ey - path[k, 1]) / world.step_s
        hurried = 0.0
        if not (task.hold or (speed < 0.2 and is_there(task, left_m))):
            hurried = parts.seconds - world.step_s
        out[TIME] += parts.seconds - hurried
        out[HURRY] += hurried
        out[RISK] += price * parts.risk
        out[OTHERS] += price * parts.soft
        out[TURN] += parts.turning
        out[WALL] += parts.wall
        cell = parts.end
        vx = (ex - path[k + 1, 0]) / ds
        vy = (ey - path[k + 1, 1]) / ds
    speed = length(vx, vy)
    bare = way_left(task, bare_m, speed)
    out[TIME] += bare
    if np.isfinite(bare):
        out[KEEP_RIGHT] = way_left(task, left_m, speed) - bare


@kernel
def risk_slices(
    zone: Handle[Zone],
    prediction: Prediction,
    risk: RiskArrays,
    a: int,
    every: int,
    cells: NDArray[np.int64],
    places: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out` (S, N) with the risk for agent a of standing at places (N, 2), in cells (N,).

    Slice s is that of `s * every` of the prediction. `risk` has room for all people; it is filled
    anew, since the tick left out those whom no agent could come near.
    """
    z = zone.value
    around = (
        places[:, 0].min(),
        places[:, 1].min(),
        places[:, 0].max(),
        places[:, 1].max(),
    )
    first: int = np.int64(0)  # type: ignore[assignment]
    index_people(prediction, z.last_wider, around, first, every, risk)
    weight = z.agents.parameters[a]["closing_weight"]
    contact = z.agents.contacts[a]
    for s in range(len(out)):
        for n in range(len(places)):
            x, y = places[n]
            out[s, n] = 0.0
            if cells[n] >= 0:
                out[s, n] = risk_at(
                    z.world.grid, risk, contact, s * every, cells[n], x, y, 0.0, 0.0, weight
                )
