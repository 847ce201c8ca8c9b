"""Trips of actors that no way leads to the end of: where they were to go, and whether one does."""

from __future__ import annotations

import asyncio
from collections import Counter
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from esplanade.actors.parameters import body_of
from esplanade.actors.trip_ends import NO_WAY_AFTER_S
from esplanade.planning import PathStatus, find_path
from esplanade.server.world.zone import Zone

LOOK_EVERY_S: Final = 0.2
_LATE_S: Final = NO_WAY_AFTER_S - 2.0 * LOOK_EVERY_S
"""A trip that has had no way for so long is noted: there is a look before it ends."""


@dataclass
class LostTrips:
    """Looks at the actors of a zone as it runs, and notes whose goals no way leads to."""

    zone: Zone
    goals: Counter[str] = field(default_factory=Counter)
    """Names of the goals; a point for one that is no place of the scene."""
    passable: list[str] = field(default_factory=list)
    """Trips to whose goal `find_path` finds a way from where the actor stood."""
    _noted: dict[int, float] = field(default_factory=dict)

    async def look(self) -> None:
        """Look until cancelled."""
        while True:
            await asyncio.sleep(LOOK_EVERY_S)
            self.note()

    def note(self) -> None:
        """Note the trips that have had no way for a while and were not noted yet."""
        table = self.zone.agents
        no_path_s = table.trips.no_path_s
        self._noted = {row: s for row, s in self._noted.items() if no_path_s[row] >= s}
        for row in np.flatnonzero(no_path_s >= _LATE_S).tolist():
            goal = table.wanted(row)
            if row in self._noted or goal is None:
                continue
            self._noted[row] = float(no_path_s[row])
            self._judge(row, goal)

    def figures(self) -> dict[str, Any]:
        """The figures of all trips that were noted."""
        return {
            "no_way_to": ", ".join(f"{name} {count}" for name, count in self.goals.most_common()),
            "no_way_though_there_is": len(self.passable),
        }

    def _judge(self, row: int, goal: tuple[float, float, float]) -> None:
        agents = self.zone.agents.agents
        x, y = agents.positions[row].tolist()
        start = x, y, float(agents.heights[row])
        name = self._name(goal)
        self.goals[name] += 1
        path = find_path(self.zone.grid, start, goal, body_of(agents.parameters[row]))
        if path.status is PathStatus.FOUND:
            self.passable.append(f"from ({x:.3f}, {y:.3f}, {start[2]:.2f}) to {name}")

    def _name(self, goal: tuple[float, float, float]) -> str:
        for place in self.zone.scene.places:
            if (*place.position, place.z_m) == goal:
                return place.name
        return "({:.2f}, {:.2f}, {:.2f})".format(*goal)
