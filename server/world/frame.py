"""A frame is all that a zone says to everyone who watches it, in one tick."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from esplanade.protocol.entities import Entity, pack_constants
from esplanade.protocol.looks import NO_LOOK, Look
from esplanade.protocol.snapshot import RECORD, Records, pack_records
from esplanade.protocol.steps import StepRecords
from esplanade.server.world.outcomes import Outcome
from esplanade.server.world.record_rows import record_rows
from esplanade.server.world.routes import Point
from esplanade.server.world.state import KINDS, Floats, Slots, State

Tickets = list[tuple[int, int]]
"""(ticket, avatar's id) of clients who look through an avatar's eyes since this tick."""


@dataclass(frozen=True)
class Entered:
    """An avatar that came into the world. What hardly ever changes of it is packed once."""

    id: int
    kind: int
    name: str
    constants: tuple[bytes, bytes]
    """As `esplanade.protocol.entities.pack_constants` has packed them."""


@dataclass(frozen=True)
class Reshaped:
    """An avatar that has another body or another look from now on."""

    id: int
    radius_m: float
    leg_m: float
    stature_m: float
    constants: tuple[bytes, bytes]
    """As in `Entered`."""
    look: Look = NO_LOOK


@dataclass(frozen=True)
class Line:
    """A line of chat, and the avatar that said it."""

    id: int
    text: str
    number: int = 0
    """The number by which clients know it; 0 where it is given by whoever tells them."""
    to: frozenset[int] | None = None
    """Those who hear it, by their avatars; None for everyone who has the speaker in view."""


@dataclass(frozen=True)
class Events:
    """Everything in a frame that is not about bodies and their feet."""

    doors: Mapping[str, bool] = field(default_factory=dict)
    """Doors that opened or closed."""
    pointing: Mapping[int, Point | None] = field(default_factory=dict)
    """The places that actors point at since this tick, by their ids; None for none any more."""
    chat: list[Line] = field(default_factory=list)
    """In the order in which people spoke; of somebody who left in this tick, before they did."""
    gestures: Mapping[int, int] = field(default_factory=dict)
    """The gesture that each of these avatars begins in this tick, by its id."""
    away: Mapping[int, bool] = field(default_factory=dict)
    """Avatars whose people are away since this tick, or there again; at first all are there."""
    plans: Mapping[int, bytes] = field(default_factory=dict)
    """Of the actors that somebody watches and whose turn it is, by their ids: packed messages."""


@dataclass(frozen=True)
class Frame:
    """One tick of a zone, for any number of viewers. Frames are complete only one after the other.

    Those who left are out of the world before those come in who entered, and then some have other
    bodies; whoever was detached looks no more, and then those look who joined or were attached,
    knowing nothing yet.
    """

    tick: int
    people: int
    actors: int
    left: list[int]
    entered: list[Entered]
    joined: Tickets
    attached: Tickets
    detached: list[int]
    acks: Mapping[int, int]
    """The latest movement that each person's avatar has begun, by its id."""
    records: Records
    """RECORD (N,): of everyone who entered, and of everyone whose record is another now."""
    steps: StepRecords
    """STEP (M,): the steps that began in this tick."""
    events: Events
    reshaped: list[Reshaped] = field(default_factory=list)
    outcomes: list[Outcome] = field(default_factory=list)
    """The outcomes of operators' commands in this tick."""
    actors_stood: bool = False
    """Whether there are actors for whom nothing was planned."""
    rate: float = 1.0
    """Seconds of the world in a second at this time, where viewers are not told by other ways."""


class Recorder:
    """Quantises everyone in each tick, and finds what is new since the tick before."""

    def __init__(self, state: State, origin_m: tuple[float, float]) -> None:
        self._state = state
        self._origin_m = origin_m
        self._records = np.zeros(state.capacity, dtype=RECORD)
        self._arrivals = np.zeros(state.capacity, dtype=np.int64)
        self._bodies = np.zeros((state.capacity, 3))
        self._looks = np.zeros_like(state.looks)
        self._away = np.zeros(state.capacity, dtype=np.bool_)

    def entered(self) -> list[Entered]:
        """The avatars that came into the world since the last call."""
        state = self._state
        live = state.live()
        new = live[self._arrivals[live] != state.arrivals[live]]
        self._arrivals[new] = state.arrivals[new]
        # Whoever has come back to the same place has its record told all the same.
        self._records[new] = np.zeros(1, dtype=RECORD)
        self._bodies[new], self._looks[new] = self._bodies_of(new), state.looks[new]
        self._away[new] = False
        return [self._describe(slot) for slot in new[np.argsort(state.ids[new])].tolist()]

    def reshaped(self) -> list[Reshaped]:
        """The avatars that have another body or look than at the last call of this or `entered`."""
        state = self._state
        live = state.live()
        bodies, looks = self._bodies_of(live), state.looks[live]
        changed = (bodies != self._bodies[live]).any(axis=1)
        changed |= (looks != self._looks[live]).any(axis=1)
        self._bodies[live], self._looks[live] = bodies, looks
        return [
            Reshaped(
                int(state.ids[slot]),
                radius,
                leg,
                stature,
                self._describe(slot).constants,
                Look(*state.looks[slot].tolist()),
            )
            for slot, (radius, leg, stature) in zip(
                live[changed].tolist(), bodies[changed].tolist(), strict=True
            )
        ]

    def away(self) -> dict[int, bool]:
        """Avatars whose people have gone away since the last call, or are there again, by id."""
        state = self._state
        live = state.live()
        changed = live[self._away[live] != state.away[live]]
        self._away[changed] = state.away[changed]
        return dict(zip(state.ids[changed].tolist(), state.away[changed].tolist(), strict=True))

    def save(self) -> dict[str, Any]:
        """All that was told last of everyone, as copies of arrays in the order of live slots."""
        live = self._state.live()
        return {
            "records": record_rows(self._records, live),
            "arrivals": self._arrivals[live],
            "bodies": self._bodies[live],
            "looks": self._looks[live],
            "away": self._away[live],
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Take as told last what was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` of these avatars gives.
        """
        live = self._state.live()
        self._arrivals[:] = 0
        self._records[live] = np.asarray(saved["records"], dtype=RECORD)
        self._arrivals[live], self._bodies[live] = saved["arrivals"], saved["bodies"]
        self._away[live] = saved["away"]
        self._looks[live] = saved["looks"]

    def _bodies_of(self, slots: Slots) -> Floats:
        """Radius, leg and stature, float64 (N, 3), metres."""
        state = self._state
        return np.stack([state.radii[slots], state.legs_m[slots], state.statures_m[slots]], axis=1)

    def changed(self) -> Records:
        """The records that are new or others than at the last call, RECORD (N,)."""
        state = self._state
        live: Slots = state.live()
        records = pack_records(
            state.ids[live],
            state.layers[live],
            state.reasons[live],
            state.positions[live],
            state.heights[live],
            state.headings[live],
            state.speeds[live],
            self._origin_m,
        )
        known = words(self._records)
        changed = (words(records) != known[live]).any(axis=1)
        known[live] = words(records)
        news: Records = records[changed]
        return news

    def _describe(self, slot: int) -> Entered:
        state = self._state
        kind, name = int(state.kinds[slot]), state.names[slot]
        entity = Entity(
            id=int(state.ids[slot]),
            kind=KINDS[kind],
            name=name,
            radius=float(state.radii[slot]),
            leg_m=float(state.legs_m[slot]),
            stature_m=float(state.statures_m[slot]),
            look=Look(*state.looks[slot].tolist()),
        )
        return Entered(entity.id, kind, name, pack_constants(entity))


def words(records: Records) -> np.ndarray[tuple[int, int], np.dtype[np.uint16]]:
    """The same memory as 16-bit words, (N, 7): faster to compare and to gather than structures."""
    return records.view(np.uint16).reshape(-1, RECORD.itemsize // 2)
