"""The interval at which actors are planned, and which of them are due in a tick."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import SavedAgentsError


class PlanningInterval:
    """Spreads the planning of actors evenly over some ticks, so that each is due in one of them.

    An actor's rank, which follows from its id, gives its turn. The state is the interval and a
    count of ticks: the same calls in another process find the same actors due.
    """

    def __init__(self, ticks: int = 1) -> None:
        """Begin with an interval; with one of one tick everybody is due in each.

        Raises
        ------
        ValueError
            The interval is no number of ticks.
        """
        self.ticks = self.usual = ticks
        self.count = 0
        """Ticks in which actors were planned so far."""

    @property
    def ticks(self) -> int:
        """Ticks from one planning of an actor to its next."""
        return self._ticks

    @ticks.setter
    def ticks(self, ticks: int) -> None:
        if ticks < 1:
            raise ValueError(f"the planning interval must be at least one tick, got {ticks}")
        self._ticks = ticks

    def due(self, ranks: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Tell by the ranks (A,) of all actors whether each is due in the next tick, bool (A,)."""
        turns: NDArray[np.bool_] = (ranks + self.count) % self._ticks == 0
        return turns

    def save(self) -> dict[str, int]:
        """The state as plain data."""
        return {"ticks": self._ticks, "count": self.count}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what was saved.

        Raises
        ------
        SavedAgentsError
            It is no interval; nothing is changed then.
        """
        ticks, count = saved.get("ticks", self.usual), saved.get("count", 0)
        if not (isinstance(ticks, int) and isinstance(count, int) and ticks >= 1 and count >= 0):
            raise SavedAgentsError(f"the planning interval of saved agents is {dict(saved)!r}")
        self._ticks, self.count = ticks, count
