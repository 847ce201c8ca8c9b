"""Measures the trips of actors: how long they take, and how fast actors are on them."""

from collections.abc import Hashable

import numpy as np

from esplanade.actors.outcomes import Outcome
from esplanade.server.world.zone import Zone


class TripTimes:
    """The trips since it was made; `take` takes in each tick."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self._began: dict[Hashable, tuple[tuple[float, ...], int | None]] = {}
        """The goal of each actor on a trip, and the tick before its trip, if that was seen."""
        self.times_s: list[float] = []
        """The times of trips that began here and arrived, seconds."""
        self.going_s = self.walked_m = 0.0
        self._seen = False

    def take(self) -> None:
        """Take in the latest tick, in which something moved."""
        zone = self._zone
        table, tick_s = zone.agents, zone.tick_s
        wanted, outcomes = table.trips.wanted, table.trips.outcomes
        wants = ~np.isnan(wanted[:, 0])
        going = wants & (outcomes == 0)
        self.going_s += tick_s * int(going.sum())
        velocities = table.agents.velocities[going]
        self.walked_m += tick_s * float(np.hypot(velocities[:, 0], velocities[:, 1]).sum())
        began: dict[Hashable, tuple[tuple[float, ...], int | None]] = {}
        for row in np.flatnonzero(wants).tolist():
            actor, goal = table.ids[row], tuple(wanted[row].tolist())
            before = self._began.get(actor)
            if before is None or before[0] != goal:
                before = goal, zone.tick - 1 if self._seen else None
            if going[row]:
                began[actor] = before
            elif actor in self._began and outcomes[row] == Outcome.ARRIVED:
                _, since = before
                self.times_s += [] if since is None else [tick_s * (zone.tick - since)]
        self._began, self._seen = began, True
