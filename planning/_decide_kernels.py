"""One tick's decisions for many actors, on bare arrays.

Everyone reads the state of the finished tick and writes its own row, so rows may be worked on in
any order and on any number of threads; only `resolve` runs through the actors in rank order.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._geometry_kernels import SegmentIndex, closest_approach, slide
from planning._grid_kernels import clearance_at
from planning._jit import kernel
from planning._perturb_kernels import path_cost, stretch_is_legal, update_path
from planning._potential_kernels import direction_at, potential_at
from planning._prediction_kernels import Prediction
from planning._risk_kernels import separation_from_people
from planning._search_kernels import (
    NO_PATH,
    SUB,
    Moves,
    Task,
    Workspace,
    World,
    advance,
    needed_clearance,
    search,
)

MOVING = 1
GIVING_WAY = 2
WAITING = 3
REPLANNING = 4
BLOCKED = 5
ARRIVED = 6

PARAMETERS = np.dtype(
    [
        ("radius_m", "f8"),
        ("speed_mps", "f8"),
        ("max_speed_mps", "f8"),
        ("max_acceleration_mps2", "f8"),
        ("goal_tolerance_m", "f8"),
        ("person_clearance_m", "f8"),
        ("risk_weight", "f8"),
        ("foresight_s", "f8"),
        ("closing_weight", "f8"),
        ("turn_weight", "f8"),
        ("wall_weight", "f8"),
        ("hysteresis_s", "f8"),
        ("max_expansions", "f8"),
    ]
)
"""What kernels know of an actor's parameters; one field each, in the units of their names."""


class Crowd(NamedTuple):
    """State of A actors; every array has A rows.

    `guide_slots` is the row of the guide pool, -1 without a goal; `known` tells whether `followed`
    holds a path; `followed` (A, K, 2) begins at the tick that `ages` (A,) ticks ago was.
    """

    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    layers: NDArray[np.int64]
    goals: NDArray[np.float64]
    guide_slots: NDArray[np.int64]
    parameters: NDArray[np.void]
    ranks: NDArray[np.int64]
    known: NDArray[np.bool_]
    ages: NDArray[np.int64]
    followed: NDArray[np.float64]


class Decisions(NamedTuple):
    """What the actors decided; every array has A rows.

    `paths` (A, K, 2); `wishes` (A, 2) m/s for the next tick; `reasons`; `statuses` of the
    searches; `expansions`; `renewed` tells that `paths` replaces what was followed.
    """

    paths: NDArray[np.float64]
    wishes: NDArray[np.float64]
    reasons: NDArray[np.int64]
    statuses: NDArray[np.int64]
    expansions: NDArray[np.int64]
    renewed: NDArray[np.bool_]


@kernel
def make_task(
    world: World, guides: NDArray[np.float32], crowd: Crowd, a: int, max_hold_m: float
) -> Task:
    """The question that actor a asks this tick. Without a goal or a way to it, it stays around."""
    p = crowd.parameters[a]
    layer = crowd.layers[a]
    x = crowd.positions[a, 0]
    y = crowd.positions[a, 1]
    gx = crowd.goals[a, 0]
    gy = crowd.goals[a, 1]
    slot = crowd.guide_slots[a]
    hold = slot < 0
    if not hold:
        left = potential_at(world.grid, guides[slot], layer, x, y)
        if not np.isfinite(left):
            hold = True
            gx = x
            gy = y
        elif left <= max_hold_m:
            hold = True
    else:
        gx = x
        gy = y
    return Task(
        a,
        layer,
        x,
        y,
        crowd.velocities[a, 0],
        crowd.velocities[a, 1],
        gx,
        gy,
        p.radius_m,
        p.speed_mps,
        p.max_speed_mps,
        p.max_acceleration_mps2,
        p.goal_tolerance_m,
        p.risk_weight,
        p.foresight_s,
        p.closing_weight,
        p.turn_weight,
        p.wall_weight,
        int(p.max_expansions),
        hold,
    )


@kernel
def continue_paths(
    world: World,
    guides: NDArray[np.float32],
    crowd: Crowd,
    tick_s: float,
    first: int,
    last: int,
    out: NDArray[np.float64],
) -> None:
    """Followed paths as seen from now, rows first..last of out (A, K, 2).

    A path is read off `ages` ticks after its start, begins where the actor really is, and is
    lengthened at its end down the potential. Who follows none is taken to stand.
    """
    slices = out.shape[1]
    ds = world.step_s / SUB
    for a in range(first, last):
        px = crowd.positions[a, 0]
        py = crowd.positions[a, 1]
        if not crowd.known[a]:
            out[a, :, 0] = px
            out[a, :, 1] = py
            continue
        path = crowd.followed[a]
        shift = crowd.ages[a] * tick_s / ds
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
                    guides,
                    crowd,
                    a,
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


@kernel
def _carry_on(
    world: World,
    guides: NDArray[np.float32],
    crowd: Crowd,
    a: int,
    x: float,
    y: float,
    seconds: float,
) -> tuple[float, float]:
    """Where an actor gets from the end of its path, straight down the potential."""
    slot = crowd.guide_slots[a]
    if slot < 0:
        return x, y
    gx, gy, leg = direction_at(world.grid, guides[slot], crowd.layers[a], x, y)
    way = min(leg, crowd.parameters[a].speed_mps * seconds)
    return x + gx * way, y + gy * way


@kernel
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


@kernel
def limited(task: Task, ux: float, uy: float, tick_s: float) -> tuple[float, float]:
    """The velocity nearest to u that the acceleration limit allows within a tick."""
    dx = ux - task.vx
    dy = uy - task.vy
    change = np.hypot(dx, dy)
    most = task.max_acceleration_mps2 * tick_s
    if change <= most:
        return ux, uy
    return task.vx + dx * most / change, task.vy + dy * most / change


@kernel
def _gap(
    world: World,
    prediction: Prediction,
    task: Task,
    need: float,
    ux: float,
    uy: float,
    seconds: float,
) -> float:
    """Smallest distance to people while turning to velocity u; negative where a wall is."""
    half = 0.5 * seconds
    a = task.max_acceleration_mps2
    hx, hy, hvx, hvy = advance(task.x, task.y, task.vx, task.vy, ux, uy, a, half)
    ex, ey, _, _ = advance(hx, hy, hvx, hvy, ux, uy, a, half)
    if (
        clearance_at(world.grid, task.layer, hx, hy) < need
        or clearance_at(world.grid, task.layer, ex, ey) < need
    ):
        return -1.0
    first = separation_from_people(
        prediction, task.layer, task.x, task.y, hx - task.x, hy - task.y, half
    )
    best = first
    for p in range(len(prediction.layers)):
        if prediction.layers[p] != task.layer:
            continue
        rx = hx - prediction.means[p, 0, 0] - prediction.velocities[p, 0, 0] * half
        ry = hy - prediction.means[p, 0, 1] - prediction.velocities[p, 0, 1] * half
        if abs(rx) > 4.0 or abs(ry) > 4.0:
            continue
        d = closest_approach(
            rx,
            ry,
            ex - hx - prediction.velocities[p, 0, 0] * half,
            ey - hy - prediction.velocities[p, 0, 1] * half,
        )
        best = min(best, d)
    return best


@kernel
def last_check(
    world: World,
    prediction: Prediction,
    task: Task,
    contact_m: float,
    ux: float,
    uy: float,
) -> tuple[float, float, bool]:
    """The wish itself when nobody would be touched soon, else the way out that leaves most room.

    Ways out are stopping and sixteen directions at two speeds; the third value tells that one was
    taken. Looks 0.6 s ahead.
    """
    seconds = 0.6
    need = needed_clearance(world, task)
    gap = _gap(world, prediction, task, need, ux, uy, seconds)
    if gap >= contact_m:
        return ux, uy, False
    best = min(gap, contact_m) - 1e-6 if gap >= 0.0 else -np.inf
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
        gap = min(_gap(world, prediction, task, need, vx, vy, seconds), contact_m + 0.1)
        if gap < 0.0:
            continue
        score = gap - 0.02 * np.hypot(vx - ux, vy - uy)
        if score > best:
            best = score
            bx = vx
            by = vy
    return bx, by, True


@kernel
def decide(
    world: World,
    guides: NDArray[np.float32],
    no_guide: NDArray[np.float32],
    moves: Moves,
    prediction: Prediction,
    crowd: Crowd,
    tick_s: float,
    first: int,
    last: int,
    workspace: Workspace,
    out: Decisions,
) -> None:
    """Search anew, perturb the followed path, keep the better, and wish for a velocity.

    Actors first..last. Followed paths, seen from now, are `world.reservations.paths`. The
    speeds of `moves` are parts of each actor's own.
    """
    slices = out.paths.shape[1]
    speeds = np.empty(len(moves.speeds))
    kept = np.empty((slices, 2))
    bent = np.empty((slices, 2))
    trial = np.empty((slices, 2))
    for a in range(first, last):
        p = crowd.parameters[a]
        task = make_task(world, guides, crowd, a, p.goal_tolerance_m)
        slot = crowd.guide_slots[a]
        guide = guides[slot] if slot >= 0 else no_guide
        for m in range(len(moves.speeds)):
            part = moves.speeds[m]
            speeds[m] = task.max_speed_mps if part > 1.0 else part * task.speed_mps
        own = Moves(moves.cosines, moves.sines, speeds, moves.straight, True)
        found = search(world, guide, own, task, True, workspace, out.paths[a])
        out.statuses[a] = found.status
        out.expansions[a] = found.expansions
        out.renewed[a] = True
        switched = False
        if crowd.known[a]:
            kept[:] = world.reservations.paths[a]
            need = needed_clearance(world, task)
            if stretch_is_legal(world, guide, task, need, kept, 0, slices - 1):
                cost, risk = path_cost(world, guide, task, kept)
                bent[:] = kept
                changed = False
                if update_path(world, guide, task, bent, trial) > 0:
                    bent_cost, bent_risk = path_cost(world, guide, task, bent)
                    if bent_risk < risk and bent_cost < cost:
                        cost = bent_cost
                        kept[:] = bent
                        changed = True
                new_cost = path_cost(world, guide, task, out.paths[a])[0]
                if found.status != NO_PATH and new_cost < cost - p.hysteresis_s:
                    switched = True
                else:
                    out.paths[a] = kept
                    out.renewed[a] = changed
            else:
                switched = True
        path = out.paths[a]
        ux, uy = control_toward(task, path[SUB, 0], path[SUB, 1], world.step_s)
        contact = p.radius_m + p.person_clearance_m
        ux, uy, dodged = last_check(world, prediction, task, contact, ux, uy)
        wx, wy = limited(task, ux, uy, tick_s)
        out.wishes[a, 0] = wx
        out.wishes[a, 1] = wy
        out.reasons[a] = _reason(crowd, task, path, found.status, switched, dodged, world.step_s)


@kernel
def _reason(
    crowd: Crowd,
    task: Task,
    path: NDArray[np.float64],
    status: int,
    switched: bool,
    dodged: bool,
    step_s: float,
) -> int:
    """Why the actor does what it does."""
    slot = crowd.guide_slots[task.me]
    if dodged:
        return GIVING_WAY
    if slot >= 0 and task.hold and task.goal_x != crowd.goals[task.me, 0]:
        return BLOCKED
    if slot < 0:
        return WAITING
    if task.hold:
        return ARRIVED
    if status == NO_PATH:
        return BLOCKED
    ramp = 2 * SUB  # from a stand it takes so many slices to get going
    ahead = 2 * ramp
    pace = np.hypot(path[ahead, 0] - path[ramp, 0], path[ahead, 1] - path[ramp, 1]) / (2.0 * step_s)
    away = np.hypot(task.goal_x - task.x, task.goal_y - task.y)
    standing = np.hypot(task.vx, task.vy) < 0.15 * task.speed_mps
    if standing and pace < 0.15 * task.speed_mps and away > 4.0 * task.speed_mps * step_s:
        return WAITING
    if pace < 0.6 * task.speed_mps and away > 4.0 * task.speed_mps * step_s:
        return GIVING_WAY
    if switched:
        return REPLANNING
    return MOVING


@kernel
def resolve(
    world: World,
    index: SegmentIndex,
    bounds: tuple[float, float, float, float],
    crowd: Crowd,
    order: NDArray[np.int64],
    tick_s: float,
    decisions: Decisions,
    new_positions: NDArray[np.float64],
) -> None:
    """Take the steps in rank order so that no two actors touch.

    Each actor keeps clear of the steps already taken and of the places of those still to move,
    so that standing still remains possible for everyone who comes after.
    """
    moved = np.zeros(len(order), dtype=np.bool_)
    new_positions[:] = crowd.positions
    for n in range(len(order)):
        a = order[n]
        x = crowd.positions[a, 0]
        y = crowd.positions[a, 1]
        need = min(
            crowd.parameters[a].radius_m,
            max(0.0, clearance_at(world.grid, crowd.layers[a], x, y)),
        )
        moved[a] = True
        wx = decisions.wishes[a, 0]
        wy = decisions.wishes[a, 1]
        if wx == 0.0 and wy == 0.0:
            continue
        for trial in range(7):
            vx, vy = _alternative(wx, wy, trial)
            ex, ey = slide(index, bounds, x, y, vx * tick_s, vy * tick_s, need - 1e-6)
            if trial == 6 or not _touches(world, crowd, moved, new_positions, a, ex, ey):
                new_positions[a, 0] = ex
                new_positions[a, 1] = ey
                if trial > 0:
                    stands = np.hypot(ex - x, ey - y) < 0.15 * tick_s
                    decisions.reasons[a] = WAITING if stands else GIVING_WAY
                break


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
    crowd: Crowd,
    moved: NDArray[np.bool_],
    new_positions: NDArray[np.float64],
    a: int,
    ex: float,
    ey: float,
) -> bool:
    """Whether actor a, moving to (ex, ey), comes closer than it may to another actor."""
    r = world.reservations
    x = crowd.positions[a, 0]
    y = crowd.positions[a, 1]
    ci = min(r.nx - 1, max(0, int((x - r.x0) / r.bucket_m)))
    cj = min(r.ny - 1, max(0, int((y - r.y0) / r.bucket_m)))
    for j in range(max(0, cj - 1), min(r.ny, cj + 2)):
        for i in range(max(0, ci - 1), min(r.nx, ci + 2)):
            b = j * r.nx + i
            for m in range(r.starts[0, b], r.starts[0, b + 1]):
                o = r.members[0, m]
                if o == a or crowd.layers[o] != crowd.layers[a]:
                    continue
                rx = x - crowd.positions[o, 0]
                ry = y - crowd.positions[o, 1]
                dx = ex - x
                dy = ey - y
                if moved[o]:
                    dx -= new_positions[o, 0] - crowd.positions[o, 0]
                    dy -= new_positions[o, 1] - crowd.positions[o, 1]
                reach = r.radii[a] + r.radii[o] + 0.01
                d = closest_approach(rx, ry, dx, dy)
                if d < reach and d < np.hypot(rx, ry) - 1e-9:
                    return True
    return False
