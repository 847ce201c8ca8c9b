"""Potentials of the goals that actors are on their way to, shared by all with the same goal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from planning import LayeredGrid, Potential

_Key = tuple[float, float, int, float]
_IDLE_KEPT = 32


class GuidePool:
    """One row a goal in a single array that kernels index.

    Rows nobody uses are kept for the next who goes there and reused, oldest first, when more
    than 32 lie idle. Memory: 12 bytes a cell and goal.
    """

    def __init__(self, grid: LayeredGrid) -> None:
        self._grid = grid
        self.arrays: NDArray[np.float32] = np.empty(
            (0, *grid.arrays.clearance.shape, 3), dtype=np.float32
        )
        self._slots: dict[_Key, int] = {}
        self._keys: list[_Key | None] = []
        self._users: list[int] = []
        self._idle: list[int] = []

    def take(self, goal: tuple[float, float], layer: int, radius_m: float) -> int:
        """Row of a goal, for one more user."""
        key = (goal[0], goal[1], layer, radius_m)
        slot = self._slots.get(key)
        if slot is None:
            slot = self._fresh_slot()
            self.arrays[slot] = Potential(self._grid, goal, layer, radius_m).guide
            self._slots[key] = slot
            self._keys[slot] = key
        elif slot in self._idle:
            self._idle.remove(slot)
        self._users[slot] += 1
        return slot

    def release(self, slot: int) -> None:
        """One user less; -1 is nobody's row."""
        if slot < 0:
            return
        self._users[slot] -= 1
        if self._users[slot] == 0:
            self._idle.append(slot)

    def _fresh_slot(self) -> int:
        if len(self._idle) > _IDLE_KEPT:
            slot = self._idle.pop(0)
            key = self._keys[slot]
            if key is not None:
                del self._slots[key]
            return slot
        slot = len(self._keys)
        if slot == len(self.arrays):
            grown = np.empty((max(4, 2 * slot), *self.arrays.shape[1:]), dtype=np.float32)
            grown[:slot] = self.arrays
            self.arrays = grown
        self._keys.append(None)
        self._users.append(0)
        return slot
