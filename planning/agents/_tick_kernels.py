"""The stages of a tick on a zone that compiled code keeps, one by one and all in one call."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._branch_kernels import Moves
from esplanade.planning.agents._decide_kernels import decide
from esplanade.planning.agents._priority_kernels import prepare
from esplanade.planning.agents._reason_kernels import match_reasons
from esplanade.planning.agents._search_kernels import Workspace
from esplanade.planning.agents._step_kernels import resolve, settle
from esplanade.planning.agents._task_kernels import World
from esplanade.planning.agents.agents import Agents, Decisions
from esplanade.planning.compiled.handle import Handle
from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import floor_of, heights_along
from esplanade.planning.ground._geometry_kernels import BarrierIndex
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.people._risk_kernels import index_people


class Zone(NamedTuple):
    """Everything that the ticks of a zone work on, except for people's future.

    `due` (A,) tells whose paths are planned in a tick, `stalled_s` (A,) s for how long each has
    come no nearer to its goal, and `steered` (A, 2) m/s which velocities are decided elsewhere, nan
    for the others; `order` (A,) and `decisions` are written
    anew in every one; `positions` (A, 2) and `cells` (A,) are those after it.
    """

    world: World
    barriers: BarrierIndex
    potentials: NDArray[np.float32]
    no_potential: NDArray[np.float32]
    moves: Moves
    agents: Agents
    due: NDArray[np.bool_]
    stalled_s: NDArray[np.float64]
    steered: NDArray[np.float64]
    order: NDArray[np.int64]
    decisions: Decisions
    positions: NDArray[np.float64]
    cells: NDArray[np.int64]
    fastest_mps: float
    """The room is enough for agents up to this speed."""
    last_wider: int


@kernel
def has_room(zone: Handle[Zone], workspace: Handle[Workspace], branching: int) -> bool:
    """Whether the agents as they are now have room enough, and not far too much of it."""
    world, agents = zone.value.world, zone.value.agents
    fastest_mps = 0.0
    for a in range(len(agents.positions)):
        p = agents.parameters[a]
        # An agent that is told to be slower from now on still has to brake.
        speed = np.hypot(agents.velocities[a, 0], agents.velocities[a, 1])
        fastest_mps = max(fastest_mps, p["max_speed_mps"], speed)
        if p["radius_m"] > world.reservations.widest_m or p["max_expansions"] * branching + 2 > len(
            workspace.value.node_state
        ):
            return False
    return bool(fastest_mps <= zone.value.fastest_mps <= 2.0 * fastest_mps)


@kernel
def index_future(zone: Handle[Zone], prediction: Prediction, first: int, step: int) -> None:
    """Index people slice by slice: first, first + step, ..."""
    agents, risk = zone.value.agents, zone.value.world.risk
    x0 = x1 = agents.positions[0, 0]
    y0 = y1 = agents.positions[0, 1]
    for a in range(1, len(agents.positions)):
        x, y = agents.positions[a]
        x0 = min(x0, x)
        y0 = min(y0, y)
        x1 = max(x1, x)
        y1 = max(y1, y)
    index_people(prediction, zone.value.last_wider, (x0, y0, x1, y1), first, step, risk)


@kernel
def put_in_order(zone: Handle[Zone], tick_s: float) -> None:
    """Shift followed paths to now, and put the agents in order of priority."""
    z = zone.value
    for a in range(len(z.order)):
        z.world.reservations.radii[a] = z.agents.parameters[a]["radius_m"]
    prepare(z.world, z.potentials, z.agents, tick_s, z.order)


@kernel
def decide_some(
    zone: Handle[Zone],
    prediction: Prediction,
    tick_s: float,
    first: int,
    last: int,
    workspace: Handle[Workspace],
) -> None:
    """`decide` for some actors."""
    z = zone.value
    decide(
        z.world,
        z.potentials,
        z.no_potential,
        z.moves,
        prediction,
        z.agents,
        z.due,
        z.stalled_s,
        z.steered,
        tick_s,
        first,
        last,
        workspace.value,
        z.decisions,
    )


@kernel
def take_steps(zone: Handle[Zone], tick_s: float) -> None:
    """Take the steps in order of priority."""
    z = zone.value
    resolve(z.world, z.barriers, z.agents, z.order, tick_s, z.decisions, z.positions, z.cells)


@kernel
def plan_and_step(
    zone: Handle[Zone],
    workspace: Handle[Workspace],
    branching: int,
    prediction: Prediction,
    tick_s: float,
) -> bool:
    """All stages one after the other, on one thread; False, and nothing done, without room."""
    if not has_room(zone, workspace, branching):
        return False
    # Numbers of the same type as from Python: for literals everything would be compiled once more.
    first: int = np.int64(0)  # type: ignore[assignment]
    step: int = np.int64(1)  # type: ignore[assignment]
    index_future(zone, prediction, first, step)
    put_in_order(zone, tick_s)
    decide_some(zone, prediction, tick_s, first, len(zone.value.order), workspace)
    take_steps(zone, tick_s)
    return True


@kernel
def settle_all(zone: Handle[Zone], prediction: Prediction, tick_s: float) -> None:
    """Take the tick over into the agents' own state: where they are, why, and their plans."""
    z = zone.value
    agents = z.agents
    settle(z.world.grid, z.world.rules[0], agents, z.decisions, z.positions, z.cells, tick_s)
    agents.reasons[:] = z.decisions.reasons
    agents.planned[:, :, :2] = z.decisions.paths
    agents.planned[:, :, 2] = 0.0
    if not z.world.grid.flat:
        heights_along(z.world.grid, agents.cells, agents.planned)
    layered = z.world.grid.layered
    for a in range(len(agents.cells)):
        cell = agents.cells[a]
        agents.layers[a] = layered.places[cell]["layer"] if cell >= 0 else 0
        agents.heights[a] = floor_of(z.world.grid, cell)
    match_reasons(agents, z.world.reservations.radii, prediction, z.world.rules[0])
