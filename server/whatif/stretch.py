"""A stretch of a recording, run once as it was: where it begins, and where people walked in it."""

import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.server.recording.head import Head
from esplanade.server.recording.reader import RecordedTick, Recording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.world.frame import Frame
from esplanade.server.world.state import PERSON, State
from esplanade.server.world.zone import Zone

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Walked:
    """The places (T, 3), metres, of one person, from a tick on, one each tick."""

    first_tick: int
    places: Floats

    @property
    def last_tick(self) -> int:
        """The tick of the last place."""
        return self.first_tick + len(self.places) - 1

    def at(self, tick: int) -> tuple[float, float, float] | None:
        """The place in a tick, if the person was there."""
        if not self.first_tick <= tick <= self.last_tick:
            return None
        x, y, z = self.places[tick - self.first_tick].tolist()
        return x, y, z


@dataclass(frozen=True)
class Stretch:
    """Part of a recording, as plain data: another process runs it."""

    head: Head
    state: dict[str, Any]
    """The exact state after its first tick; what follows is run again."""
    first_tick: int
    ticks: list[RecordedTick]
    """Those after the first one."""
    walked: dict[int, Walked]
    """Where people were, by their ids, the first tick included."""
    joined: dict[tuple[int, int], int]
    """The ids that newcomers got, by tick and ticket."""

    @property
    def last_tick(self) -> int:
        """The tick with which it ends."""
        return self.ticks[-1].tick

    @property
    def duration_s(self) -> float:
        """Its length in the world, seconds."""
        return len(self.ticks) * self.head.built.tick_s


@dataclass
class _Watched:
    """Takes in ticks of the world as it was."""

    places: dict[int, list[Floats]] = field(default_factory=dict)
    first: dict[int, int] = field(default_factory=dict)
    joined: dict[tuple[int, int], int] = field(default_factory=dict)

    def take(self, tick: int, state: State, frame: Frame | None) -> None:
        people = state.of_kind(PERSON)
        places = np.column_stack([state.positions[people], state.heights[people]])
        for person, place in zip(state.ids[people].tolist(), places, strict=True):
            self.first.setdefault(person, tick)
            self.places.setdefault(person, []).append(place)
        if frame is not None:
            self.joined |= {(tick, ticket): person for ticket, person in frame.joined}

    def walked(self) -> dict[int, Walked]:
        return {who: Walked(self.first[who], np.array(at)) for who, at in self.places.items()}


def read_stretch(
    recording: Recording,
    replayed: ReplayedZone,
    from_tick: int,
    to_tick: int = sys.maxsize,
    report: Callable[[float], None] = lambda _: None,
    check: Callable[[Zone], None] = lambda _: None,
) -> Stretch:
    """Run a stretch as it was recorded, from the nearest state on.

    `report` is told of the share that is read, and `check` is given the zone at the first tick.

    Raises
    ------
    WhatIfError
        There is no tick in it.
    ZoneRecordingError
        The recording is damaged.
    """
    watched, ticks = _Watched(), list[RecordedTick]()
    state: dict[str, Any] | None = None
    began = False
    for second in recording.seconds(from_tick):
        if second.state is not None and not began:
            replayed.go_to(second.state)
            began = True
            if second.last_tick >= from_tick:
                state = second.state
                check(replayed.zone)
                watched.take(second.last_tick, replayed.zone.state, None)
        for tick in second.ticks:
            if tick.tick > to_tick:
                break
            frame = replayed.step(tick)
            if state is not None:
                ticks.append(tick)
                watched.take(tick.tick, replayed.zone.state, frame)
            elif tick.tick == from_tick:
                state = replayed.zone.save_exactly()
                check(replayed.zone)
                watched.take(tick.tick, replayed.zone.state, None)
        if second.last_tick > to_tick:
            break
        report(recording.share_read)
    if state is None or not ticks:
        raise WhatIfError(f"{recording.path}: there is no tick between --from and --to")
    return Stretch(
        recording.head, state, ticks[0].tick - 1, ticks, watched.walked(), watched.joined
    )
