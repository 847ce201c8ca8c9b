"""Where everybody in a zone was in the last seconds."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.server.world.state import State

PAST_S: Final = 3.2
"""As in episodes of `esplanade evaluate`."""


class Tracks:
    """The places of all avatars in the last ticks. Memory is 16 bytes for each slot and tick."""

    def __init__(self, state: State, tick_s: float) -> None:
        self._state = state
        ticks = max(2, round(PAST_S / tick_s))
        self._places = np.zeros((ticks, state.capacity, 2))
        self._arrivals = np.zeros(state.capacity, dtype=np.int64)
        self._known = np.zeros(state.capacity, dtype=np.int64)
        self._latest = -1

    def keep(self) -> None:
        """Keep where everybody is after a tick; cost O(slots)."""
        ticks = len(self._places)
        self._latest = (self._latest + 1) % ticks
        self._places[self._latest] = self._state.positions
        same = self._arrivals == self._state.arrivals
        self._known[:] = np.where(same, np.minimum(self._known + 1, ticks), 1)
        self._arrivals[:] = self._state.arrivals

    def of(self, slot: int) -> NDArray[np.float64]:
        """The places of an avatar tick by tick, the newest last, float64 (n, 2), metres, n >= 1."""
        count = int(self._known[slot])
        ticks = self._latest - np.arange(count)[::-1]
        return np.asarray(self._places[ticks % len(self._places), slot])
