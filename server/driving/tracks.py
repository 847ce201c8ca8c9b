"""The places of everybody in a zone in the last seconds."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.server.world.state import State

PAST_S: Final = 3.2
"""As in episodes of `esplanade evaluate`."""


class Tracks:
    """The places of all avatars at the last sights. Memory is 16 bytes for each slot and sight."""

    def __init__(self, state: State, every_s: float) -> None:
        self._state = state
        sights = max(2, round(PAST_S / every_s))
        self._places = np.zeros((sights, state.capacity, 2))
        self._arrivals = np.zeros(state.capacity, dtype=np.int64)
        self._known = np.zeros(state.capacity, dtype=np.int64)
        self._latest = -1

    def keep(self) -> None:
        """Keep the places of everybody now; cost O(slots)."""
        sights = len(self._places)
        self._latest = (self._latest + 1) % sights
        self._places[self._latest] = self._state.positions
        same = self._arrivals == self._state.arrivals
        self._known[:] = np.where(same, np.minimum(self._known + 1, sights), 1)
        self._arrivals[:] = self._state.arrivals

    def of(self, slot: int) -> NDArray[np.float64]:
        """The places of an avatar from sight to sight, the newest last: float64 (n, 2), n >= 1."""
        count = int(self._known[slot])
        sights = self._latest - np.arange(count)[::-1]
        return np.asarray(self._places[sights % len(self._places), slot])
