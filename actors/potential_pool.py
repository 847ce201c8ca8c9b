"""Potentials of the goals that actors are on their way to, shared by all with the same goal."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Body, LayeredGrid, Potential

_Key = tuple[float, float, float, Body]
_IDLE_KEPT = 32


@dataclass(frozen=True, eq=False)
class RenewedPotential:
    """The potential of a goal, derived anew outside of ticks."""

    goal: _Key
    """x, y, height and body."""
    changes: int
    """The number of changes of the ground when it was derived."""
    values: NDArray[np.float32]


class PotentialPool:
    """One row a goal in a single array that kernels index.

    Rows nobody uses are kept for the next who goes there and reused, oldest first, when more
    than 32 lie idle. Memory: 12 bytes a cell and goal.
    """

    def __init__(self, grid: LayeredGrid) -> None:
        self._grid = grid
        self.arrays: NDArray[np.float32] = np.empty(
            (0, len(grid.layered.floors), 3), dtype=np.float32
        )
        self._slots: dict[_Key, int] = {}
        self._keys: list[_Key | None] = []
        self._users: list[int] = []
        self._idle: list[int] = []
        self._stale: list[int] = []
        self._changes = 0
        self._outdated: dict[int, None] = {}
        """Rows that wait to be renewed outside of ticks, the longest out of date first."""

    def take(self, goal: tuple[float, float], z_m: float, body: Body) -> int:
        """Row of a goal, for one more user."""
        key = (goal[0], goal[1], z_m, body)
        slot = self._slots.get(key)
        if slot is None:
            slot = self._keep(key, self._potential(key))
        elif slot in self._idle:
            self._idle.remove(slot)
        self._users[slot] += 1
        return slot

    def prepare(self, goals: Iterable[_Key], threads: int) -> None:
        """Derive the potentials of goals (x, y, height, body) for later users, on threads."""
        wanted = [key for key in dict.fromkeys(goals) if key not in self._slots]
        for *_, body in wanted:
            self._grid.row_of(body)  # derived here, since the threads share the grid
        # Copying the rows there are whenever one more is needed takes seconds on large ground.
        fresh = min(len(wanted), max(0, _IDLE_KEPT + 1 - len(self._idle)))
        self._reserve(len(self._keys) + fresh)
        with ThreadPoolExecutor(threads, thread_name_prefix="potentials") as pool:
            for key, values in zip(wanted, pool.map(self._potential, wanted), strict=True):
                self._idle.append(self._keep(key, values))

    def _keep(self, key: _Key, values: NDArray[np.float32]) -> int:
        slot = self._fresh_slot()
        self.arrays[slot] = values
        self._outdated.pop(slot, None)
        self._slots[key] = slot
        self._keys[slot] = key
        return slot

    def release(self, slot: int) -> None:
        """One user less; -1 is nobody's row."""
        if slot < 0:
            return
        self._users[slot] -= 1
        if self._users[slot] == 0:
            self._idle.append(slot)

    def forget(self) -> None:
        """The ground has changed: what is idle is dropped, what is in use is derived anew."""
        for slot in self._idle:
            key = self._keys[slot]
            if key is not None:
                del self._slots[key]
                self._keys[slot] = None
        self._stale = [slot for slot, users in enumerate(self._users) if users]

    def renew_one(self) -> None:
        """Derive the next potential that is out of date, if any; it costs as much as a new goal."""
        while self._stale:
            slot = self._stale.pop(0)
            key = self._keys[slot]
            if key is not None and self._users[slot]:
                self.arrays[slot] = self._potential(key)
                return

    def outdate(self) -> None:
        """The ground has changed: rows are used as they are until each is given to `renew`."""
        self._changes += 1
        for slot, key in enumerate(self._keys):
            if key is not None:
                self._outdated.setdefault(slot)

    @property
    def outdated_rows(self) -> int:
        """Number of rows that wait for `renew`."""
        return len(self._outdated)

    def outdated(self) -> Callable[[], RenewedPotential] | None:
        """Derives the potential that is out of date for longest, those in use first.

        What is returned is heavy and runs in any thread; None if nothing is out of date.
        """
        slot = min(self._outdated, key=lambda slot: not self._users[slot], default=None)
        key = None if slot is None else self._keys[slot]
        return None if key is None else partial(self._renewed, key, self._changes)

    def renew(self, renewed: RenewedPotential) -> None:
        """Take a potential that was derived anew; it is derived again if the ground has changed."""
        slot = self._slots.get(renewed.goal)
        if slot is None or slot not in self._outdated:
            return
        self.arrays[slot] = renewed.values
        del self._outdated[slot]
        if renewed.changes != self._changes:
            self._outdated[slot] = None

    def _renewed(self, key: _Key, changes: int) -> RenewedPotential:
        return RenewedPotential(key, changes, self._potential(key))

    def _potential(self, key: _Key) -> NDArray[np.float32]:
        x, y, z_m, body = key
        return Potential(self._grid, (x, y), z_m, body.radius_m, body=body).values

    def _reserve(self, rows: int) -> None:
        """Make room for so many rows; what stands in those there are is copied."""
        before = len(self.arrays)
        if rows > before:
            grown = np.empty((rows, *self.arrays.shape[1:]), dtype=np.float32)
            grown[:before] = self.arrays
            self.arrays = grown

    def _fresh_slot(self) -> int:
        if len(self._idle) > _IDLE_KEPT:
            slot = self._idle.pop(0)
            key = self._keys[slot]
            if key is not None:
                del self._slots[key]
            return slot
        slot = len(self._keys)
        if slot == len(self.arrays):
            self._reserve(max(4, 2 * slot))
        self._keys.append(None)
        self._users.append(0)
        return slot
