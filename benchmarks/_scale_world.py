"""A world of many zones as the scale model simulates it: who is where, second by second.

People hop by gravity: from where they are a zone is chosen in proportion to how much it attracts,
and inversely to the square of its distance. Time goes on by seconds; hops, deaths and reconnections
are drawn from a seeded generator.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from benchmarks._scale_constants import Constants
from numpy.typing import NDArray

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]
OWN_M: Final = 0.02
"""Added to distances of zones on a square of side 1, so that the nearest is not all."""
DAY_S: Final = 86_400.0


@dataclass(frozen=True)
class Plan:
    """The settings of a simulation."""

    zones: int
    people: int
    """In all zones together."""
    most_in_zone: int
    seconds: int
    hop_s: float
    """Mean time of a person in a zone."""
    move_s: float
    """Mean time after which a client goes over to the gateway of the zone where its person is, 0
    for at once, infinite if clients stay where they came in."""
    gateway_people: int
    """People for whom a gateway is meant."""
    host_deaths_a_day: float
    """Of each host."""
    gateway_deaths_a_day: float
    attraction: float = 0.5
    """Spread of what attracts people, as the standard deviation of its logarithm."""


@dataclass(frozen=True)
class Second:
    """One second of the world."""

    in_zone: Ints
    """People in each zone (Z,)."""
    frames: int
    """Pairs of a zone and a gateway that has viewers in it: each gets all of its frames."""
    frame_people: float
    """People in the frames of all those pairs together."""
    at_gateway: Ints
    """Viewers of each gateway (G,)."""
    hops: int
    moves: int


@dataclass(frozen=True)
class Run:
    """All seconds, and the pauses of people, seconds (N,), by what died."""

    seconds: list[Second]
    host_pauses_s: Floats
    gateway_pauses_s: Floats
    gateways: int


def simulate(plan: Plan, constants: Constants, random: np.random.Generator) -> Run:
    """Let the world run. Cost O(seconds · (hops a second + zones · gateways of a zone))."""
    chances = _chances(plan, random)
    begins = np.concatenate([[0.0], chances.sum(axis=0).cumsum()])
    zone = np.searchsorted(begins / begins[-1], random.random(plan.people), side="right") - 1
    zone = np.minimum(zone, plan.zones - 1)
    ladder = (chances.cumsum(axis=1) + np.arange(plan.zones)[:, None]).ravel()
    homes = _homes(plan, np.bincount(zone, minlength=plan.zones))
    gateway = _home_of(zone, homes, random)
    seconds: list[Second] = []
    host: list[Floats] = []
    edge: list[Floats] = []
    gateways = int(homes[-1])
    pairs = np.bincount(zone * gateways + gateway, minlength=plan.zones * gateways)
    for _ in range(plan.seconds):
        here = np.bincount(zone, minlength=plan.zones)
        hopping = np.flatnonzero(random.random(plan.people) < 1.0 / plan.hop_s)
        drawn = random.random(len(hopping)) + zone[hopping]
        to = np.searchsorted(ladder, drawn, side="right") - zone[hopping] * plan.zones
        to = np.clip(to, 0, plan.zones - 1)
        room = here[to] < plan.most_in_zone
        hopping, to = hopping[room], to[room]
        _count(pairs, zone, gateway, gateways, hopping, -1)
        zone[hopping] = to
        _count(pairs, zone, gateway, gateways, hopping, 1)
        moving = _who_move(plan, zone, gateway, homes, random)
        _count(pairs, zone, gateway, gateways, moving, -1)
        gateway[moving] = _home_of(zone[moving], homes, random)
        _count(pairs, zone, gateway, gateways, moving, 1)
        here = np.bincount(zone, minlength=plan.zones)
        has = (pairs > 0).reshape(plan.zones, gateways).sum(axis=1)
        at = np.bincount(gateway, minlength=gateways)
        frame_people = float((has * here).sum())
        seconds.append(Second(here, int(has.sum()), frame_people, at, len(hopping), len(moving)))
        host += _host_pauses(plan, constants, here, random)
        edge += _gateway_pauses(plan, constants, at, random)
    return Run(seconds, _joined(host), _joined(edge), gateways)


def _chances(plan: Plan, random: np.random.Generator) -> Floats:
    """The chance of a hop from each zone to each other one, (Z, Z); rows add up to 1."""
    places = random.random((plan.zones, 2))
    pull = random.lognormal(0.0, plan.attraction, plan.zones)
    away = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + OWN_M
    chances = pull[None] / away**2
    if plan.zones > 1:
        np.fill_diagonal(chances, 0.0)
    return np.asarray(chances / chances.sum(axis=1, keepdims=True))


def _homes(plan: Plan, here: Ints) -> Ints:
    """The first gateway of each zone, and the number of all, (Z + 1,)."""
    own = np.maximum(1, np.ceil(here / plan.gateway_people)).astype(np.int64)
    return np.concatenate([[0], own.cumsum()])


def _home_of(zone: Ints, homes: Ints, random: np.random.Generator) -> Ints:
    """A gateway of the zone of each, (N,)."""
    own = homes[zone + 1] - homes[zone]
    found: Ints = homes[zone] + (random.random(len(zone)) * own).astype(np.int64)
    return found


def _who_move(
    plan: Plan, zone: Ints, gateway: Ints, homes: Ints, random: np.random.Generator
) -> Ints:
    if not np.isfinite(plan.move_s):
        return np.empty(0, dtype=np.int64)
    away = np.flatnonzero((gateway < homes[zone]) | (gateway >= homes[zone + 1]))
    return away if plan.move_s < 1.0 else away[random.random(len(away)) < 1.0 / plan.move_s]


def _count(pairs: Ints, zone: Ints, gateway: Ints, gateways: int, who: Ints, by: int) -> None:
    np.add.at(pairs, zone[who] * gateways + gateway[who], by)


def _host_pauses(
    plan: Plan, constants: Constants, here: Ints, random: np.random.Generator
) -> list[Floats]:
    """The pauses of the people in zones whose host has died in this second."""
    dead = np.flatnonzero(random.random(plan.zones) < plan.host_deaths_a_day / DAY_S)
    latest_s = constants.lease_s
    ended_s = random.uniform(latest_s - constants.renew_s, latest_s, len(dead))
    pauses = ended_s + constants.take_over_s * random.uniform(0.5, 1.5, len(dead))
    return [np.full(here[zone], pause) for zone, pause in zip(dead, pauses, strict=True)]


def _gateway_pauses(
    plan: Plan, constants: Constants, at: Ints, random: np.random.Generator
) -> list[Floats]:
    """The same of gateways: all of its people come back at once, to a neighbour of it."""
    dead = np.flatnonzero(random.random(len(at)) < plan.gateway_deaths_a_day / DAY_S)
    return [
        constants.come_back_s * random.uniform(0.5, 1.5, at[one])
        + np.arange(at[one]) / constants.joins_s
        for one in dead
    ]


def _joined(parts: list[Floats]) -> Floats:
    return np.concatenate(parts) if parts else np.empty(0)
