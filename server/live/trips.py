"""The time that trips of actors take, beside the time that their way alone would."""

from collections.abc import Hashable
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.actors import Outcome
from esplanade.server.live.tap import Probe
from esplanade.server.world.zone import Zone

Floats = npt.NDArray[np.float64]
PROBE: Final = "trips"
EVERY: Final = 5
"""Ticks between two looks at the actors' goals."""
SHORTEST_M: Final = 1.0
"""Shorter trips tell nothing."""


class Progress(NamedTuple):
    """All actors on their way, in the order of the agents' table."""

    time_s: float
    ids: tuple[Hashable, ...]
    wanted: Floats
    """(A, 3), nan without a goal."""
    arrived: npt.NDArray[np.bool_]
    left_m: Floats
    speed_mps: Floats
    """The speed at which each prefers to walk."""


def progress_probe() -> Probe:
    """Let the zone be asked how far actors are, now and then."""
    return Probe(_progress, EVERY)


def _progress(zone: Zone) -> Progress:
    table = zone.agents
    return Progress(
        zone.tick * zone.tick_s,
        tuple(table),
        table.trips.wanted.copy(),
        table.trips.outcomes == Outcome.ARRIVED,
        table.agents.left_m.copy(),
        table.agents.parameters["speed_mps"].astype(np.float64),
    )


class TimeRatios:
    """Finds the trips that end, and how much longer they took than the way alone."""

    def __init__(self) -> None:
        self._ids: tuple[Hashable, ...] = ()
        self._wanted: Floats = np.zeros((0, 3))
        self._begin_s: Floats = np.zeros(0)
        self._way_m: Floats = np.zeros(0)
        """Length of the way at the beginning of a trip, nan until it is known."""
        self._arrived: npt.NDArray[np.bool_] = np.zeros(0, dtype=np.bool_)

    def take(self, now: Progress) -> list[float]:
        """Return the ratios of the trips that have ended since the last call."""
        if now.ids != self._ids:
            self._match(now)
        other = ~((now.wanted == self._wanted) | np.isnan(now.wanted) & np.isnan(self._wanted))
        begun = other.any(axis=1)
        fresh = np.isnan(self._way_m) & ~begun & ~now.arrived
        self._way_m[fresh] = now.left_m[fresh]
        ended = now.arrived & ~self._arrived & ~begun & (self._way_m >= SHORTEST_M)
        took_s = now.time_s - self._begin_s[ended]
        ratios: list[float] = (took_s * now.speed_mps[ended] / self._way_m[ended]).tolist()
        self._way_m[begun | now.arrived] = np.nan
        self._begin_s[begun] = now.time_s
        self._wanted, self._arrived = now.wanted, now.arrived
        return ratios

    def _match(self, now: Progress) -> None:
        """Others are there: what is known of the same ones goes on."""
        rows = {actor: k for k, actor in enumerate(self._ids)}
        known = [(k, rows[actor]) for k, actor in enumerate(now.ids) if actor in rows]
        count = len(now.ids)
        wanted, begin_s = np.full((count, 3), np.nan), np.full(count, now.time_s)
        way_m, arrived = np.full(count, np.nan), np.zeros(count, dtype=np.bool_)
        if known:
            new, old = (list(column) for column in zip(*known, strict=True))
            wanted[new], begin_s[new] = self._wanted[old], self._begin_s[old]
            way_m[new], arrived[new] = self._way_m[old], self._arrived[old]
        self._ids, self._wanted, self._begin_s = now.ids, wanted, begin_s
        self._way_m, self._arrived = way_m, arrived
