"""One tick of reacting people, person by person, by angles and complex numbers."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field

from esplanade.pedestrians.compiled._neighbour_kernels import NEAREST
from esplanade.pedestrians.compiled._step_kernels import BACK_M, BACK_MPS, PASSING_MPS
from esplanade.pedestrians.model import SocialForce
from tests.naive.geometry import segments_meet

Line = tuple[complex, complex]


@dataclass
class Person:
    """A recorded path, place by place from tick `first`, and where the person is on it."""

    path: list[complex]
    first: int
    place: complex
    deviation: complex = 0j
    own: float = 0.0
    strength: float = 4.5
    passes: set[int] = field(default_factory=set)

    def recorded(self, own: float) -> complex:
        k = min(int(own), len(self.path) - 1)
        if k == len(self.path) - 1 or own == k:
            return self.path[k]
        return self.path[k] + (own - k) * (self.path[k + 1] - self.path[k])

    def pace(self, own: float, tick_s: float) -> complex:
        if len(self.path) < 2:
            return 0j
        k = min(int(own), len(self.path) - 2)
        return (self.path[k + 1] - self.path[k]) / tick_s


@dataclass
class Actor:
    place: complex
    velocity: complex
    radius_m: float = 0.25
    instead_of: Person | None = None


def evasion(
    model: SocialForce, to: complex, own: complex, other: complex, wider_m: float
) -> complex:
    """The acceleration of one body by another that is `to` away; both have a velocity."""
    away = abs(to)
    if away < 1e-9:
        return 0j
    toward = to / away
    interaction = model.velocity_share_s * (own - other) + toward
    if abs(interaction) < 1e-9:
        return 0j
    along = interaction / abs(interaction)
    reach = model.reach_m * abs(interaction)
    angle = cmath.phase(toward / along) * 0.5 / (0.5 + wider_m) + reach * model.side_bias
    near = math.exp(-max(0.0, away - wider_m) / reach)
    slowing = near * math.exp(-((model.slowing * reach * angle) ** 2))
    turning = math.copysign(near * math.exp(-((model.turning * reach * angle) ** 2)), angle)
    seen = abs(own) <= 0.05 or (abs(cmath.phase(toward / own)) <= math.radians(model.sight_deg / 2))
    return -(1.0 if seen else model.unseen) * along * complex(slowing, turning)


def wall_push(model: SocialForce, place: complex, walls: list[Line], passes: set[int]) -> complex:
    nearest = 10.0 * model.wall_reach_m
    push = 0j
    for m, (a, b) in enumerate(walls):
        if m in passes:
            continue
        share = ((place - a) / (b - a)).real
        offset = place - (a + min(1.0, max(0.0, share)) * (b - a))
        if abs(offset) < nearest:
            nearest = abs(offset)
            strength = model.wall_strength_mps2 * math.exp(-nearest / model.wall_reach_m)
            push = strength * offset / nearest if nearest > 1e-9 else 0j
    return push


def beyond(acts: complex, acted: complex) -> complex:
    return acts if acted == 0 else acts - min(1.0, abs(acts) / abs(acted)) * acted


def moved(person: Person, tick: int) -> bool:
    return (
        person.place != person.recorded(tick - person.first)
        or person.own != tick - person.first
        or person.deviation != 0
    )


def step(
    people: list[Person],
    actors: list[Actor],
    walls: list[Line],
    model: SocialForce,
    tick: int,
    tick_s: float,
) -> list[tuple[complex, complex, float]]:
    """Place, deviation and own time of all people after the tick; all of them are there."""
    after = []
    for person in people:
        velocity = person.pace(person.own, tick_s) + person.deviation
        others: list[tuple[float, int, complex]] = []
        bodies: list[Person | Actor] = [*people, *actors]
        for number, other in enumerate(bodies):
            away = abs(other.place - person.place)
            if other is not person and away < model.range_m:
                if isinstance(other, Person):
                    acts = evasion(
                        model, other.place - person.place, velocity,
                        other.pace(other.own, tick_s) + other.deviation, 0.0,
                    )  # fmt: skip
                    recorded: Person | None = other
                else:
                    acts = evasion(
                        model, other.place - person.place, velocity, other.velocity,
                        other.radius_m - 0.25,
                    )  # fmt: skip
                    recorded = other.instead_of
                acted = 0j
                if recorded is not None:
                    then = person.first + person.own - recorded.first
                    if 0 <= then <= len(recorded.path) - 1:
                        acted = evasion(
                            model, recorded.recorded(then) - person.recorded(person.own),
                            person.pace(person.own, tick_s), recorded.pace(then, tick_s), 0.0,
                        )  # fmt: skip
                push = person.strength * beyond(acts, acted)
                if isinstance(other, Person) and not moved(person, tick) and not moved(other, tick):
                    push = 0j
                others.append((away**2, number, push))
        push = sum((push for *_, push in sorted(others, key=lambda o: o[:2])[:NEAREST]), 0j)
        after.append(_walk_on(person, push, walls, model, tick, tick_s))
    return after


def _walk_on(
    person: Person, push: complex, walls: list[Line], model: SocialForce, tick: int, tick_s: float
) -> tuple[complex, complex, float]:
    due = tick + 1.0 - person.first
    if not moved(person, tick) and push == 0:
        return person.recorded(due), 0j, due
    was, pace = person.recorded(person.own), person.pace(person.own, tick_s)
    if moved(person, tick):
        push += beyond(
            wall_push(model, person.place, walls, person.passes),
            wall_push(model, was, walls, person.passes),
        )
    late_s = (due - 1.0 - person.own) * tick_s
    wanted = min(model.hurry - 1.0, late_s / model.return_s) * pace
    wanted -= (person.place - was) / model.return_s
    deviation = person.deviation
    deviation += tick_s * ((wanted - deviation) / model.relaxation_s + push)
    velocity = pace + deviation
    greatest = model.hurry * max(abs(pace), model.usual_speed_mps)
    if abs(velocity) > greatest:
        velocity *= greatest / abs(velocity)
    way = _along_walls(person.place, velocity * tick_s, walls, person.passes, model.wall_margin_m)
    place, deviation = person.place + way, way / tick_s - pace
    if abs(place - person.recorded(due)) < BACK_M and abs(deviation) < BACK_MPS:
        return person.recorded(due), 0j, due
    on = 2.0
    if abs(pace) > PASSING_MPS:
        on = ((place - was) / (pace * tick_s)).real
    return place, deviation, min(due, person.own + min(2.0, max(0.0, on)))


def _along_walls(
    place: complex, way: complex, walls: list[Line], passes: set[int], margin_m: float
) -> complex:
    for _ in range(2):
        met = _first_met(place, way, walls, passes, margin_m)
        if met is None:
            return way
        along = met[1] - met[0]
        way = along * (way / along).real
    return way if _first_met(place, way, walls, passes, margin_m) is None else 0j


def _first_met(
    place: complex, way: complex, walls: list[Line], passes: set[int], margin_m: float
) -> Line | None:
    if abs(way) < 1e-12:
        return None
    end = place + way * (1.0 + margin_m / abs(way))
    met = []
    for m, (a, b) in enumerate(walls):
        corners = [(p.real, p.imag) for p in (place, end, a, b)]
        if m in passes or not segments_meet(*corners):
            continue
        turn = ((end - place).conjugate() * (b - a)).imag
        if abs(turn) > 1e-15:
            share = ((a - place).conjugate() * (b - a)).imag / turn
            met.append((share, m))
    return walls[min(met)[1]] if met else None
