"""Courses and priorities of agents on bare arrays, worked out before any of them decides."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._bottleneck_kernels import find_contested, order_at_passages
from esplanade.planning.agents._reservation_kernels import Reservations, index_paths
from esplanade.planning.agents._task_kernels import SUB, World
from esplanade.planning.agents.agents import Agents
from esplanade.planning.agents.priorities import Priorities, Turn
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, floor_of, follow
from esplanade.planning.routes._potential_kernels import direction_at, potential_at
from esplanade.planning.scene.heights import BODIES_OVERLAP_M

SETTLED, WALKS = int(Turn.SETTLED), int(Turn.WALKS)
LEAVES_JAM, ENTERS_JAM = int(Turn.LEAVES_JAM), int(Turn.ENTERS_JAM)


@kernel
def prepare(
    world: World,
    potentials: NDArray[np.float32],
    agents: Agents,
    tick_s: float,
    order: NDArray[np.int64],
) -> None:
    """Fill the reservations of a tick, and `order` (A,) with the agents by descending priority."""
    r = world.reservations
    rules = world.rules[0]
    actors = len(order)
    continue_paths(world, potentials, agents, tick_s, r.paths, r.heights)
    index_paths(r)
    priorities = Priorities(np.empty(actors, dtype=np.int64), np.empty(actors))
    order_by_distance(potentials, agents, rules["settled_m"], priorities)
    find_courses(world.grid, potentials, agents, priorities, r)
    order_in_jams(priorities, r)
    if actors > rules["contested_actors"]:
        find_contested(agents, rules, r.contested)
    if actors > rules["contested_actors"] and rules["orders_passages"]:
        order_at_passages(agents, rules, r.contested, priorities)
    put_in_order(priorities, agents.ranks, order)
    for n in range(actors):
        r.ranks[order[n]] = n


@kernel
def put_in_order(
    priorities: Priorities, ranks: NDArray[np.int64], order: NDArray[np.int64]
) -> None:
    """Fill `order` (A,) with the agents as `Priorities` compares them, the first first."""
    by_rank = np.argsort(ranks, kind="mergesort")
    by_key = by_rank[np.argsort(priorities.keys_m[by_rank], kind="mergesort")]
    n = 0
    for turn in range(SETTLED + 1):
        for a in by_key:
            if priorities.turns[a] == turn:
                order[n] = a
                n += 1


@kernel
def continue_paths(
    world: World,
    potentials: NDArray[np.float32],
    agents: Agents,
    tick_s: float,
    out: NDArray[np.float64],
    heights: NDArray[np.float64],
) -> None:
    """Continue followed paths from now: fill `out` (A, K, 2) and `heights` (A, K), metres.

    A path is read `ages` ticks after its start, begins at the agent's real position, and is
    extended at its end down the potential. An agent without a path is expected to stand.
    """
    slices = out.shape[1]
    ds = world.step_s / SUB
    for a in range(len(out)):
        px = agents.positions[a, 0]
        py = agents.positions[a, 1]
        if not agents.known[a]:
            out[a, :, 0] = px
            out[a, :, 1] = py
            heights[a] = floor_of(world.grid, agents.cells[a])
            continue
        path = agents.followed[a]
        cell = agents.cells[a]
        shift = agents.ages[a] * tick_s / ds
        ox = 0.0
        oy = 0.0
        for k in range(slices):
            u = shift + k
            i = int(u)
            if i + 1 < slices:
                w = u - i
                x = (1.0 - w) * path[i, 0] + w * path[i + 1, 0]
                y = (1.0 - w) * path[i, 1] + w * path[i + 1, 1]
            else:
                x, y = _carry_on(
                    world,
                    potentials,
                    agents,
                    a,
                    follow(world.grid, cell, path[slices - 1, 0], path[slices - 1, 1]),
                    path[slices - 1, 0],
                    path[slices - 1, 1],
                    (u - (slices - 1)) * ds,
                )
            if k == 0:
                ox = px - x
                oy = py - y
            fade = max(0.0, 1.0 - 0.25 * k)
            out[a, k, 0] = x + fade * ox
            out[a, k, 1] = y + fade * oy
            if cell >= 0:
                on = follow(world.grid, cell, out[a, k, 0], out[a, k, 1])
                cell = on if on >= 0 else cell
            heights[a, k] = floor_of(world.grid, cell)


@inlined
def _carry_on(
    world: World,
    potentials: NDArray[np.float32],
    agents: Agents,
    a: int,
    cell: int,
    x: float,
    y: float,
    seconds: float,
) -> tuple[float, float]:
    """Position of an agent some seconds after the end of its path, down the potential."""
    slot = agents.potential_rows[a]
    if slot < 0 or agents.waits[a]:
        return x, y
    gx, gy, leg = direction_at(world.grid, potentials[slot], cell, x, y)
    way = min(leg, agents.parameters[a]["speed_mps"] * seconds)
    return x + gx * way, y + gy * way


@kernel
def order_by_distance(
    potentials: NDArray[np.float32], agents: Agents, settled_m: float, out: Priorities
) -> None:
    """Give everyone the priority of its distance left, or that of agents that are settled.

    Those are agents within `settled_m` of their goal, without a path, or that wait.
    """
    for a in range(len(out.turns)):
        out.turns[a] = SETTLED
        out.keys_m[a] = 0.0
        slot = agents.potential_rows[a]
        if slot >= 0 and not agents.waits[a]:
            x, y = agents.positions[a]
            left = potential_at(potentials[slot], agents.cells[a], x, y)
            if settled_m < left < np.inf:
                out.turns[a] = WALKS
                out.keys_m[a] = left


@kernel
def find_courses(
    grid: GridArrays,
    potentials: NDArray[np.float32],
    agents: Agents,
    priorities: Priorities,
    reservations: Reservations,
) -> None:
    """Fill `courses` and `held_up` of the reservations for all agents that are not settled."""
    r = reservations
    rules = r.rules[0]
    for a in range(len(priorities.turns)):
        r.courses[a] = 0.0
        r.held_up[a] = False
        if priorities.turns[a] != SETTLED:
            x, y = agents.positions[a]
            potential = potentials[agents.potential_rows[a]]
            r.courses[a, 0], r.courses[a, 1], _ = direction_at(
                grid, potential, agents.cells[a], x, y
            )
            speed = np.hypot(agents.velocities[a, 0], agents.velocities[a, 1])
            r.held_up[a] = speed < rules["held_up_part"] * agents.parameters[a]["speed_mps"]


@kernel
def order_in_jams(priorities: Priorities, reservations: Reservations) -> None:
    """Give agents in a jam the priority of those who leave or enter it.

    The middle of a jam lies half-way between the agents held up that go in an agent's direction,
    itself included, and those that go in the opposite direction. Positions are summed in whole
    micrometres, so that the result does not depend on the order of agents.
    """
    r = reservations
    rules = r.rules[0]
    held_up = np.flatnonzero(r.held_up)
    if len(held_up) < rules["jam_actors"]:
        return
    for a in range(len(priorities.turns)):
        if priorities.turns[a] == SETTLED:
            continue
        count = np.zeros(2, dtype=np.int64)  # in the same direction, in the opposite direction
        place = np.zeros((2, 2), dtype=np.int64)
        count[0] = 1
        for o in held_up:
            dx = r.paths[o, 0, 0] - r.paths[a, 0, 0]
            dy = r.paths[o, 0, 1] - r.paths[a, 0, 1]
            if (
                o == a
                or dx * dx + dy * dy > rules["jam_m"] * rules["jam_m"]
                or abs(r.heights[o, 0] - r.heights[a, 0]) >= BODIES_OVERLAP_M
            ):
                continue
            along = r.courses[a, 0] * r.courses[o, 0] + r.courses[a, 1] * r.courses[o, 1]
            if abs(along) > rules["against_cosine"]:
                side = 0 if along > 0.0 else 1
                count[side] += 1
                place[side, 0] += int(np.round(1e6 * dx))
                place[side, 1] += int(np.round(1e6 * dy))
        if count[1] < rules["jam_actors"]:
            continue
        mx = 0.5e-6 * (place[0, 0] / count[0] + place[1, 0] / count[1])
        my = 0.5e-6 * (place[0, 1] / count[0] + place[1, 1] / count[1])
        beyond = mx * r.courses[a, 0] + my * r.courses[a, 1] < 0.0
        away = np.sqrt(mx * mx + my * my)
        priorities.turns[a] = LEAVES_JAM if beyond else ENTERS_JAM
        priorities.keys_m[a] = -away if beyond else away
