"""One run of a fork: its figures, and the course of some of them over time."""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.whatif.changes import Changes, People
from esplanade.server.whatif.encounters import Encounters
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.whatif.fork import Fork
from esplanade.server.whatif.reacting_walkers import ReactingWalkers
from esplanade.server.whatif.stretch import Stretch
from esplanade.server.whatif.trip_times import TripTimes
from esplanade.server.whatif.walkers import RecordedWalkers, Walkers
from esplanade.server.world.frame import Frame
from esplanade.server.world.zone import Zone

Floats = NDArray[np.float64]

PIECES: Final = 60
"""The strip of differences has at most so many pieces, none shorter than a second."""


@dataclass(frozen=True)
class Plan:
    """One run: a change or none, among people of a kind, by a seed or with recorded chance."""

    changes: Changes
    people: People
    seed: int | None


@dataclass(frozen=True)
class Run:
    """The figures of a run."""

    plan: Plan
    figures: dict[str, float]
    """By the names of `measures.MEASURES`; nan where there is none."""
    conflicts_s: Floats
    """(P,): seconds of people in conflict, in each piece of the stretch."""
    places: dict[Hashable, Floats]
    """The place (P, 2), metres, of each actor at the end of each piece; nan where there is none."""
    planning_failed: int
    """Ticks in which nothing could be planned."""


def run(
    replayed: ReplayedZone,
    stretch: Stretch,
    plan: Plan,
    told: Callable[[Frame], None] = lambda _: None,
) -> Run:
    """Run a stretch and measure it; each frame is `told`, and what that raises ends the run.

    Raises
    ------
    WhatIfError
        The changes cannot be made.
    """
    walkers: Walkers = RecordedWalkers(stretch)
    if plan.people == "reacting":
        walkers = ReactingWalkers(stretch, replayed.zone, plan.seed)
    fork = Fork(replayed, stretch, plan.changes, walkers, plan.seed)
    zone = fork.zone
    encounters, trips = Encounters(zone), TripTimes(zone)
    ends = piece_ends(stretch)
    conflicts: list[float] = []
    places: dict[Hashable, Floats] = {}
    for frame in fork.ticks():
        told(frame)
        if not fork.is_still:
            encounters.take()
            trips.take()
        if frame.tick == ends[len(conflicts)]:
            _note(zone, places, len(conflicts), len(ends))
            conflicts.append(encounters.conflict_s)
    return Run(
        plan,
        _figures(encounters, trips, walkers),
        np.diff(conflicts, prepend=0.0),
        places,
        fork.planning_failed,
    )


@contextmanager
def zone_of(plan: Plan, stretch: Stretch, replayed: ReplayedZone) -> Iterator[ReplayedZone]:
    """The zone in which a plan is run: that of the recording, or a fresh one of another scene.

    Raises
    ------
    WhatIfError
        The scene has no place to stand.
    """
    if plan.changes.scene is None:
        yield replayed
        return
    try:
        fresh = ReplayedZone(replace(stretch.head, scene=plan.changes.scene))
    except ValueError as error:
        raise WhatIfError(f"--scene: {error}") from None
    with fresh:
        yield fresh


def piece_ends(stretch: Stretch) -> list[int]:
    """The last tick of each piece of the strip."""
    ticks = len(stretch.ticks)
    pieces = max(1, min(PIECES, round(stretch.duration_s)))
    return [stretch.first_tick + round(ticks * k / pieces) for k in range(1, pieces + 1)]


def _note(zone: Zone, places: dict[Hashable, Floats], piece: int, pieces: int) -> None:
    for actor, place in zip(zone.agents.ids, zone.agents.agents.positions, strict=True):
        places.setdefault(actor, np.full((pieces, 2), np.nan))[piece] = place


def _figures(encounters: Encounters, trips: TripTimes, walkers: Walkers) -> dict[str, float]:
    clearances = encounters.clearances
    return {
        "encounters": float(len(clearances)),
        "contacts": float(encounters.contacts),
        "toward": float(encounters.toward),
        "clearance_m": _mean(clearances),
        "near_s": encounters.near_s,
        "conflict_s": encounters.conflict_s,
        "displacement_m": _mean(walkers.displacements_m),
        "delay_s": _mean(walkers.delays_s),
        "trips": float(len(trips.times_s)),
        "trip_s": _mean(trips.times_s),
        "speed_mps": _ratio(trips.walked_m, trips.going_s),
        "hindered_percent": 100.0 * _ratio(encounters.hindered_s, encounters.actor_s),
    }


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else np.nan


def _ratio(amount: float, of: float) -> float:
    return amount / of if of > 0.0 else np.nan
