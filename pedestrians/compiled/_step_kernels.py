"""One tick of all people who are there: from a finished state to the next one."""

import math

import numpy as np

from esplanade.pedestrians.compiled._force_kernels import beyond, evasion, slide, wall_push
from esplanade.pedestrians.compiled._neighbour_kernels import (
    NEAREST,
    cells_of,
    find_nearest,
    sort_into_buckets,
)
from esplanade.pedestrians.compiled.records import Numbers, Paths, State, Surroundings
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from esplanade.planning.compiled.jit import kernel

BACK_M = 1e-3
"""Distance to the recorded place, and below it deviation of velocity, within which a person is on
the recording again."""
BACK_MPS = 1e-2
PASSING_MPS = 0.1
"""A person who was recorded slower than this stands; time alone leads on along such a path."""


@kernel
def recorded_place(paths: Paths, person: int, own: float) -> tuple[float, float]:
    """The place of a path after `own` ticks, metres; the last place after its end."""
    begin = paths.begins[person]
    last = paths.begins[person + 1] - begin - 1
    k = min(int(own), last)
    share = own - k
    x, y = paths.places[begin + k, 0], paths.places[begin + k, 1]
    if k == last or share == 0.0:
        return x, y
    return (
        x + share * (paths.places[begin + k + 1, 0] - x),
        y + share * (paths.places[begin + k + 1, 1] - y),
    )


@kernel
def recorded_velocity(paths: Paths, person: int, own: float, tick_s: float) -> tuple[float, float]:
    """The velocity of a path after `own` ticks, m/s; 0 if it is a single place."""
    begin = paths.begins[person]
    k = min(int(own), paths.begins[person + 1] - begin - 2)
    if k < 0:
        return 0.0, 0.0
    here, there = paths.places[begin + k], paths.places[begin + k + 1]
    return (there[0] - here[0]) / tick_s, (there[1] - here[1]) / tick_s


@kernel
def _pushes(
    body: int,
    found: Ints,
    count: int,
    bodies: Floats,
    present: Ints,
    paths: Paths,
    now: State,
    around: Surroundings,
    numbers: Numbers,
) -> tuple[float, float]:
    """Acceleration of a person by those nearest, beyond what they did to it in the recording."""
    person = present[body]
    strength = around.strengths_mps2[person]
    x, y, vx, vy = bodies[body, 0], bodies[body, 1], bodies[body, 2], bodies[body, 3]
    own = now.own_ticks[person]
    was_x, was_y = recorded_place(paths, person, own)
    was_vx, was_vy = recorded_velocity(paths, person, own, numbers.tick_s)
    sum_x, sum_y = 0.0, 0.0
    for k in range(count):
        other = found[k]
        if other < present.shape[0]:
            neighbour = present[other]
            if not now.moved[person] and not now.moved[neighbour]:
                continue
        else:
            neighbour = around.stand_ins[other - present.shape[0]]
        to = bodies[other]
        ax, ay = evasion(to[0] - x, to[1] - y, vx, vy, to[2], to[3], to[4], numbers)
        rx, ry = 0.0, 0.0
        if neighbour >= 0:
            then = paths.first[person] + own - paths.first[neighbour]
            if 0.0 <= then <= paths.begins[neighbour + 1] - paths.begins[neighbour] - 1:
                there_x, there_y = recorded_place(paths, neighbour, then)
                ux, uy = recorded_velocity(paths, neighbour, then, numbers.tick_s)
                rx, ry = evasion(
                    there_x - was_x, there_y - was_y, was_vx, was_vy, ux, uy, 0.0, numbers
                )
        px, py = beyond(ax, ay, rx, ry)
        sum_x += strength * px
        sum_y += strength * py
    return sum_x, sum_y


@kernel
def _walk_on(
    person: int,
    push_x: float,
    push_y: float,
    tick: int,
    paths: Paths,
    now: State,
    after: State,
    walls: Floats,
    passes: Bools,
    numbers: Numbers,
) -> None:
    """Write where a person is after this tick."""
    dt = numbers.tick_s
    own = now.own_ticks[person]
    due = tick + 1.0 - paths.first[person]
    x, y = now.places[person, 0], now.places[person, 1]
    was_x, was_y = recorded_place(paths, person, own)
    vx, vy = recorded_velocity(paths, person, own, dt)
    late_s = max(0.0, (due - 1.0 - own) * dt)
    faster = min(numbers.hurry - 1.0, late_s / numbers.return_s)
    wx, wy = now.deviations[person, 0], now.deviations[person, 1]
    wanted_x = faster * vx - (x - was_x) / numbers.return_s
    wanted_y = faster * vy - (y - was_y) / numbers.return_s
    wx += dt * ((wanted_x - wx) / numbers.relaxation_s + push_x)
    wy += dt * ((wanted_y - wy) / numbers.relaxation_s + push_y)
    speed = math.hypot(vx + wx, vy + wy)
    recorded = math.hypot(vx, vy)
    share = min(1.0, numbers.hurry * max(recorded, numbers.usual_speed_mps) / max(speed, 1e-9))
    step = np.empty(2)
    step[0], step[1] = share * (vx + wx) * dt, share * (vy + wy) * dt
    slide(x, y, step, walls, passes, numbers.wall_margin_m)
    x += step[0]
    y += step[1]
    wx, wy = step[0] / dt - vx, step[1] / dt - vy
    there_x, there_y = recorded_place(paths, person, due)
    if math.hypot(x - there_x, y - there_y) < BACK_M and math.hypot(wx, wy) < BACK_MPS:
        after.places[person, 0], after.places[person, 1] = there_x, there_y
        after.deviations[person] = 0.0
        after.own_ticks[person] = due
        after.moved[person] = False
        return
    on = 2.0
    if recorded > PASSING_MPS:
        on = ((x - was_x) * vx + (y - was_y) * vy) / (recorded * recorded * dt)
    after.places[person, 0], after.places[person, 1] = x, y
    after.deviations[person, 0], after.deviations[person, 1] = wx, wy
    after.own_ticks[person] = min(due, own + min(2.0, max(0.0, on)))
    after.moved[person] = True


@kernel
def step(
    present: Ints,
    tick: int,
    paths: Paths,
    now: State,
    after: State,
    around: Surroundings,
    numbers: Numbers,
) -> None:
    """Move the people who are there, `present` (P,), from `tick` to the next one.

    Everyone sees the finished state `now`, and writes the own row of `after`, so the order of
    people means nothing. Cost: P + A bodies, at most NEAREST reactions each; who is not on the
    recording looks at all walls.
    """
    people, actors = present.shape[0], around.actors.shape[0]
    bodies = np.zeros((people + actors, 5))
    for k in range(people):
        person = present[k]
        ux, uy = recorded_velocity(paths, person, now.own_ticks[person], numbers.tick_s)
        bodies[k, 0], bodies[k, 1] = now.places[person, 0], now.places[person, 1]
        bodies[k, 2] = ux + now.deviations[person, 0]
        bodies[k, 3] = uy + now.deviations[person, 1]
    for k in range(actors):
        bodies[people + k] = around.actors[k]
    cells = cells_of(bodies[:, :2], numbers.range_m)
    order, begins = sort_into_buckets(cells)
    found, squares = np.empty(NEAREST, np.int64), np.empty(NEAREST)
    for k in range(people):
        person = present[k]
        count = find_nearest(k, bodies, cells, order, begins, numbers.range_m, found, squares)
        push_x, push_y = _pushes(k, found, count, bodies, present, paths, now, around, numbers)
        passes = around.passes[person]
        if now.moved[person]:
            own = now.own_ticks[person]
            ax, ay = wall_push(bodies[k, 0], bodies[k, 1], around.walls, passes, numbers)
            was_x, was_y = recorded_place(paths, person, own)
            rx, ry = wall_push(was_x, was_y, around.walls, passes, numbers)
            px, py = beyond(ax, ay, rx, ry)
            push_x += px
            push_y += py
        elif push_x == 0.0 and push_y == 0.0:
            due = tick + 1.0 - paths.first[person]
            there_x, there_y = recorded_place(paths, person, due)
            after.places[person, 0], after.places[person, 1] = there_x, there_y
            after.deviations[person] = 0.0
            after.own_ticks[person] = due
            after.moved[person] = False
            continue
        _walk_on(person, push_x, push_y, tick, paths, now, after, around.walls, passes, numbers)
