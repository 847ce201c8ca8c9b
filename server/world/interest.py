"""Interest management: each viewer sees the nearest avatars, with hysteresis at the edge.

Of those in view, the steps of the nearest are sent too, likewise with hysteresis.
"""

from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np

from esplanade.server.world.avatars import Avatars
from esplanade.server.world.buckets import sort_into_buckets
from esplanade.server.world.byte_budget import FIRST_REACH
from esplanade.server.world.compiled._interest_kernels import (
    NOT_NEAR,
    Limits,
    Views,
    drop_gone,
    look,
    settle_all,
)
from esplanade.server.world.compiled._snapshot_kernels import Budget
from esplanade.server.world.rules import Rules
from esplanade.server.world.state import Slots

LEAVE_RATIO: Final = 1.15
"""An avatar goes out of view at this multiple of the distance at which it comes into view."""

PERIOD_TICKS: Final = 4
"""Each viewer's view is computed anew every so many ticks; an avatar that leaves goes at once."""

FIRST_VIEWERS: Final = 16


class Interest:
    """The avatars in view of each viewer: always its own, and at most `view_limit` others.

    The tables have a row for each viewer and a column for each avatar in view, so that they grow
    with what is seen and not with the zone.
    """

    def __init__(self, avatars: Avatars, rules: Rules) -> None:
        self._avatars = avatars
        columns = rules.view_limit + 1
        self._most = rules.steps_limit + 1
        self._limits = Limits(
            enter=100.0 * rules.view_radius_m,
            leave=100.0 * rules.view_radius_m * LEAVE_RATIO,
            enter_rank=columns - rules.view_limit // 8,
            step_enter=100.0 * rules.steps_radius_m,
            step_leave=100.0 * rules.steps_radius_m * LEAVE_RATIO,
        )
        self._places: dict[int, int] = {}
        self._free = list(range(FIRST_VIEWERS - 1, -1, -1))
        self._at_once: set[int] = set()
        """Places of viewers who look in the next tick, whether it is their turn or not."""
        shape = FIRST_VIEWERS, columns
        self.views = Views(
            avatar=np.zeros(FIRST_VIEWERS, dtype=np.int64),
            seen=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            encoded=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            written=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            ack=np.zeros(FIRST_VIEWERS, dtype=np.int64),
            rows=np.zeros(shape, dtype=np.int32),
            record_sent=np.zeros(shape, dtype=np.int32),
            step_sent=np.zeros(shape, dtype=np.int32),
            under_way=np.zeros(shape, dtype=np.uint8),
            credit=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            reach=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            most=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            calm=np.zeros(FIRST_VIEWERS, dtype=np.int32),
            turn=np.zeros(FIRST_VIEWERS, dtype=np.int32),
        )

    @property
    def walkers_shown(self) -> int:
        """Number of avatars whose steps are sent, counted for each viewer."""
        views = self.views
        used = np.arange(views.rows.shape[1]) < views.seen[:, None]
        return int(np.count_nonzero(used & (views.step_sent != NOT_NEAR)))

    def attach(self, avatar_id: int, *, steps: bool) -> None:
        """Let this avatar look, with nothing in view so far; it is sent steps, or none at all."""
        self.detach(avatar_id)
        if not self._free:
            self._grow()
        place = self._places[avatar_id] = self._free.pop()
        views = self.views
        views.avatar[place] = self._avatars.row(avatar_id)
        views.most[place] = self._most if steps else 0
        views.reach[place] = min(FIRST_REACH, views.most[place])
        self._at_once.add(place)

    def detach(self, avatar_id: int) -> None:
        """Let this avatar look no more."""
        place = self._places.pop(avatar_id, None)
        if place is None:
            return
        views = self.views
        views.avatar[place] = views.seen[place] = views.ack[place] = 0
        views.encoded[place] = views.written[place] = 0
        views.credit[place] = views.calm[place] = views.turn[place] = 0
        self._at_once.discard(place)
        self._free.append(place)

    def viewers(self) -> Slots:
        """Places of those who look, int64 (V,)."""
        return np.flatnonzero(self.views.avatar)

    def ids(self, viewers: Slots) -> Slots:
        """Ids of the avatars through whose eyes these viewers look."""
        return self._avatars.ids[self.views.avatar[viewers]]

    def acknowledge(self, begun: Mapping[int, int]) -> None:
        """Avatars have begun these movements; their viewers, if there are any, are told so."""
        here = self._places.keys() & begun.keys()
        places = [self._places[avatar_id] for avatar_id in here]
        self.views.ack[places] = [begun[avatar_id] for avatar_id in here]

    def charge(self, sizes: Mapping[int, int], budget: Budget) -> None:
        """Charge viewers, by their ids, for bytes beside snapshots and steps.

        Nobody owes more than was to be saved up, so that a newcomer to a crowd sees it move soon.
        """
        here = self._places.keys() & sizes.keys()
        places = [self._places[viewer] for viewer in here]
        credit = self.views.credit[places]
        owed = credit - np.array([sizes[viewer] for viewer in here], dtype=np.int64)
        lowest = np.minimum(credit, budget.refill - budget.most)
        self.views.credit[places] = np.maximum(owed, lowest)

    def sees(self, viewer_id: int, avatar_id: int) -> bool:
        """Whether that viewer has that avatar in view."""
        place, row = self._places.get(viewer_id), self._avatars.row(avatar_id)
        if place is None or not row:
            return False
        return bool((self.views.rows[place, : self.views.seen[place]] == row).any())

    def seen_by(self, avatar_ids: Iterable[int]) -> dict[int, list[int]]:
        """Ids of the viewers who have each of these avatars in view, by the avatar's id."""
        rows = [row for row in map(self._avatars.row, set(avatar_ids)) if row]
        if not rows:
            return {}
        wanted = np.zeros(len(self._avatars.ids), dtype=np.bool_)
        wanted[rows] = True
        views = self.views
        used = np.arange(views.rows.shape[1]) < views.seen[:, None]
        viewers, columns = np.nonzero(wanted[views.rows] & used)
        seen: dict[int, list[int]] = {one: [] for one in self._avatars.ids[rows].tolist()}
        ids = self._avatars.ids[views.rows[viewers, columns]].tolist()
        for avatar_id, viewer in zip(ids, self.ids(viewers).tolist(), strict=True):
            seen[avatar_id].append(viewer)
        return seen

    def notice(self, newcomers: Iterable[int]) -> None:
        """Let everyone whose view these avatars may be in look in this tick."""
        viewers = self.viewers()
        here = self._avatars.places[self.views.avatar[viewers]]
        for newcomer in newcomers:
            there = self._avatars.places[self._avatars.row(newcomer)]
            near = ((here - there) ** 2).sum(axis=1) <= self._limits.enter**2
            self._at_once.update(viewers[near].tolist())

    def settle(self) -> None:
        """Take down what was written of the snapshots of the tick before."""
        settle_all(self.views)

    def drop(self, ids: Iterable[int]) -> dict[int, list[int]]:
        """Take avatars that leave the world out of every view; returns their ids, by viewer."""
        rows = [row for row in map(self._avatars.row, ids) if row]
        if not rows:
            return {}
        for avatar_id in self._avatars.ids[rows].tolist():
            self.detach(avatar_id)
        gone = np.zeros(len(self._avatars.ids), dtype=np.bool_)
        gone[rows] = True
        left = np.empty((int(self.views.seen.sum()), 2), dtype=np.int64)
        left = left[: drop_gone(self.views, gone, left)]
        pairs: dict[int, list[int]] = {}
        viewers, others = self.ids(left[:, 0]).tolist(), self._avatars.ids[left[:, 1]].tolist()
        for viewer, other in zip(viewers, others, strict=True):
            pairs.setdefault(viewer, []).append(other)
        return pairs

    def look(self, tick: int) -> tuple[dict[int, list[int]], dict[int, list[int]]]:
        """Look again for those whose turn it is.

        Returns the rows of avatars that came into view, and the ids of those that went out of it,
        both by the viewer's id.
        """
        viewers = self.viewers()
        in_turn = (self.ids(viewers) + tick) % PERIOD_TICKS == 0
        if self._at_once:
            in_turn |= np.isin(viewers, list(self._at_once))
            self._at_once.clear()
        due = viewers[in_turn]
        if not len(due):
            return {}, {}
        shape = len(due), self.views.rows.shape[1]
        entered, left = np.empty(shape, dtype=np.int64), np.empty(shape, dtype=np.int64)
        ends = np.empty((len(due), 2), dtype=np.int64)
        buckets = sort_into_buckets(self._avatars)
        look(self.views, due, buckets, self._limits, entered, left, ends)
        ids = self._avatars.ids
        came = self._by_viewer(due, entered, ends[:, 0])
        went = self._by_viewer(due, left, ends[:, 1])
        return came, {viewer: ids[rows].tolist() for viewer, rows in went.items()}

    def _by_viewer(self, viewers: Slots, found: Slots, ends: Slots) -> dict[int, list[int]]:
        """The first `ends` of each row of `found`, by the viewer's id, where there are any."""
        some = np.flatnonzero(ends)
        places, lasts = self.ids(viewers[some]).tolist(), ends[some].tolist()
        return {
            viewer: found[i, :last].tolist()
            for viewer, i, last in zip(places, some.tolist(), lasts, strict=True)
        }

    def _grow(self) -> None:
        """Make room for twice as many viewers."""
        before = len(self.views.avatar)
        self.views = Views(*(np.concatenate([one, np.zeros_like(one)]) for one in self.views))
        self._free = list(range(2 * before - 1, before - 1, -1))
