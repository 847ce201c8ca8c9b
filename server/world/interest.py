"""Interest management: each viewer sees the nearest avatars, with hysteresis at the edge."""

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from esplanade.server.world.rules import Rules
from esplanade.server.world.state import Slots, State

LEAVE_RATIO: Final = 1.15
"""An avatar goes out of view at this multiple of the distance at which it comes into view."""

PERIOD_TICKS: Final = 4
"""Each viewer's view is computed anew every so many ticks; an avatar that leaves goes at once."""


@dataclass(frozen=True)
class Changes:
    """The avatars that came into view and went out of it, by the viewer's id."""

    entered: dict[int, list[int]] = field(default_factory=lambda: defaultdict(list))
    """Slots that came into view."""
    left: dict[int, list[int]] = field(default_factory=lambda: defaultdict(list))
    """Ids that went out of view or out of the world."""


class Interest:
    """The avatars in view of each viewer: always itself, and at most `view_limit` others.

    `rows[viewer]` lists the slots in view, when they were looked at the nearest first; unused
    places hold the capacity, a slot that no avatar ever has. `rows_since` has beside each the tick
    at which it came into view, and `since[viewer, slot]` the same by slot, 0 for what is not in
    view.
    """

    def __init__(self, state: State, rules: Rules) -> None:
        self._state = state
        self._nobody = state.capacity
        limit = min(rules.view_limit, state.capacity)
        self._columns = limit + 1
        self._enter_columns = self._columns - limit // 8
        self._enter_m = rules.view_radius_m
        self._leave_m = rules.view_radius_m * LEAVE_RATIO
        self.viewing = np.zeros(state.capacity, dtype=np.bool_)
        self.looked: Slots = np.zeros(0, dtype=np.int64)
        """Viewers whose turn it was in the latest update."""
        self.rows = np.full((state.capacity, self._columns), self._nobody, dtype=np.int64)
        self.rows_since = np.zeros((state.capacity, self._columns), dtype=np.int32)
        self.since = np.zeros((state.capacity, state.capacity + 1), dtype=np.int32)
        self._unseeing = np.zeros(state.capacity, dtype=np.bool_)
        self._changes = Changes()

    def attach(self, slot: int) -> None:
        """Let this avatar look, with nothing in view so far."""
        self.detach(slot)
        self.viewing[slot] = self._unseeing[slot] = True

    def detach(self, slot: int) -> None:
        """Let this avatar look no more."""
        self.viewing[slot] = self._unseeing[slot] = False
        self.rows[slot] = self._nobody
        self.since[slot] = 0
        self._changes.left.pop(int(self._state.ids[slot]), None)

    def remove(self, slot: int, avatar_id: int) -> None:
        """Take an avatar that left the world out of every view, at once."""
        self.detach(slot)
        for viewer in self.seen_by(slot).tolist():
            place = self.rows[viewer] == slot
            self.rows[viewer, place] = self._nobody
            self.rows_since[viewer, place] = 0
            self._changes.left[int(self._state.ids[viewer])].append(avatar_id)
        self.since[:, slot] = 0

    def seen_by(self, slot: int) -> Slots:
        """Slots of those who have this avatar in view."""
        return np.flatnonzero(self.since[:, slot])

    def viewers(self) -> Slots:
        return np.flatnonzero(self.viewing)

    def update(self, places_cm: Slots, tick: int) -> Changes:
        """Look again for those whose turn it is; returns all changes since the last call."""
        viewers = self.viewers()
        in_turn = (self._state.ids[viewers] + tick) % PERIOD_TICKS == 0
        due = viewers[in_turn | self._unseeing[viewers]]
        self.looked = due
        if len(due):
            self._look(due, places_cm, tick)
            self._unseeing[due] = False
        changes, self._changes = self._changes, Changes()
        return changes

    def _nearest(self, due: Slots, places_cm: Slots) -> tuple[Slots, Slots]:
        """Squared distances (V, C), cm2, and slots of the nearest; of equals the older first."""
        live = self._state.live()
        live = live[np.argsort(self._state.ids[live])]
        apart2 = ((places_cm[live] - places_cm[due][:, None]) ** 2).sum(axis=-1)
        order = np.argsort(apart2, axis=1, kind="stable")[:, : self._columns]
        shape = len(due), self._columns
        found, least = np.full(shape, self._nobody), np.full(shape, np.iinfo(np.int64).max)
        found[:, : order.shape[1]] = live[order]
        least[:, : order.shape[1]] = np.take_along_axis(apart2, order, axis=1)
        found[least > (100.0 * self._leave_m) ** 2] = self._nobody
        return least, found

    def _look(self, due: Slots, places_cm: Slots, tick: int) -> None:
        viewer = due[:, None]
        distances2, found = self._nearest(due, places_cm)
        # If many avatars stand on one spot, a viewer may not be among its own nearest.
        hidden = ~(found == viewer).any(axis=1)
        found[hidden, -1] = due[hidden]

        since = self.since[viewer, found]
        near = (distances2 <= (100.0 * self._enter_m) ** 2) & (
            np.arange(self._columns) < self._enter_columns
        )
        keep = (found != self._nobody) & ((since > 0) | near | (found == viewer))
        row, column = np.nonzero(keep)

        old = self.rows[due]
        stamps = np.where(since > 0, since, tick)
        self.since[viewer, old] = 0
        self.since[due[row], found[row, column]] = stamps[row, column]
        self.rows[due] = np.where(keep, found, self._nobody)
        self.rows_since[due] = np.where(keep, stamps, 0)

        gone = (old != self._nobody) & (self.since[viewer, old] == 0)
        ids = self._state.ids
        for r, c in np.argwhere(gone).tolist():
            self._changes.left[int(ids[due[r]])].append(int(ids[old[r, c]]))
        for r, c in np.argwhere(keep & (since == 0)).tolist():
            self._changes.entered[int(ids[due[r]])].append(int(found[r, c]))
