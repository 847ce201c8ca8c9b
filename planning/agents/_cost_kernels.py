"""The one cost of a step through CT-space, which search and perturbation share, on bare arrays.

A step has two slices: it leads from a place to another half-way and on to its end. Its cost follows
from these three places, where it came from, and who is around: nothing else about how a path was
found counts. What cannot lower a cost comes first, so that a search may stop where a sum is enough.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._reservation_kernels import meetings, others_near
from esplanade.planning.agents._task_kernels import (
    SUB,
    Task,
    World,
    metres_left,
    time_cost,
    wall_cost,
)
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import clearance_at, floor_of, follow, length
from esplanade.planning.people._risk_kernels import people_near, risk_among
from esplanade.planning.routes._potential_kernels import PotentialValues

MOST_OTHERS = 64
"""Room for the agents near a place; that many discs never fit around it."""
MOST_PEOPLE = 256
"""Room for the people who matter near a place. One with more of them is risky enough."""


class Near(NamedTuple):
    """Room for those who are near a place."""

    others: NDArray[np.int64]
    """Agents who may be met, and from the end backwards those who may stand too near."""
    halfway: NDArray[np.int64]
    """People who matter in the middle of a step."""
    ahead: NDArray[np.int64]
    """People who matter at its end."""


class Counts(NamedTuple):
    """The number of those in each list of `Near`."""

    met: int
    crowded: int
    halfway: int
    ahead: int


NOT_COUNTED = Counts(-1, 0, 0, 0)
"""Nobody has been listed yet."""


@kernel
def room_for_near() -> Near:
    """Room for those who are near one place."""
    return Near(
        np.empty(MOST_OTHERS, dtype=np.int64),
        np.empty(MOST_PEOPLE, dtype=np.int64),
        np.empty(MOST_PEOPLE, dtype=np.int64),
    )


@inlined
def look_around(
    world: World, task: Task, k: int, cell: int, x: float, y: float, speed: float, near: Near
) -> Counts:
    """List those who matter to any step of one slice after the other from (x, y) at slice k."""
    grid = world.grid
    floor_m = 0.0 if grid.flat else floor_of(grid, cell)
    slice_m = max(task.max_speed_mps, speed) * (world.step_s / SUB)
    met, crowded = others_near(world.reservations, task.me, floor_m, k, x, y, slice_m, near.others)
    halfway = people_near(world.risk, grid.flat, floor_m, k + 1, x, y, slice_m, near.halfway)
    ahead = people_near(world.risk, grid.flat, floor_m, k + 2, x, y, 2.0 * slice_m, near.ahead)
    return Counts(met, crowded, halfway, ahead)


@inlined
def turned_mps(ux: float, uy: float, vx: float, vy: float, wx: float, wy: float) -> float:
    """The change of velocity from u before a step to v in its first half and w in its second."""
    return length(vx - ux, vy - uy) + length(wx - vx, wy - vy)


@inlined
def motion_cost(
    task: Task, left_m: float, stride: float, turned: float, seconds: float
) -> tuple[float, float]:
    """Time and turning of a step of a length `stride`, after which `left_m` are left.

    The velocity changes by `turned` m/s in it, as `turned_mps` says.
    """
    return time_cost(task, left_m, stride / seconds, seconds), task.turn_weight * turned


@inlined
def others_weight(
    world: World,
    task: Task,
    near: Near,
    counts: Counts,
    k: int,
    x: float,
    y: float,
    hx: float,
    hy: float,
    ex: float,
    ey: float,
) -> tuple[bool, float]:
    """Whether other agents forbid a step from (x, y) at slice k to h and on to e, and what they
    weigh."""
    if counts.met + counts.crowded == 0:
        return False, 0.0
    return meetings(
        world.reservations,
        near.others,
        counts.met,
        counts.crowded,
        task.me,
        k,
        x,
        y,
        hx,
        hy,
        ex,
        ey,
    )


@inlined
def people_risk(
    world: World,
    task: Task,
    near: Near,
    counts: Counts,
    k: int,
    hx: float,
    hy: float,
    ex: float,
    ey: float,
    vx: float,
    vy: float,
    wx: float,
    wy: float,
    most: float,
) -> float:
    """Sum of the risks at the places h and e of a step from slice k, with velocities v and w there.

    Risk is never negative: the sum is inf as soon as it reaches `most`.
    """
    risk = risk_among(
        world.risk,
        task.contact,
        near.ahead,
        counts.ahead,
        k + 2,
        ex,
        ey,
        wx,
        wy,
        task.closing_weight,
    )
    if risk >= most:
        return np.inf
    risk += risk_among(
        world.risk,
        task.contact,
        near.halfway,
        counts.halfway,
        k + 1,
        hx,
        hy,
        vx,
        vy,
        task.closing_weight,
    )
    return risk if risk < most else np.inf


class StepParts(NamedTuple):
    """The parts of a step's cost, and the places that it leads to."""

    half: int
    """The cell half-way, and that of the end."""
    end: int
    half_room: float
    """The clearance half-way, and that at the end."""
    end_room: float
    left_m: float
    seconds: float
    turning: float
    wall: float
    blocked: bool
    """Whether other agents forbid it."""
    soft: float
    """Weight of other agents, not yet priced."""
    risk: float
    """Sum of the risks half-way and at the end, not yet priced."""


@inlined
def step_parts(
    world: World,
    potential: PotentialValues,
    task: Task,
    path: NDArray[np.float64],
    step: int,
    cell: int,
    ux: float,
    uy: float,
    near: Near,
) -> StepParts:
    """The parts of the cost of a step of a path, which is in `cell` before it with velocity u."""
    grid = world.grid
    ds = world.step_s / SUB
    k = step * SUB
    x, y = path[k, 0], path[k, 1]
    hx, hy = path[k + 1, 0], path[k + 1, 1]
    ex, ey = path[k + 2, 0], path[k + 2, 1]
    vx, vy = (hx - x) / ds, (hy - y) / ds
    wx, wy = (ex - hx) / ds, (ey - hy) / ds
    half = follow(grid, cell, hx, hy)
    end = follow(grid, half, ex, ey)
    left_m = metres_left(potential, task, end, ex, ey)
    seconds, turning = motion_cost(
        task, left_m, length(ex - x, ey - y), turned_mps(ux, uy, vx, vy, wx, wy), world.step_s
    )
    half_room = clearance_at(grid, task.body, half, hx, hy)
    end_room = clearance_at(grid, task.body, end, ex, ey)
    fastest = max(length(vx, vy), length(wx, wy))
    counts = look_around(world, task, k, cell, x, y, fastest, near)
    blocked, soft = others_weight(world, task, near, counts, k, x, y, hx, hy, ex, ey)
    risk = people_risk(world, task, near, counts, k, hx, hy, ex, ey, vx, vy, wx, wy, np.inf)
    wall = wall_cost(task, min(half_room, end_room), world.step_s)
    return StepParts(
        half, end, half_room, end_room, left_m, seconds, turning, wall, blocked, soft, risk
    )
