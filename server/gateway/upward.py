"""Inputs of a gateway's people that wait for the next batch to the host of a zone."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.protocol.looks import Look
from esplanade.protocol.messages import Report, WalkTo
from esplanade.server.gateway.occupant import Occupant
from esplanade.server.link.batches import MOVEMENT, Batch

AGAIN_S: Final = 0.3
"""A movement that no frame acknowledges is sent again after so long."""
MOST_TRIES: Final = 10
"""It is given up after so many times: the zone has refused it, or no way leads to the point."""
MOST_WAITING: Final = 4096
"""Lines, reports, wishes for doors and plans that wait at once; further ones are left out."""


@dataclass
class _Wish:
    """The newest wish of a person to walk, until a frame says that the avatar has begun it."""

    seq: int
    steering: tuple[int, int, int, float, float] | None
    walk: tuple[int, int, WalkTo] | None
    sent_s: float = -math.inf
    tries: int = 0


class Upward:
    """Gathers what people want of one zone: of each person at most the newest movement.

    A movement goes out again until it is acknowledged, since a batch may be lost; the host takes it
    once.
    """

    def __init__(self, gateway: str) -> None:
        self._gateway = gateway
        self._number = 0
        self._held: list[tuple[int, int]] = []
        self._departed: list[tuple[int, int, bool]] = []
        self._stood: list[tuple[int, int]] = []
        self._wishes: dict[int, _Wish] = {}
        self._watched: dict[int, tuple[int, int, int | None]] = {}
        self._doors: dict[str, tuple[int, int, str, bool]] = {}
        self._lines: list[tuple[int, int, str]] = []
        self._muted: dict[int, tuple[int, int, list[int]]] = {}
        self._reports: list[tuple[int, int, Report]] = []
        self._presences: dict[int, tuple[int, int, bool]] = {}
        self._gestures: dict[int, tuple[int, int, int]] = {}
        self._looks: dict[int, tuple[int, int, Look]] = {}
        self.left_out = 0
        """Lines that were given up, since the zone took none of those before."""

    def hold(self, who: Occupant) -> None:
        """Say at once that somebody is here."""
        self._held.append((who.person, who.generation))

    def depart(self, who: Occupant, *, comes_back: bool) -> None:
        """Say that a connection has ended."""
        self._forget(who.person)
        self._departed.append((who.person, who.generation, comes_back))

    def stand(self, who: Occupant) -> None:
        """Let an avatar stand whose client has fallen silent."""
        self._forget(who.person)
        self._stood.append((who.person, who.generation))

    def steer(self, who: Occupant, seq: int, direction_rad: float, speed_mps: float) -> None:
        """Let somebody walk in a direction."""
        movement = (who.person, who.generation, seq, direction_rad, speed_mps)
        self._wishes[who.person] = _Wish(seq, movement, None)

    def walk(self, who: Occupant, wish: WalkTo) -> None:
        """Let somebody walk to a point."""
        self._wishes[who.person] = _Wish(wish.seq, None, (who.person, who.generation, wish))

    def acknowledge(self, acks: Mapping[int, int]) -> None:
        """Take in which movements avatars have begun, by persons."""
        for person in self._wishes.keys() & acks.keys():
            if self._wishes[person].seq == acks[person]:
                del self._wishes[person]

    def say(self, who: Occupant, text: str) -> bool:
        """Let somebody say a line; False if too many wait."""
        if len(self._lines) >= MOST_WAITING:
            self.left_out += 1
            return False
        self._lines.append((who.person, who.generation, text))
        return True

    def report(self, who: Occupant, report: Report) -> bool:
        """Let somebody report a person or a line; False if too many wait."""
        if len(self._reports) >= MOST_WAITING:
            return False
        self._reports.append((who.person, who.generation, report))
        return True

    def watch(self, who: Occupant, actor: int | None) -> None:
        """Have the plans of an actor told, or of none."""
        self._watched[who.person] = (who.person, who.generation, actor)

    def move_door(self, who: Occupant, name: str, *, is_open: bool) -> None:
        """Open or close a door."""
        if len(self._doors) < MOST_WAITING:
            self._doors[name] = (who.person, who.generation, name, is_open)

    def mute(self, who: Occupant, muted: Collection[int]) -> None:
        """Say whom somebody does not want to hear, which goes with the seat wherever that goes."""
        self._muted[who.person] = (who.person, who.generation, sorted(muted))

    def be_away(self, who: Occupant, away: bool) -> None:
        """Say that somebody is away from the screen, or there again."""
        self._presences[who.person] = (who.person, who.generation, away)

    def make_gesture(self, who: Occupant, gesture: int) -> None:
        """Let an avatar make a gesture."""
        self._gestures[who.person] = (who.person, who.generation, gesture)

    def wear(self, who: Occupant, look: Look) -> None:
        """Let an avatar look otherwise."""
        self._looks[who.person] = (who.person, who.generation, look)

    def batch(self, epoch: int, held: list[tuple[int, int]], now_s: float) -> Batch | None:
        """Everything since the last batch, for the owner of that epoch, with whom we serve.

        None if there is nothing.
        """
        due = [wish for wish in self._wishes.values() if now_s - wish.sent_s >= AGAIN_S]
        for wish in due:
            wish.sent_s = now_s
            wish.tries += 1
        waiting = (self._held, self._departed, self._stood, self._watched, self._doors, self._lines)
        said = (self._muted, self._reports, self._presences, self._gestures, self._looks)
        if not held and not due and not any(said) and not any(waiting):
            return None
        self._number += 1
        batch = Batch(
            self._gateway,
            self._number,
            epoch,
            np.array([wish.steering for wish in due if wish.steering is not None], dtype=MOVEMENT),
            [*held, *self._held],
            self._departed,
            [wish.walk for wish in due if wish.walk is not None],
            self._lines,
            list(self._watched.values()),
            list(self._doors.values()),
            self._stood,
            list(self._muted.values()),
            self._reports,
            list(self._presences.values()),
            list(self._gestures.values()),
            list(self._looks.values()),
        )
        self._held, self._departed, self._lines, self._stood = [], [], [], []
        self._watched, self._doors, self._muted, self._reports = {}, {}, {}, []
        self._presences, self._gestures, self._looks = {}, {}, {}
        self._wishes = {
            person: wish for person, wish in self._wishes.items() if wish.tries < MOST_TRIES
        }
        return batch

    def _forget(self, person: int) -> None:
        self._wishes.pop(person, None)
        self._watched.pop(person, None)
        self._presences.pop(person, None)
        self._gestures.pop(person, None)
        self._looks.pop(person, None)
