"""Inputs of a gateway's people that wait for the next batch to the host of a zone."""

from typing import Final

import numpy as np

from esplanade.protocol.messages import WalkTo
from esplanade.server.gateway.occupant import Occupant
from esplanade.server.link.batches import MOVEMENT, Batch

MOST_WAITING: Final = 4096
"""Lines, wishes for doors and plans that wait at once; further ones are left out."""


class Upward:
    """Gathers what people want of one zone: of each person at most the newest movement."""

    def __init__(self, gateway: str) -> None:
        self._gateway = gateway
        self._number = 0
        self._held: list[tuple[int, int]] = []
        self._departed: list[tuple[int, int, bool]] = []
        self._stood: list[tuple[int, int]] = []
        self._movements: dict[int, tuple[int, int, int, float, float]] = {}
        self._walks: dict[int, tuple[int, int, WalkTo]] = {}
        self._watched: dict[int, tuple[int, int, int | None]] = {}
        self._doors: dict[str, tuple[int, int, str, bool]] = {}
        self._lines: list[tuple[int, int, str]] = []
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
        self._walks.pop(who.person, None)
        movement = (who.person, who.generation, seq, direction_rad, speed_mps)
        self._movements[who.person] = movement

    def walk(self, who: Occupant, wish: WalkTo) -> None:
        """Let somebody walk to a point."""
        self._movements.pop(who.person, None)
        self._walks[who.person] = (who.person, who.generation, wish)

    def say(self, who: Occupant, text: str) -> bool:
        """Let somebody say a line; False if too many wait."""
        if len(self._lines) >= MOST_WAITING:
            self.left_out += 1
            return False
        self._lines.append((who.person, who.generation, text))
        return True

    def watch(self, who: Occupant, actor: int | None) -> None:
        """Have the plans of an actor told, or of none."""
        self._watched[who.person] = (who.person, who.generation, actor)

    def move_door(self, who: Occupant, name: str, *, is_open: bool) -> None:
        """Open or close a door."""
        if len(self._doors) < MOST_WAITING:
            self._doors[name] = (who.person, who.generation, name, is_open)

    def batch(self, epoch: int, held: list[tuple[int, int]]) -> Batch:
        """Everything since the last batch, for the owner of that epoch, with whom we serve."""
        self._number += 1
        batch = Batch(
            self._gateway,
            self._number,
            epoch,
            np.array(list(self._movements.values()), dtype=MOVEMENT),
            [*held, *self._held],
            self._departed,
            list(self._walks.values()),
            self._lines,
            list(self._watched.values()),
            list(self._doors.values()),
            self._stood,
        )
        self._held, self._departed, self._lines, self._stood = [], [], [], []
        self._movements, self._walks, self._watched, self._doors = {}, {}, {}, {}
        return batch

    @property
    def is_empty(self) -> bool:
        """Whether nothing waits."""
        return not any(
            (
                self._held,
                self._departed,
                self._stood,
                self._movements,
                self._walks,
                self._watched,
                self._doors,
                self._lines,
            )
        )

    def _forget(self, person: int) -> None:
        self._movements.pop(person, None)
        self._walks.pop(person, None)
        self._watched.pop(person, None)
