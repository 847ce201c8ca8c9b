"""The task of one agent's search, and the costs of a stretch of its path, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._bottleneck_kernels import Lane, off_lane_m
from esplanade.planning.agents._reservation_kernels import Reservations
from esplanade.planning.compiled.jit import inlined
from esplanade.planning.grid._grid_kernels import GridArrays, clearance_at, length
from esplanade.planning.people._risk_kernels import RiskArrays
from esplanade.planning.routes._potential_kernels import EDGES, PotentialValues, potential_at
from esplanade.planning.traversal._anchor_kernels import SLACK_M

SUB = 2
"""Slices of the risk field in one step: a move is looked at half-way and at its end."""
TOO_MANY = np.inf
"""More cells on edges in a row than any body bears."""


class Task(NamedTuple):
    """The task of one search: an actor's place, goal, limits of motion and weights."""

    me: int
    body: int
    """Row of the grid's clearances for this kind of body."""
    contact: int
    """Row of the tables of risk for its distance of contact with people."""
    cell: int
    """The cell that it stands in; -1 where nobody can stand."""
    x: float
    y: float
    vx: float
    vy: float
    goal_x: float
    goal_y: float
    radius_m: float
    speed_mps: float
    max_speed_mps: float
    max_acceleration_mps2: float
    goal_tolerance_m: float
    contact_closing_s: float
    risk_weight: float
    foresight_s: float
    closing_weight: float
    turn_weight: float
    wall_weight: float
    wall_room_m: float
    """A wall nearer to the body than this has a cost."""
    hurry_weight: float
    max_expansions: int
    on_edges: float
    """The way that it has come on edges since it left stable ground, in cells."""
    edge_cells: float
    """M of Huang & Li, the bound on cells on edges in a row; somewhat more for an actor that has
    been held up on them."""
    lane: Lane
    """The lane to keep to on the path."""
    hold: bool
    """Whether to stay at the start: there is no goal, it is reached, or no path leads to it."""


class World(NamedTuple):
    """Everything that all agents of a zone look up."""

    grid: GridArrays
    risk: RiskArrays
    reservations: Reservations
    rules: NDArray[np.void]
    """The one record (1,) of `RULES`."""
    step_s: float
    person_radius_m: float


@inlined
def advance(
    x: float, y: float, vx: float, vy: float, ux: float, uy: float, a_max: float, seconds: float
) -> tuple[float, float, float, float]:
    """Position and velocity after turning the velocity v evenly into u at no more than a_max."""
    dvx = ux - vx
    dvy = uy - vy
    ramp = np.sqrt(dvx * dvx + dvy * dvy) / a_max
    return on_ramp(x, y, vx, vy, dvx, dvy, ramp, seconds)


@inlined
def on_ramp(
    x: float, y: float, vx: float, vy: float, dvx: float, dvy: float, ramp: float, seconds: float
) -> tuple[float, float, float, float]:
    """Position and velocity `seconds` into a change of velocity by dv that takes `ramp` seconds."""
    if ramp <= seconds:
        lag = seconds - 0.5 * ramp
        return x + vx * seconds + dvx * lag, y + vy * seconds + dvy * lag, vx + dvx, vy + dvy
    f = seconds / ramp
    half = 0.5 * f * seconds
    return (
        x + vx * seconds + dvx * half,
        y + vy * seconds + dvy * half,
        vx + dvx * f,
        vy + dvy * f,
    )


@inlined
def metres_left(potential: PotentialValues, task: Task, cell: int, x: float, y: float) -> float:
    """Metres from a point, in a cell, to the goal, and the cost of being left of the lane.

    An agent that holds its place goes straight back to it.
    """
    if task.hold:
        return length(x - task.goal_x, y - task.goal_y)
    left_m = potential_at(potential, cell, x, y)
    return left_m + off_lane_m(task.lane, x, y) if task.lane.weight > 0.0 else left_m


@inlined
def further_on_edges(
    grid: GridArrays, body: int, before: int, cell: int, dx: float, dy: float, count: float
) -> float:
    """The way on edges, in cells, after going by (dx, dy) from a cell to another.

    It is measured along rows or columns: a diagonal step is one cell, too. An agent that comes from
    stable ground has come half of that way on edges.
    """
    if grid.flat or cell < 0 or not grid.edges[body, cell]:
        return 0.0
    way = max(abs(dx), abs(dy)) / grid.layered.cell_m
    if count == 0.0 and before >= 0 and not grid.edges[body, before]:
        way *= 0.5
    return float(count + way)


@inlined
def count_edges(
    grid: GridArrays,
    potential: PotentialValues,
    task: Task,
    before: int,
    cell: int,
    dx: float,
    dy: float,
    count: float,
) -> float:
    """`further_on_edges` of a task's agent; `TOO_MANY` where M forbids it.

    That is where the cells come over and those that lie ahead are not fewer than M; half of the
    cell that the agent is in counts to either. Where M forbids nothing the potential does not
    count, nor does an agent that stays around.
    """
    count = further_on_edges(grid, task.body, before, cell, dx, dy, count)
    if count > 0.0 and not task.hold:
        ahead = float(potential[cell, EDGES])
        if ahead > 0.0 and count + ahead - 0.5 >= task.edge_cells:
            return TOO_MANY
    return count


@inlined
def is_there(task: Task, left_m: float) -> bool:
    """Whether an actor with so many metres left is at its goal: there its trip ends."""
    return bool(not task.hold and left_m <= task.goal_tolerance_m)


@inlined
def time_cost(task: Task, left_m: float, speed: float, seconds: float) -> float:
    """Seconds that a stretch is worth: its time, more when faster than preferred, none while
    standing at the goal."""
    if task.hold:
        return seconds * (speed / task.speed_mps + 0.5 * min(1.0, left_m))
    if speed < 0.2 and is_there(task, left_m):
        return seconds * speed
    over = max(0.0, speed * (1.0 / task.speed_mps) - 1.0)
    return seconds * (1.0 + over + task.hurry_weight * over * over)


@inlined
def risk_price(task: Task, seconds_ahead: float, left_m: float) -> float:
    """Weight of risk in a step that begins at a time ahead, with so many metres left.

    It fades, since the path far ahead will be decided anew. A step that begins at the goal has no
    risk: the trip has ended there, and whoever comes later is evaded then.
    """
    if is_there(task, left_m):
        return 0.0
    return float(task.risk_weight * np.exp(-seconds_ahead / task.foresight_s))


@inlined
def way_left(task: Task, left_m: float, speed: float) -> float:
    """Seconds to the goal at the preferred speed, and the cost of getting to that speed.

    Without that cost an agent that is slow would seem as well off as one that has speed already.
    Shortly before it arrives an agent has no need to be fast any more.
    """
    if task.hold:
        return 0.0
    seconds = left_m * (1.0 / task.speed_mps)
    lacking = task.speed_mps - speed
    if lacking > 0.0 and left_m > task.speed_mps:
        lag = lacking * (1.0 / (2.0 * task.max_acceleration_mps2 * task.speed_mps))
        seconds += lacking * (lag + task.turn_weight)
    return seconds


@inlined
def wall_cost(task: Task, clearance: float, seconds: float) -> float:
    """Cost of brushing along a wall."""
    lacking = max(0.0, task.radius_m + task.wall_room_m - clearance)
    return task.wall_weight * seconds * lacking / task.wall_room_m


@inlined
def needed_clearance(world: World, task: Task) -> float:
    """The radius, or less for an agent that starts closer to a wall, so that it can come out."""
    here = clearance_at(world.grid, task.body, task.cell, task.x, task.y)
    return min(task.radius_m - SLACK_M, max(0.0, here)) - 1e-6
