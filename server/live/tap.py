"""The tap hands each tick of a zone over to another thread, at next to no cost for the tick."""

import time
from collections import deque
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import structlog

from esplanade.actors import ActorSpec
from esplanade.protocol.snapshot import Records, pack_records
from esplanade.server.live.traces import Traces
from esplanade.server.world.frame import Frame
from esplanade.server.world.state import ACTOR, KINDS
from esplanade.server.world.zone import Zone

MOST_TICKS: Final = 1200
"""Of more ticks that nobody has fetched the oldest are lost; then everybody is told of anew."""
MOST_PROBES_A_TICK: Final = 4
MOST_FOUND: Final = 64
"""Answers that are kept while the world stands; the oldest is lost."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class Avatar:
    """An avatar, as far as it hardly ever changes."""

    id: int
    kind: str
    name: str
    radius_m: float
    actor: str | None = None
    """The id of the actor whose avatar it is."""


@dataclass(frozen=True, slots=True)
class Everyone:
    """All avatars at a tick."""

    avatars: list[Avatar]
    records: Records


@dataclass(slots=True)
class Tick:
    """A tick, as it is handed over. Nothing in it changes any more."""

    frame: Frame
    at_us: int
    seconds: float
    stages: Mapping[str, float]
    touching: npt.NDArray[np.int64]
    """Pairs of an actor and another body that touch, as in `Contacts.touching`."""
    late: int
    """Ticks that began late, so far."""
    entered: list[Avatar]
    everyone: Everyone | None = None
    """In the first tick, and after some were lost."""
    specs: Mapping[Hashable, ActorSpec] | None = None
    """The specifications of all actors, in a tick that may have changed them."""
    found: dict[str, Any] = field(default_factory=dict)
    """The results of probes, by their names."""


@dataclass(slots=True)
class Probe:
    """A question to the zone that is asked between two ticks, every so many of them."""

    ask: Callable[[Zone], Any]
    every: int
    due: int = 0
    once: bool = False


class Tap:
    """Collects ticks on the zone's loop (`take`) until another thread fetches them."""

    def __init__(self, zone: Zone) -> None:
        self.zone = zone
        self.probes: dict[str, Probe] = {}
        """By their names; the other thread puts other dictionaries in its place."""
        self.traces = Traces(zone)
        self.lost = 0
        self._ticks: deque[Tick] = deque()
        self._found: deque[dict[str, Any]] = deque(maxlen=MOST_FOUND)
        self._clock = 0
        """Number of times that questions could be asked so far."""
        self._all = True

    def fetch(self) -> list[Tick]:
        """Take the ticks that have come since the last call, in another thread."""
        return [self._ticks.popleft() for _ in range(len(self._ticks))]

    def begin_anew(self) -> None:
        """Have everybody told of in the next tick, since some tick may not have been taken in."""
        self._all = True

    def fetch_found(self) -> list[dict[str, Any]]:
        """Take what probes have found while the world stood, in another thread."""
        return [self._found.popleft() for _ in range(len(self._found))]

    def stand(self) -> None:
        """Ask what is due while the world stands; call it as often as there would be a tick."""
        self._clock += 1
        found: dict[str, Any] = {}
        self._probe(found)
        if found:
            self._found.append(found)

    def take(self, frame: Frame, seconds: float, late: int) -> None:
        """Hand a tick over that has ended and taken this time."""
        zone = self.zone
        tick = Tick(
            frame,
            time.time_ns() // 1000,
            seconds,
            zone.times.seconds,
            zone.contacts.touching,
            late,
            [self._avatar(each.id, KINDS[each.kind].value, each.name) for each in frame.entered],
        )
        if len(self._ticks) >= MOST_TICKS:
            self._ticks.popleft()
            self.lost += 1
            self._all = True
        if self._all:
            tick.everyone, self._all = self._everyone(), False
        if tick.everyone is not None or frame.outcomes or frame.entered:
            tick.specs = dict(zone.actors)
        self._clock += 1
        self._probe(tick.found)
        self._ticks.append(tick)

    def _probe(self, found: dict[str, Any]) -> None:
        """Ask what is due, the longest due first, and no more than a few."""
        now = self._clock
        due = sorted((probe.due, name) for name, probe in self.probes.items() if probe.due <= now)
        for _, name in due[:MOST_PROBES_A_TICK]:
            probe = self.probes[name]
            probe.due = 2**62 if probe.once else now + probe.every
            try:
                found[name] = probe.ask(self.zone)
            except Exception:
                # An operator's question never ends a world.
                log.exception("a question of operators failed", tick=self.zone.tick, name=name)
                found[name] = None

    def _avatar(self, avatar_id: int, kind: str, name: str) -> Avatar:
        state = self.zone.state
        radius_m = float(state.radii[state.slot(avatar_id)]) if avatar_id in state else 0.0
        return Avatar(avatar_id, kind, name, round(radius_m, 3), self.zone.actor_of(avatar_id))

    def _everyone(self) -> Everyone:
        state = self.zone.state
        live = state.live()
        live = live[np.argsort(state.ids[live])]
        kinds = state.kinds[live] == ACTOR
        avatars = [
            self._avatar(avatar_id, KINDS[int(is_actor)].value, state.names[slot])
            for avatar_id, is_actor, slot in zip(
                state.ids[live].tolist(), kinds.tolist(), live.tolist(), strict=True
            )
        ]
        records = pack_records(
            state.ids[live],
            state.layers[live],
            state.reasons[live],
            state.positions[live],
            state.heights[live],
            state.headings[live],
            state.speeds[live],
            self.zone.origin_m,
        )
        return Everyone(avatars, records)
