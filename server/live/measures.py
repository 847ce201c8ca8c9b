"""Measures a world second by second, from its ticks."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from esplanade.actors.state import Reason
from esplanade.protocol.snapshot import SPEED_MPS
from esplanade.server.live.encounters import NearMisses
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.series import Figure, Series
from esplanade.server.live.tap import Tick
from esplanade.server.live.trips import PROBE, TimeRatios
from esplanade.server.metrics import Traffic
from esplanade.server.world.stage_times import STAGES

STANDING: Final = (Reason.GIVING_WAY, Reason.WAITING, Reason.REPLANNING, Reason.NO_PATH)
_REASONS: Final = tuple(reason for reason in Reason if reason is not Reason.NONE)
_STAGES: Final = (*STAGES, "write")
_NEAR_EVERY: Final = 6
"""Ticks between two looks for near misses: whoever passes is near for longer than that."""

FIGURES: Final = (
    Figure("tick_p50_ms", "ms", "Length of half of the ticks at most"),
    Figure("tick_p99_ms", "ms", "Length of nearly all ticks at most", "max"),
    Figure("ticks_late", "1", "Ticks that began late", "sum"),
    *(Figure(f"stage_{name}_ms", "ms", f"Time of the stage {name} in a tick") for name in _STAGES),
    Figure("people", "1", "People in the world"),
    Figure("actors", "1", "Actors in the world"),
    Figure("contacts", "1/min", "Contacts of actors with people, for each person and minute"),
    Figure("near_misses", "1/min", "Passings closer than 0.45 m, for each person and minute"),
    Figure("contacts_actors", "1", "Contacts among actors", "sum"),
    Figure("waiting_s", "s", "Time that actors were held, of all together", "sum"),
    Figure("no_path", "1", "Actors that find no path"),
    Figure("trips", "1", "Trips that actors completed", "sum"),
    Figure("time_ratio", "1", "Time of a trip beside that of its way alone"),
    *(
        Figure(f"share_{reason.name.lower()}", "1", f"Part of the actors: {reason.name.lower()}")
        for reason in _REASONS
    ),
    Figure("speed_mps", "m/s", "Speed of the actors that move"),
    Figure("bytes_out", "B/s", "Bytes sent to people"),
    Figure("dropped", "1", "Snapshots left out since a client was slow", "sum"),
)


class Measures:
    """Collects ticks of a second, and adds its values to the series once it is over."""

    def __init__(self, feed: MapFeed, series: Series, traffic: Traffic, tick_s: float) -> None:
        self.series = series
        self._feed = feed
        self._traffic = traffic
        self._tick_s = tick_s
        self._ratios = TimeRatios()
        self._near = NearMisses(feed)
        self._second = 0
        self._totals_before = (traffic.bytes_out, traffic.snapshots_skipped)
        self._late: int | None = None
        self._trips: int | None = None
        self._begin()

    def take(self, tick: Tick, contacts: list[tuple[int, int]], trips: int) -> bool:
        """Take in a tick; True if a second is over and was added."""
        second = tick.at_us // 1_000_000
        over = self._second not in (0, second) and bool(self._ticks)
        if over:
            self.series.add(self._second, self._values())
            self._begin()
        self._second = second
        self._ticks.append(tick.seconds)
        for name, seconds in tick.stages.items():
            self._stages[name] = self._stages.get(name, 0.0) + seconds
        self._late_ticks += tick.late - (tick.late if self._late is None else self._late)
        self._trips_ended += trips - (trips if self._trips is None else self._trips)
        self._late, self._trips = tick.late, trips
        actors = self._feed.rows_by_kind()[0]
        self._people, self._actors = tick.frame.people, len(actors)
        with_people = sum(self._feed.is_person(other) for _, other in contacts)
        self._contacts += with_people
        self._contacts_actors += len(contacts) - with_people
        if tick.frame.tick % _NEAR_EVERY == 0:
            self._misses += self._near.count(tick.touching)
        reasons = np.bincount(self._feed.records["reason"][actors], minlength=len(Reason))
        self._reasons += reasons[: len(Reason)]
        progress = tick.found.get(PROBE)
        if progress is not None:
            self._ended += self._ratios.take(progress)
        return over

    def _begin(self) -> None:
        self._ticks: list[float] = []
        self._stages: dict[str, float] = {}
        self._late_ticks = self._trips_ended = 0
        self._people = self._actors = 0
        self._contacts = self._contacts_actors = self._misses = 0
        self._reasons = np.zeros(len(Reason), dtype=np.int64)
        self._ended: list[float] = []

    def _values(self) -> Mapping[str, float]:
        ticks = len(self._ticks)
        bytes_out, skipped = self._traffic.bytes_out, self._traffic.snapshots_skipped
        bytes_before, skipped_before = self._totals_before
        self._totals_before = bytes_out, skipped
        values = {
            "tick_p50_ms": 1e3 * float(np.percentile(self._ticks, 50)),
            "tick_p99_ms": 1e3 * float(np.percentile(self._ticks, 99)),
            "ticks_late": self._late_ticks,
            "people": self._people,
            "actors": self._actors,
            "contacts_actors": self._contacts_actors,
            "waiting_s": float(self._reasons[list(STANDING)].sum()) * self._tick_s,
            "no_path": float(self._reasons[Reason.NO_PATH]) / ticks,
            "trips": self._trips_ended,
            "bytes_out": bytes_out - bytes_before,
            "dropped": skipped - skipped_before,
        }
        for name in _STAGES:
            values[f"stage_{name}_ms"] = 1e3 * self._stages.get(name, 0.0) / ticks
        if self._people:
            minutes = self._people * ticks * self._tick_s / 60.0
            values["contacts"] = self._contacts / minutes
            values["near_misses"] = self._misses / minutes
        if self._ended:
            values["time_ratio"] = float(np.mean(self._ended))
        total = int(self._reasons.sum())
        if total:
            for reason in _REASONS:
                values[f"share_{reason.name.lower()}"] = float(self._reasons[reason]) / total
        records = self._feed.records[self._feed.rows_by_kind()[0]]
        moving = records["speed"][records["reason"] == Reason.MOVING]
        if len(moving):
            values["speed_mps"] = float(moving.mean()) * SPEED_MPS
        return values
