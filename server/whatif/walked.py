"""Ways that were walked in a stretch, tick by tick."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Who = TypeVar("Who")


@dataclass(frozen=True)
class Walked:
    """The places (T, 3), metres, of somebody, from a tick on, one each tick; nan where away."""

    first_tick: int
    places: Floats

    @property
    def last_tick(self) -> int:
        """The tick of the last place."""
        return self.first_tick + len(self.places) - 1

    def at(self, tick: int) -> tuple[float, float, float] | None:
        """The place in a tick, if it was in this world then."""
        if not self.first_tick <= tick <= self.last_tick:
            return None
        x, y, z = self.places[tick - self.first_tick].tolist()
        return None if math.isnan(x) else (x, y, z)


class Ways(Generic[Who]):
    """The ways of those who are there, tick by tick."""

    def __init__(self) -> None:
        self._first: dict[Who, int] = {}
        self._places: dict[Who, list[Floats]] = {}

    def take(self, tick: int, ids: Sequence[Who], places: Floats) -> None:
        """Take in where everyone is in the next tick, (N, 3) metres."""
        for who, place in zip(ids, places, strict=True):
            way = self._places.setdefault(who, [])
            first = self._first.setdefault(who, tick)
            # A person who has come back from another zone was away meanwhile.
            way += [np.full(3, np.nan)] * (tick - first - len(way))
            way.append(place)

    def walked(self) -> dict[Who, Walked]:
        """The way of each so far."""
        return {who: Walked(self._first[who], np.array(way)) for who, way in self._places.items()}
