"""A stretch of a recording, run once as it was: where it begins, and where people walked in it."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from esplanade.actors import ActorParameters, ActorSpec
from esplanade.server.recording.head import Head
from esplanade.server.recording.reader import RecordedTick, Recording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.whatif.walked import Walked, Ways
from esplanade.server.world.frame import Frame
from esplanade.server.world.state import ACTOR, PERSON
from esplanade.server.world.zone import Zone


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
    """The places of people by their ids, the first tick included."""
    joined: dict[tuple[int, int], int]
    """The ids that newcomers got, by tick and ticket."""
    actors_walked: dict[str, Walked]
    """The places of actors a tick before each one, by their ids, at the heights of that tick."""
    cast: tuple[tuple[ActorSpec, ActorParameters], ...]
    """The actors at its first tick: what each was doing, where it was, and its parameters."""
    actors_radii_m: dict[str, float]
    """The radii that actors had at last."""

    @property
    def last_tick(self) -> int:
        """The tick with which it ends."""
        return self.ticks[-1].tick

    @property
    def duration_s(self) -> float:
        """Its length in the world, seconds."""
        return len(self.ticks) * self.head.built.tick_s


class _Watched:
    """Takes in ticks of the world as it was."""

    def __init__(self) -> None:
        self.people = Ways[int]()
        self.actors = Ways[str]()
        self.joined: dict[tuple[int, int], int] = {}
        self.radii_m: dict[str, float] = {}

    def take(self, zone: Zone, frame: Frame | None) -> None:
        tick, state = zone.tick, zone.state
        people, actors = state.of_kind(PERSON), state.of_kind(ACTOR)
        places = np.column_stack([state.positions[people], state.heights[people]])
        self.people.take(tick, state.ids[people].tolist(), places)
        ids = [str(zone.actor_of(avatar)) for avatar in state.ids[actors].tolist()]
        self.actors.take(tick, ids, np.column_stack([state.before[actors], state.heights[actors]]))
        self.radii_m |= zip(ids, state.radii[actors].tolist(), strict=True)
        if frame is not None:
            self.joined |= {(tick, ticket): person for ticket, person in frame.joined}


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
    cast: tuple[tuple[ActorSpec, ActorParameters], ...] = ()
    began = False
    for second in recording.seconds(from_tick):
        if second.state is not None and not began:
            replayed.go_to(second.state)
            began = True
            if second.last_tick >= from_tick:
                state, cast = second.state, _cast(replayed.zone)
                check(replayed.zone)
                watched.take(replayed.zone, None)
        for tick in second.ticks:
            if tick.tick > to_tick:
                break
            frame = replayed.step(tick)
            if state is not None:
                ticks.append(tick)
                watched.take(replayed.zone, frame)
            elif tick.tick == from_tick:
                state, cast = replayed.zone.save_exactly(), _cast(replayed.zone)
                check(replayed.zone)
                watched.take(replayed.zone, None)
        if second.last_tick > to_tick:
            break
        report(recording.share_read)
    if state is None or not ticks:
        raise WhatIfError(f"{recording.path}: there is no tick between --from and --to")
    return Stretch(
        recording.head,
        state,
        ticks[0].tick - 1,
        ticks,
        watched.people.walked(),
        watched.joined,
        watched.actors.walked(),
        cast,
        watched.radii_m,
    )


def _cast(zone: Zone) -> tuple[tuple[ActorSpec, ActorParameters], ...]:
    table = zone.agents
    places = np.column_stack([table.agents.positions, table.agents.heights]).tolist()
    return tuple(
        (
            zone.actors[actor].model_copy(update={"place": tuple(place), "near": False}),
            zone.parameters(str(actor)),
        )
        for actor, place in zip(table.ids, places, strict=True)
    )
