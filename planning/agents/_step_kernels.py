"""Steps that agents take after their plans, on bare arrays: control, last checks and step."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._reservation_kernels import buckets_within
from esplanade.planning.agents._task_kernels import (
    Task,
    World,
    advance,
    further_on_edges,
)
from esplanade.planning.agents.agents import GIVING_WAY, WAITING, Agents, Decisions
from esplanade.planning.compiled.jit import borrowing, inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, clearance_at, floor_of, follow
from esplanade.planning.grid._walking_kernels import walk
from esplanade.planning.ground._geometry_kernels import BarrierIndex, closest_approach
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.scene.heights import BODIES_OVERLAP_M


@inlined
def control_toward(task: Task, x: float, y: float, seconds: float) -> tuple[float, float]:
    """Velocity to aim at so that the actor is at (x, y) after so many seconds."""
    ux = (x - task.x) / seconds
    uy = (y - task.y) / seconds
    for _ in range(4):
        ex, ey, _, _ = advance(
            task.x, task.y, task.vx, task.vy, ux, uy, task.max_acceleration_mps2, seconds
        )
        ux += (x - ex) / seconds
        uy += (y - ey) / seconds
        speed = np.hypot(ux, uy)
        if speed > task.max_speed_mps:
            ux *= task.max_speed_mps / speed
            uy *= task.max_speed_mps / speed
    return ux, uy


@inlined
def limited(task: Task, ux: float, uy: float, tick_s: float) -> tuple[float, float]:
    """The velocity nearest to u that the acceleration limit allows within a tick."""
    dx = ux - task.vx
    dy = uy - task.vy
    change = np.hypot(dx, dy)
    most = task.max_acceleration_mps2 * tick_s
    if change <= most:
        return ux, uy
    return task.vx + dx * most / change, task.vy + dy * most / change


@inlined
def _people_near(world: World, prediction: Prediction, task: Task, near: NDArray[np.int64]) -> int:
    """List the people near an actor into `near`; returns how many they are."""
    count = 0
    near_m = world.rules[0]["people_near_m"]
    feet_m = floor_of(world.grid, task.cell)
    for p in range(len(prediction.means)):
        if (
            abs(prediction.heights[p, 0] - feet_m) < BODIES_OVERLAP_M
            and abs(prediction.means[p, 0, 0] - task.x) <= near_m
            and abs(prediction.means[p, 0, 1] - task.y) <= near_m
        ):
            near[count] = p
            count += 1
    return count


@inlined
def _separation(
    prediction: Prediction,
    near: NDArray[np.int64],
    since: float,
    seconds: float,
    touching_m: float,
    closing_s: float,
    minds_turns: bool,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> float:
    """Smallest distance to the people listed while moving evenly from a to b.

    The move begins `since` seconds from now. People walk on as predicted, or at their newest
    velocity, whichever brings them nearer: whether a change is a turn or noise shows later. If the
    move brings somebody nearer than `touching_m`, `closing_s` times the speed toward them is
    taken off: to be walked into is bad, to walk into somebody is worse.
    """
    best = np.inf
    for n in range(len(near)):
        p = near[n]
        for turned in range(2 if minds_turns else 1):
            vx = prediction.newest[p, 0] if turned else prediction.velocities[p, 0, 0]
            vy = prediction.newest[p, 1] if turned else prediction.velocities[p, 0, 1]
            rx = ax - prediction.means[p, 0, 0] - vx * since
            ry = ay - prediction.means[p, 0, 1] - vy * since
            dx = bx - ax - vx * seconds
            dy = by - ay - vy * seconds
            nearest = closest_approach(rx, ry, dx, dy)
            if nearest < touching_m:
                apart = max(1e-9, np.sqrt(rx * rx + ry * ry))
                toward_mps = -(rx * (bx - ax) + ry * (by - ay)) / (apart * seconds)
                nearest -= closing_s * max(0.0, toward_mps)
            best = min(best, nearest)
    return best


@inlined
def _gap(
    world: World,
    prediction: Prediction,
    near: NDArray[np.int64],
    task: Task,
    need: float,
    seconds: float,
    ux: float,
    uy: float,
) -> float:
    """`_separation` in so many seconds while turning to velocity u; -inf where a wall is."""
    rules = world.rules[0]
    half = 0.5 * seconds
    touching_m = task.radius_m + (world.person_radius_m + rules["sway_m"])
    closing_s = task.contact_closing_s
    a = task.max_acceleration_mps2
    hx, hy, hvx, hvy = advance(task.x, task.y, task.vx, task.vy, ux, uy, a, half)
    ex, ey, _, _ = advance(hx, hy, hvx, hvy, ux, uy, a, half)
    grid = world.grid
    half_cell = follow(grid, task.cell, hx, hy)
    end = follow(grid, half_cell, ex, ey)
    if (
        clearance_at(grid, task.body, half_cell, hx, hy) < need
        or clearance_at(grid, task.body, end, ex, ey) < need
    ):
        return -np.inf
    turns = bool(rules["minds_turns"])
    x, y = task.x, task.y
    return min(
        _separation(prediction, near, 0.0, half, touching_m, closing_s, turns, x, y, hx, hy),
        _separation(prediction, near, half, half, touching_m, closing_s, turns, hx, hy, ex, ey),
    )


@inlined
def _seconds_to_check(
    task: Task, left_m: float, look_ahead_s: float, ux: float, uy: float
) -> float:
    """Seconds for which people must keep clear of an actor that goes on at velocity u.

    They end where the actor stands at its goal: from then on it may evade whoever comes, and people
    who come later keep it from nothing. Half of the time of braking counts, since while the actor
    brakes it goes half as far as at its speed.
    """
    speed = np.hypot(ux, uy)
    if task.hold or speed == 0.0:
        return look_ahead_s
    there_s = max(0.0, left_m - task.goal_tolerance_m) / speed
    return float(min(look_ahead_s, there_s + 0.5 * speed / task.max_acceleration_mps2))


@borrowing
def last_check(
    world: World,
    prediction: Prediction,
    task: Task,
    need: float,
    contact_m: float,
    left_m: float,
    listed: NDArray[np.int64],
    ux: float,
    uy: float,
) -> tuple[float, float, bool]:
    """The wish itself if it touches nobody soon, else the evasion that leaves most room.

    `need` is the distance that evasions keep from walls; a wish comes from a path that does, and
    `walk` slides along what it only just meets. Evasions are stopping and sixteen directions at
    two speeds; the third value tells whether they were tried because of people, not only of walls.
    With `left_m` metres left to its goal the wish is checked until it is there, evasions as long as
    the rules say. `listed` is room for all people.
    Costs O(people) once and O(people near) for each evasion.
    """
    near = listed[: _people_near(world, prediction, task, listed)]
    look_ahead_s = world.rules[0]["look_ahead_s"]
    seconds = _seconds_to_check(task, left_m, look_ahead_s, ux, uy)
    gap = _gap(world, prediction, near, task, -np.inf, seconds, ux, uy)
    if gap >= contact_m:
        return ux, uy, False
    best = min(gap, contact_m) - 1e-6
    bx = ux
    by = uy
    for n in range(33):
        vx = 0.0
        vy = 0.0
        if n > 0:
            speed = task.max_speed_mps * (1.0 if n % 2 == 0 else 0.5)
            angle = ((n - 1) // 2) * np.pi / 8.0
            vx = speed * np.cos(angle)
            vy = speed * np.sin(angle)
        gap = _gap(world, prediction, near, task, need, look_ahead_s, vx, vy)
        gap = min(gap, contact_m + 0.1)
        if gap == -np.inf:
            continue
        score = gap - 0.02 * np.hypot(vx - ux, vy - uy)
        if score > best:
            best = score
            bx = vx
            by = vy
    return bx, by, len(near) > 0


@kernel
def resolve(
    world: World,
    index: BarrierIndex,
    agents: Agents,
    order: NDArray[np.int64],
    tick_s: float,
    decisions: Decisions,
    new_positions: NDArray[np.float64],
    new_cells: NDArray[np.int64],
) -> None:
    """Take the steps in rank order so that no two actors touch.

    Each actor keeps clear of the steps already taken and of the places of those still to move,
    so that standing still remains possible for everyone who comes after.
    """
    sidesteps = world.rules[0]["sidesteps"]
    moved = np.zeros(len(order), dtype=np.bool_)
    new_positions[:] = agents.positions
    new_cells[:] = agents.cells
    for n in range(len(order)):
        a = order[n]
        x = agents.positions[a, 0]
        y = agents.positions[a, 1]
        need = min(
            agents.parameters[a]["radius_m"],
            max(0.0, clearance_at(world.grid, agents.bodies[a], agents.cells[a], x, y)),
        )
        moved[a] = True
        wx = decisions.wishes[a, 0]
        wy = decisions.wishes[a, 1]
        if wx == 0.0 and wy == 0.0:
            continue
        for trial in range(7):
            if 0 < trial < 6 and not sidesteps:
                continue
            vx, vy = _alternative(wx, wy, trial)
            cell, ex, ey = walk(
                world.grid,
                index,
                agents.parameters[a]["height_m"],
                agents.parameters[a]["step_on_m"],
                agents.parameters[a]["leg_length_m"],
                agents.cells[a],
                x,
                y,
                vx * tick_s,
                vy * tick_s,
                need - 1e-6,
            )
            if trial == 6 or not _touches(world, agents, moved, new_positions, a, ex, ey):
                new_positions[a, 0] = ex
                new_positions[a, 1] = ey
                new_cells[a] = cell
                if trial > 0:
                    stands = np.hypot(ex - x, ey - y) < 0.15 * tick_s
                    decisions.reasons[a] = WAITING if stands else GIVING_WAY
                break


@kernel
def settle(
    grid: GridArrays,
    rules: np.void,
    agents: Agents,
    decisions: Decisions,
    positions: NDArray[np.float64],
    cells: NDArray[np.int64],
    tick_s: float,
) -> None:
    """Take the result of a tick over into `agents`; an agent that walks faces where it goes."""
    for a in range(len(positions)):
        vx = (positions[a, 0] - agents.positions[a, 0]) / tick_s
        vy = (positions[a, 1] - agents.positions[a, 1]) / tick_s
        agents.velocities[a, 0] = vx
        agents.velocities[a, 1] = vy
        agents.on_edges[a] = further_on_edges(
            grid,
            agents.bodies[a],
            agents.cells[a],
            cells[a],
            positions[a, 0] - agents.positions[a, 0],
            positions[a, 1] - agents.positions[a, 1],
            agents.on_edges[a],
        )
        agents.positions[a] = positions[a]
        agents.cells[a] = cells[a]
        if decisions.renewed[a]:
            agents.followed[a] = decisions.paths[a]
            agents.ages[a] = 0
        agents.ages[a] += 1
        agents.known[a] = True
        if np.hypot(vx, vy) > rules["heading_mps"]:
            agents.headings[a] = np.arctan2(vy, vx)


@kernel
def _alternative(wx: float, wy: float, n: int) -> tuple[float, float]:
    """The wish, then half of it, then sidesteps to either side, then standing."""
    if n == 0:
        return wx, wy
    if n == 1:
        return 0.5 * wx, 0.5 * wy
    if n == 6:
        return 0.0, 0.0
    side = 0.5 if n % 2 == 0 else -0.5
    back = 0.3 if n < 4 else -0.3
    return back * wx - side * wy, back * wy + side * wx


@kernel
def _touches(
    world: World,
    agents: Agents,
    moved: NDArray[np.bool_],
    new_positions: NDArray[np.float64],
    a: int,
    ex: float,
    ey: float,
) -> bool:
    """Whether actor a, moving to (ex, ey), comes closer than it may to another actor."""
    r = world.reservations
    x = agents.positions[a, 0]
    y = agents.positions[a, 1]
    margin_m = world.rules[0]["step_margin_m"]
    j0, j1, i0, i1 = buckets_within(r, x, y, 2.0 * (r.widest_m + r.fastest_m) + margin_m)
    for j in range(j0, j1 + 1):
        row = j * r.nx  # buckets of a row are listed one after the other
        for m in range(r.starts[0, row + i0], r.starts[0, row + i1 + 1]):
            o = r.members[0, m]
            if o == a or abs(r.heights[o, 0] - r.heights[a, 0]) >= BODIES_OVERLAP_M:
                continue
            rx = x - agents.positions[o, 0]
            ry = y - agents.positions[o, 1]
            dx = ex - x
            dy = ey - y
            if moved[o]:
                dx -= new_positions[o, 0] - agents.positions[o, 0]
                dy -= new_positions[o, 1] - agents.positions[o, 1]
            d = closest_approach(rx, ry, dx, dy)
            if d < r.radii[a] + r.radii[o] + margin_m and d < np.hypot(rx, ry) - 1e-9:
                return True
    return False
