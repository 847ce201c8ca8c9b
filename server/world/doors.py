"""Doors of the zone: they close only when nobody is in the way."""

from collections.abc import Mapping

import numpy as np

from esplanade.planning import LayeredGrid
from esplanade.planning.grid.door_change import DoorChange
from esplanade.planning.scene.heights import BODIES_OVERLAP_M
from esplanade.server.world.state import State

GAP_M = 0.05
"""A closing leaf leaves this much room to anybody who stands beside it."""


class Doors:
    """Moves doors as operators and scripts wish, once nobody stands in the way."""

    def __init__(self, state: State, grid: LayeredGrid) -> None:
        self._state = state
        self._grid = grid
        self._wanted: dict[str, bool] = {}
        self.derived_outside = False
        """Whether doors move by `take` alone: what changes is derived outside of ticks."""

    def states(self) -> dict[str, bool]:
        """Whether each door stands open now, by name."""
        return {name: self._grid.doors.is_open(name) for name in self._grid.doors}

    def waiting(self) -> int:
        """Number of doors that are wanted otherwise than they are."""
        return len(self._wanted)

    def want(self, name: str, is_open: bool) -> None:
        """Open or close a door as soon as that is possible; unknown names are void."""
        if name in self._grid.doors:
            self._wanted[name] = is_open

    @property
    def wanted(self) -> dict[str, bool]:
        """The doors that are wanted otherwise than they are, the longest first."""
        return dict(self._wanted)

    def want_only(self, wanted: Mapping[str, bool]) -> None:
        """Want these doors otherwise than they are, the longest first, and no others."""
        self._wanted = {}
        for name, is_open in wanted.items():
            self.want(name, bool(is_open))

    def due(self) -> list[tuple[str, bool]]:
        """The doors that are wanted elsewhere and can be moved now, the longest wanted first."""
        return [
            (name, is_open)
            for name, is_open in self._wanted.items()
            if is_open != self._grid.doors.is_open(name) and (is_open or not self._in_the_way(name))
        ]

    def update(self) -> dict[str, bool]:
        """Move the doors that can be moved here; returns those that did, and their new state."""
        moved = {} if self.derived_outside else dict(self.due())
        for name, is_open in moved.items():
            self._grid.set_door(name, is_open)
        for name, is_open in list(self._wanted.items()):
            if is_open == self._grid.doors.is_open(name):
                del self._wanted[name]
        return moved

    def prepare(self, name: str, is_open: bool) -> DoorChange:
        """Derive what changes when a door moves; heavy, and safe in any thread until one moves."""
        return self._grid.prepare_door(name, is_open)

    def take(self, change: DoorChange) -> dict[str, bool]:
        """Move a door for which that was derived; it stays if that is wanted no more, or blocked.

        Returns the door that did and its new state.
        """
        if (change.name, change.is_open) not in self.due():
            return {}
        self._grid.apply_door(change)
        return {change.name: change.is_open}

    def _in_the_way(self, name: str) -> bool:
        """Whether the leaf would touch anybody."""
        state = self._state
        x0, y0, x1, y1, foot, top, _ = self._grid.barriers[self._grid.doors.rows[name]].tolist()
        slots = state.live()
        heights = state.heights[slots]
        level = (heights < top) & (heights > foot - BODIES_OVERLAP_M)
        start, leaf = np.array((x0, y0)), np.array((x1 - x0, y1 - y0))
        places = state.positions[slots] - start
        along = np.clip(places @ leaf / (leaf @ leaf), 0.0, 1.0)
        away = np.hypot(*(places - along[:, None] * leaf).T)
        return bool((level & (away < state.radii[slots] + GAP_M)).any())
