"""One tick's decisions for many actors, on bare arrays.

Every agent reads the state of the finished tick and writes its own row, so rows may be worked on
in any order and on any number of threads; only `resolve` runs through the actors in rank order.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._bottleneck_kernels import lane_of, see_passage
from esplanade.planning.agents._branch_kernels import Moves
from esplanade.planning.agents._cost_kernels import Near
from esplanade.planning.agents._narrow_way_kernels import (
    is_held_alone,
    lead_over_anchors,
    leads_nowhere,
    leads_over_edges,
)
from esplanade.planning.agents._perturb_kernels import (
    PathCost,
    PerturbationRoom,
    path_cost,
    room_to_perturb,
    update_path,
)
from esplanade.planning.agents._reason_kernels import decided_reason
from esplanade.planning.agents._reservation_kernels import conflict
from esplanade.planning.agents._search_kernels import (
    FOUND,
    NO_PATH,
    PARTIAL,
    Workspace,
    begin_search,
    lay_known,
    search,
)
from esplanade.planning.agents._steered_kernels import steer
from esplanade.planning.agents._step_kernels import control_toward, last_check, limited
from esplanade.planning.agents._task_kernels import SUB, Task, World, metres_left, needed_clearance
from esplanade.planning.agents.agents import BLOCKED, GIVING_WAY, MOVING, Agents, Decisions
from esplanade.planning.compiled.jit import borrowing, inlined, kernel
from esplanade.planning.grid._grid_kernels import (
    anchor_at,
    clearance_at,
    floor_of,
    follow,
    length,
)
from esplanade.planning.grid._side_kernels import is_cut_off
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.routes._legal_way_kernels import ROUNDING_CELLS
from esplanade.planning.routes._potential_kernels import EDGES, potential_at, way_out


@inlined
def keep_account(agents: Agents, rules: np.void, a: int, left: float, tick_s: float) -> float:
    """Book the time that an actor lost or made up in the last tick; return its speed from now on.

    The time lost is the length of a tick less the time that the progress made in it takes at the
    preferred speed.
    """
    p = agents.parameters[a]
    before = agents.left_m[a]
    agents.left_m[a] = left
    if np.isfinite(before) and np.isfinite(left):
        lost = tick_s - (before - left) / p["speed_mps"]
        agents.behind_s[a] = min(rules["most_behind_s"], max(0.0, agents.behind_s[a] + lost))
    faster = 1.0 + p["catch_up"] * min(1.0, agents.behind_s[a] / rules["ease_s"])
    return float(min(p["max_speed_mps"], p["speed_mps"] * faster))


@borrowing
def make_task(
    potentials: NDArray[np.float32],
    agents: Agents,
    rules: np.void,
    a: int,
    max_hold_m: float,
    tick_s: float,
    contested: bool,
) -> Task:
    """The task of actor a's search in this tick.

    Without a goal or a path to it, and while it waits, it stays around.

    `contested` tells whether its passage is contested. An actor that is about to arrive keeps to
    no lane, since it could not go to a goal that lies left of the lane.
    """
    p = agents.parameters[a]
    cell = agents.cells[a]
    x = agents.positions[a, 0]
    y = agents.positions[a, 1]
    gx = agents.goals[a, 0]
    gy = agents.goals[a, 1]
    slot = agents.potential_rows[a]
    hold = slot < 0 or agents.waits[a]
    speed = p["speed_mps"]
    left = 0.0
    if not hold:
        left = potential_at(potentials[slot], cell, x, y)
        if not np.isfinite(left):
            hold = True
            gx = x
            gy = y
        elif left <= max_hold_m:
            hold = True
        else:
            speed = keep_account(agents, rules, a, left, tick_s)
    else:
        gx = x
        gy = y
    keeps_right = contested and left > rules["lane_after_m"]
    on_edges = agents.on_edges[a]
    most_edges = p["edge_cells"] + ROUNDING_CELLS
    if not hold and cell >= 0:
        ahead = float(potentials[slot, cell, EDGES])
        if on_edges + ahead + (1.0 if on_edges > 0.0 else -0.5) >= most_edges:
            most_edges = on_edges + ahead + rules["dodge_cells"]
    return Task(
        a,
        agents.bodies[a],
        agents.contacts[a],
        cell,
        x,
        y,
        agents.velocities[a, 0],
        agents.velocities[a, 1],
        gx,
        gy,
        p["radius_m"],
        speed,
        p["max_speed_mps"],
        p["max_acceleration_mps2"],
        p["goal_tolerance_m"],
        p["contact_closing_s"],
        p["risk_weight"] * agents.cautions[a],
        p["foresight_s"],
        p["closing_weight"],
        p["turn_weight"],
        p["wall_weight"],
        rules["wall_room_m"],
        p["hurry_weight"],
        int(p["max_expansions"]),
        on_edges,
        most_edges,
        lane_of(agents.passages[a], rules, p["keep_right_weight"] if keeps_right else 0.0),
        hold,
    )


@kernel
def decide(
    world: World,
    potentials: NDArray[np.float32],
    no_potential: NDArray[np.float32],
    moves: Moves,
    prediction: Prediction,
    agents: Agents,
    due: NDArray[np.bool_],
    stalled_s: NDArray[np.float64],
    steered: NDArray[np.float64],
    tick_s: float,
    first: int,
    last: int,
    workspace: Workspace,
    out: Decisions,
) -> None:
    """Plan a path for each actor that is due, and wish for a velocity along the path of each.

    Actors that are not `due` (A,) go on along their followed paths; those without one, with one
    that is illegal soon, or inside something, are planned in any tick. Followed paths, seen from
    now, are `world.reservations.paths`. For `stalled_s` (A,) s each has come no nearer to its goal.
    Those with a velocity in `steered` (A, 2) m/s, not nan, wish for that, and plan nothing.
    The actors are first..last of those listed by their places
    now: neighbours look at the same ground and people, which stay in the cache. The speeds of
    `moves` are parts of each actor's own.
    """
    rules = world.rules[0]
    slices = out.paths.shape[1]
    speeds = np.empty(len(moves.speeds))
    kept = np.empty((slices, 2))
    bent = np.empty((slices, 2))
    room = room_to_perturb(slices)
    listed = np.empty(len(prediction.means), dtype=np.int64)
    for n in range(first, last):
        a = world.reservations.members[0, n]
        p = agents.parameters[a]
        contested = world.reservations.contested[a]
        task = make_task(potentials, agents, rules, a, p["goal_tolerance_m"], tick_s, contested)
        slot = agents.potential_rows[a]
        potential = potentials[slot] if slot >= 0 else no_potential
        if not np.isnan(steered[a, 0]):
            steer(world, potential, agents, task, steered[a, 0], steered[a, 1], tick_s, out)
            continue
        if slot >= 0 and is_cut_off(world.grid, task.body, task.cell, task.x, task.y):
            _lead_out(world, potential, prediction, agents, task, tick_s, listed, out)
            continue
        for m in range(len(moves.speeds)):
            part = moves.speeds[m]
            speeds[m] = task.max_speed_mps if part > 1.0 else part * task.speed_mps
        own = Moves(moves.cosines, moves.sines, speeds, moves.straight, moves.coarse, True)
        kept[:] = world.reservations.paths[a]
        status = FOUND
        switched = False
        out.replanned[a] = (
            due[a]
            or not agents.known[a]
            or clearance_at(world.grid, task.body, task.cell, task.x, task.y) < 0.0
            or not _is_legal_soon(world, task, kept)
        )
        if out.replanned[a]:
            status, switched = _replan(
                world, potential, own, agents, task, kept, bent, room, workspace, out
            )
        else:
            out.paths[a] = kept
            out.expansions[a] = 0
            out.renewed[a] = False
        out.statuses[a] = status
        path = out.paths[a]
        need = needed_clearance(world, task)
        narrow = False
        held = is_held_alone(world, agents, a, stalled_s[a])
        if slot >= 0 and (
            leads_over_edges(world, potential, task, path)
            or leads_nowhere(world, potential, task, path, room.cells, held)
        ):
            most_edges = p["edge_cells"]
            narrow, ux, uy = lead_over_anchors(world, potential, task, most_edges, path, bent, held)
        if narrow:  # the followed path stays: this one is found anew in every tick
            path[:] = bent
            status = FOUND
            switched = False
            out.statuses[a] = status
            out.renewed[a] = not agents.known[a]
            need = -np.inf  # `walk` keeps it from walls
        else:
            ux, uy = control_toward(task, path[SUB, 0], path[SUB, 1], world.step_s)
        contact = p["radius_m"] + (world.person_radius_m + p["person_room_m"])
        dodged = False
        away = metres_left(potential, task, task.cell, task.x, task.y)
        if rules["checks_steps"]:
            ux, uy, dodged = last_check(
                world, prediction, task, need, contact, away, listed, ux, uy
            )
        wx, wy = limited(task, ux, uy, tick_s)
        out.wishes[a, 0] = wx
        out.wishes[a, 1] = wy
        lost = slot >= 0 and not np.isfinite(potential_at(potential, task.cell, task.x, task.y))
        if status == NO_PATH and not lost:  # inside something no path leads out of
            lost = clearance_at(world.grid, task.body, task.cell, task.x, task.y) < 0.0
        if len(agents.passages) > rules["contested_actors"]:
            see_passage(
                world.grid,
                potential,
                rules,
                agents,
                a,
                slot >= 0 and not task.hold,
                tick_s,
            )
        out.reasons[a] = decided_reason(
            agents, task, away, lost, path, status, switched, dodged, world.step_s
        )


@borrowing
def _is_legal_soon(world: World, task: Task, path: NDArray[np.float64]) -> bool:
    """Whether the first slices of a followed path, as many as the rules say, keep clear of walls
    and of reservations.

    By how much an actor lags behind its path does not count, nor do limits of speed: `limited` and
    `walk` see to those.
    """
    need = needed_clearance(world, task)
    cell = task.cell
    for k in range(min(world.rules[0]["checked_slices"], len(path) - 1)):
        ax, ay = path[k, 0], path[k, 1]
        bx, by = path[k + 1, 0], path[k + 1, 1]
        feet_m = floor_of(world.grid, cell)
        cell = follow(world.grid, cell, bx, by)
        if clearance_at(world.grid, task.body, cell, bx, by) < need:
            return False
        if conflict(world.reservations, task.me, feet_m, k, ax, ay, bx, by)[0]:
            return False
    return True


@inlined
def _replan(
    world: World,
    potential: NDArray[np.float32],
    own: Moves,
    agents: Agents,
    task: Task,
    kept: NDArray[np.float64],
    bent: NDArray[np.float64],
    room: PerturbationRoom,
    workspace: Workspace,
    out: Decisions,
) -> tuple[int, bool]:
    """Perturb the followed path `kept`, search anew, and keep the better.

    Returns the status, and whether another path than the followed one was taken. The search only
    looks at paths that may be better than the followed one by the hysteresis, so that it costs
    little while that path is good. Where that path has become illegal, the search goes on from the
    steps before.
    """
    a = task.me
    rules = world.rules[0]
    bound = np.inf
    expected = np.inf
    begun = 0
    changed = False
    accumulate = not rules["greedy"]
    begin_search(task, workspace)
    if agents.known[a]:
        cost, changed = _improve(world, potential, task, kept, bent, room, workspace.near)
        if cost.legal:
            bound = expected = cost.seconds - agents.parameters[a]["hysteresis_s"]
        elif accumulate and rules["goes_on"]:
            expected = cost.seconds
            begun = cost.legal_steps
            lay_known(world, potential, task, kept, begun, workspace)
    found = search(
        world, potential, own, task, accumulate, bound, expected, begun, workspace, out.paths[a]
    )
    status = found.status
    better = True
    if bound < np.inf:
        seconds = found.cost
        if status == PARTIAL or rules["greedy"]:  # it stays where it ends, up to the horizon
            seconds = path_cost(world, potential, task, out.paths[a], workspace.near).seconds
        better = status != NO_PATH and (seconds < bound or not rules["weighs_paths"])
        if not better:
            _copy(kept, out.paths[a])
            status = FOUND
    out.expansions[a] = found.expansions
    out.renewed[a] = better or changed
    return status, bool(better and agents.known[a])


@kernel
def _lead_out(
    world: World,
    potential: NDArray[np.float32],
    prediction: Prediction,
    agents: Agents,
    task: Task,
    tick_s: float,
    listed: NDArray[np.int64],
    out: Decisions,
) -> None:
    """Decide for an actor that a wall cuts off from its cell's anchor: go where it can plan again.

    Its cell's potential and clearance are those of the other side of the wall. So it goes straight
    to an anchor on its own side, if a way leads on from there; `walk` keeps it from the wall.
    """
    a = task.me
    path = out.paths[a]
    agents.left_m[a] = np.inf  # what it was said to be means nothing
    ex = task.x
    ey = task.y
    cell, _ = way_out(world.grid, potential, task.body, task.radius_m, task.cell, task.x, task.y)
    if cell >= 0:
        ex, ey = anchor_at(world.grid, task.body, cell)
    away = length(ex - task.x, ey - task.y)
    slice_m = task.speed_mps * world.step_s / SUB
    for k in range(len(path)):
        part = min(1.0, k * slice_m / away) if away > 0.0 else 1.0
        path[k, 0] = task.x + part * (ex - task.x)
        path[k, 1] = task.y + part * (ey - task.y)
    p = agents.parameters[a]
    contact = p["radius_m"] + (world.person_radius_m + p["person_room_m"])
    ux, uy = control_toward(task, path[SUB, 0], path[SUB, 1], world.step_s)
    ux, uy, dodged = last_check(world, prediction, task, -np.inf, contact, np.inf, listed, ux, uy)
    wx, wy = limited(task, ux, uy, tick_s)
    out.wishes[a, 0] = wx
    out.wishes[a, 1] = wy
    out.statuses[a] = FOUND if cell >= 0 else NO_PATH
    out.expansions[a] = 0
    out.renewed[a] = True
    out.replanned[a] = True
    out.reasons[a] = MOVING
    if cell < 0:
        out.reasons[a] = BLOCKED
    elif dodged:
        out.reasons[a] = GIVING_WAY


@inlined
def _improve(
    world: World,
    potential: NDArray[np.float32],
    task: Task,
    path: NDArray[np.float64],
    bent: NDArray[np.float64],
    room: PerturbationRoom,
    near: Near,
) -> tuple[PathCost, bool]:
    """Perturb a legal path in place if that pays; return its cost, and if it changed.

    It pays if both mean risk and cost become less; the cost counts time and length.
    """
    cost = path_cost(world, potential, task, path, near)
    if not cost.legal or not world.rules[0]["perturbs"]:
        return cost, False
    if cost.mean_risk * (len(path) - 1) <= 2 * world.rules[0]["least_risk"]:
        return cost, False  # not even a stretch of two slices may have so much that it is bent
    _copy(path, bent)
    if update_path(world, potential, task, bent, room) > 0:
        bent_cost = path_cost(world, potential, task, bent, near)
        if bent_cost.mean_risk < cost.mean_risk and bent_cost.seconds < cost.seconds:
            _copy(bent, path)
            return bent_cost, True
    return cost, False


@inlined
def _copy(path: NDArray[np.float64], to: NDArray[np.float64]) -> None:
    for k in range(len(path)):
        to[k, 0] = path[k, 0]
        to[k, 1] = path[k, 1]
