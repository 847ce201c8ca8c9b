"""The people of a fork, who are where they were in the recording."""

from typing import Protocol

from esplanade.server.whatif.stretch import Stretch
from esplanade.server.world.routes import Point
from esplanade.server.world.zone import Zone


class Walkers(Protocol):
    """Says where the people of a fork are."""

    @property
    def displacements_m(self) -> list[float]:
        """The greatest distance of each person from the recorded place; nothing of the recorded."""
        ...

    @property
    def delays_s(self) -> list[float]:
        """The greatest delay of each person; nothing of the recorded."""
        ...

    def at(self, tick: int, zone: Zone) -> tuple[tuple[int, ...], tuple[Point, ...]]:
        """The ids of people and their places at the end of a tick that the zone begins next."""
        ...


class RecordedWalkers:
    """People who walk as they were recorded, whatever actors do."""

    def __init__(self, stretch: Stretch) -> None:
        self._walked = stretch.walked
        self.displacements_m: list[float] = []
        self.delays_s: list[float] = []

    def at(self, tick: int, zone: Zone) -> tuple[tuple[int, ...], tuple[Point, ...]]:  # noqa: ARG002
        """The ids of people and their recorded places at the end of a tick."""
        found = {who: walked.at(tick) for who, walked in self._walked.items()}
        there = {who: place for who, place in found.items() if place is not None}
        return tuple(there), tuple(there.values())
