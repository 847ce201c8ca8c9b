"""Leads actors around people and actors who have stood in a narrow place for a while."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.potential_pool import GoalKey, PotentialPool
from esplanade.actors.saved_detours import SavedDetour
from esplanade.actors.standing_discs import (
    WIDEST_M,
    Standing,
    as_known,
    disc_of,
    narrowed,
    narrower,
    wider,
    widest,
    with_those,
)
from esplanade.actors.ways_around import PAUSE_S, State, WayAround, WaysAround
from esplanade.planning import AgentTable, LayeredGrid
from esplanade.planning.routes.shut_way import REACH_M, Around, Disc, ShutWays

SEEN_S: Final = 0.5
"""A body that has stood for so long is looked for on the ways of actors."""
LOOK_EVERY_S: Final = 0.5
"""An actor looks along its way this often, while anybody stands."""
STAYS: Final = 4.0
"""A body that has stood for a second is expected to stand for this many more."""
GAIN_S: Final = 0.5
"""A way has to be better by this much before an actor takes it rather than the one it goes."""
AROUND_M: Final = 1.5
"""A way beside somebody that is longer by no more than this is left to the search."""
STALLED_S: Final = 1.5
STALLED_M: Final = 6.0
"""An actor that has not got on for so long is led around whoever stands in its way at all, no
further ahead than this: those beyond hold nobody up here."""
STUCK_S: Final = 2.5
"""For an actor that has not got on for so long the gaps beside those who stand near are shut."""
NEAR_M: Final = 2.5
LEAST_M: Final = 8.0
MOST_M: Final = 256.0
FEW_CELLS: Final = 20_000
"""A way around people is derived for cells no further from the goal than the least distance, times
a power of two, up to the most; for all cells beyond that, and where there are few."""
SPARE_M: Final = 6.0
"""It is derived for so much more than where it may pay."""


class Detours:
    """Weighs, for each actor whose way is shut, waiting against another way.

    All actors with a goal share one more potential, in which those who shut the ways of any of them
    are solid. It is derived when such people are found, as far from the goal as it may pay, and
    given up when they have gone.
    """

    def __init__(self, grid: LayeredGrid, potentials: PotentialPool) -> None:
        self._grid = grid
        self._potentials = potentials
        self._around = WaysAround(potentials)
        self._ways: ShutWays | None = None
        self._rooms: dict[tuple[GoalKey, Around], NDArray[np.float64]] = {}
        """Of this tick: discs with the room that they have on the ways to each goal."""
        self.refused = 0
        """Looks at a way that was shut, for whose goal there was no room among `MOST_DETOURS`."""

    def __len__(self) -> int:
        """Number of goals with a way around people."""
        return len(self._around)

    def keep(self, table: AgentTable, standing: Standing, tick_s: float) -> None:
        """Let actors look along their ways, and send them where they get on sooner.

        Nothing is done where nobody stands. Cost O(actors), and for each actor whose turn it is to
        look O(people who stand), and O(metres ahead × those of them in reach).
        """
        trips = table.trips
        seen = standing.stood_s >= SEEN_S
        if not len(self._around) and not seen.any():
            trips.shut[:] = False
            return
        self._around.pass_time(tick_s)
        for key in self._around.forget(standing.discs):
            for row in self._led(table, key):
                self._return(table, row)
        self._take_over(table)
        going = (trips.own_rows >= 0) & (trips.outcomes == 0) & ~table.agents.waits
        trips.look_in_s[going] -= tick_s
        due = going & (trips.look_in_s <= 0.0)
        if due.any() and seen.any():
            bodies = Standing(*(column[seen] for column in standing))
            bodies = bodies._replace(discs=np.round(bodies.discs, 2))
            self._rooms.clear()
            due &= ~self._potentials.provisional(trips.own_rows)
            self._look_all(table, np.flatnonzero(due), bodies)
        elif due.any():
            trips.shut[due] = False
            for row in np.flatnonzero(due & trips.detours).tolist():
                trips.look_in_s[row] = LOOK_EVERY_S
                self._weigh(table, row, 0.0)
        self._around.derive_next()
        self._take_over(table)

    def save(self, table: AgentTable) -> list[list[Any]]:
        """Return the places that ways lead around, each with the row of an actor of that goal."""
        found = []
        for key, way in self._around.items():
            rows = np.flatnonzero(table.trips.own_rows == self._potentials.row(key))
            if len(rows):
                state = way.shut, way.wanted, way.derived_s
                found.append(SavedDetour(int(rows[0]), *state).plain())
        return found

    def load(self, table: AgentTable, saved: Sequence[SavedDetour]) -> None:
        """Lead actors as when this was saved."""
        self._around.clear()
        for row, shut, wanted, derived_s in saved:
            key = self._key(table, row)
            if key is not None and key not in self._around:
                self._around.restore(key, shut, wanted, derived_s)
        self.lead(table)

    def save_exactly(self) -> list[list[Any]]:
        """All ways with the rows of their potentials, as plain data."""
        return self._around.save()

    def load_exactly(self, saved: Sequence[Sequence[Any]]) -> None:
        """Have these ways, whose potentials are there; columns of the table say who goes them.

        Raises
        ------
        ValueError, TypeError
            It is not what `save_exactly` gives.
        """
        self._around.load(saved)

    def lead(self, table: AgentTable) -> None:
        """Let all actors that go around people go by those potentials, as far as they are there."""
        for row in np.flatnonzero(table.trips.detours).tolist():
            detour = self._detour(table, row)
            if detour is not None and self._around.is_there(detour.row):
                table.agents.potential_rows[row] = detour.row

    def undo_point(self) -> Mapping[GoalKey, State]:
        """Return what `put_back` takes."""
        return self._around.states()

    def put_back(self, table: AgentTable, before: Mapping[GoalKey, State]) -> None:
        """Lead actors around the same places as before."""
        if self.undo_point() != before:
            self._around.clear()
            for key, state in before.items():
                self._around.restore(key, *state)
        self.lead(table)

    def _take_over(self, table: AgentTable) -> None:
        """Send actors the ways that have been derived meanwhile."""
        for key in self._around.take_over():
            for row in self._led(table, key):
                self._lead(table, row)

    # --- one actor -----------------------------------------------------------------------

    def _key(self, table: AgentTable, row: int) -> GoalKey | None:
        slot = int(table.trips.own_rows[row])
        key = None if slot < 0 else self._potentials.key(slot)
        return None if key is None else (key[0], key[1], key[2], key[3])

    def _led(self, table: AgentTable, key: GoalKey) -> list[int]:
        """The rows of the actors with a goal that go around people."""
        own = table.trips.own_rows == self._potentials.row(key)
        rows: list[int] = np.flatnonzero(own & table.trips.detours).tolist()
        return rows

    def _look_all(self, table: AgentTable, rows: NDArray[np.int64], standing: Standing) -> None:
        """Let actors look along their ways; most of these are open, and nobody there is stalled."""
        agents, trips = table.agents, table.trips
        trips.look_in_s[rows] = LOOK_EVERY_S
        shut = self._shut_ways().any_shut(
            self._grid.arrays,
            agents.bodies[rows],
            self._potentials.arrays,
            trips.own_rows[rows],
            agents.cells[rows],
            agents.positions[rows],
            standing.discs,
            agents.parameters["radius_m"][rows],
            AROUND_M,
        )
        closely = shut | (trips.stalled_s[rows] >= STALLED_S)
        for row, looks in zip(rows.tolist(), closely.tolist(), strict=True):
            if looks or self._detour(table, row) is not None:
                self._look(table, row, standing)
            else:
                trips.shut[row] = False

    def _look(self, table: AgentTable, row: int, standing: Standing) -> None:
        """Let an actor look along its own way, and along the one around people if it goes there."""
        key = self._key(table, row)
        if key is None:
            return
        trips, own_row = table.trips, int(table.trips.own_rows[row])
        discs = standing.discs
        away = np.hypot(*(discs[:, :2] - table.agents.positions[row]).T)
        reached = away <= REACH_M + discs[:, 3].max() + 2.0 * WIDEST_M
        detour, bare = self._around.of(key), Standing(*(column[reached] for column in standing))
        if detour is not None:
            known = key, detour.wanted
            if known not in self._rooms:
                self._rooms[known] = as_known(discs, detour.wanted.places)
            discs = self._rooms[known]
        discs, away = discs[reached], away[reached]
        shut = self._shut_by(table, row, own_row, discs, AROUND_M)
        trips.shut[row] = shut.any()
        if trips.stalled_s[row] >= STALLED_S and not shut.any():
            here = away <= STALLED_M
            shut[here] = self._shut_by(table, row, own_row, discs[here], 0.0)
        found, narrow = {disc_of(disc) for disc in discs[shut]}, set[Disc]()
        near = np.zeros(len(discs), dtype=np.bool_)
        if trips.stalled_s[row] >= STUCK_S:
            near = (away <= NEAR_M) & (np.abs(discs[:, 2] - table.agents.heights[row]) < NEAR_M)
            shut |= near
        waits_s = STAYS * float(bare.stood_s[shut].max()) if shut.any() else 0.0
        if near.any() and self._shut_off(table, row, detour, waits_s):
            narrow = set(map(narrower, bare.discs[near], bare.radii[near].tolist()))
        else:
            found |= {wider(disc) for disc in bare.discs[near]}
        if table.trips.detours[row] and detour is not None and self._around.is_there(detour.row):
            shut_off = np.array(detour.shut.places)[:, :3]
            more = discs[~(discs[:, None, :3] == shut_off).all(axis=2).any(axis=1)]
            marks = self._shut_by(table, row, detour.row, more, AROUND_M)
            found |= {disc_of(disc) for disc in more[marks]}
        if found or narrow:
            before = set(detour.wanted.places) if detour else set()
            narrow |= narrowed(before, standing.discs)
            places = with_those(widest(found | before), narrow)
            self._lead_around(table, row, key, tuple(sorted(places)), waits_s)
        self._weigh(table, row, waits_s)

    def _lead_around(
        self, table: AgentTable, row: int, key: GoalKey, places: tuple[Disc, ...], waits_s: float
    ) -> None:
        """Have the way of an actor's goal lead around places, from as far as it may pay."""
        detour = self._around.of(key)
        if detour is None and self._around.is_full:
            self.refused += 1
            return
        within_m = 0.0 if detour is None else detour.wanted.within_m
        if detour is None or np.isinf(self._left_m(table, row, detour.row)):
            within_m = max(within_m, self._pays_within_m(table, row, waits_s))
        wanted = Around(places, within_m)
        if (detour is None or wanted != detour.wanted) and not self._around.want(key, wanted):
            table.trips.look_in_s[row] = PAUSE_S  # another goal was first

    def _pays_within_m(self, table: AgentTable, row: int, waits_s: float) -> float:
        """How far from the goal another way may pay, for an actor that would wait on its own."""
        speed_mps = float(table.agents.parameters["speed_mps"][row])
        own_m = self._left_m(table, row, int(table.trips.own_rows[row]))
        if len(self._grid.layered.floors) <= FEW_CELLS:
            return math.inf
        return _enough_m(own_m + waits_s * speed_mps + SPARE_M)

    def _shut_off(
        self, table: AgentTable, row: int, detour: WayAround | None, waits_s: float
    ) -> bool:
        """Whether not even a way around people leads an actor to its goal."""
        if detour is None or detour.wanted != detour.shut or not self._around.is_there(detour.row):
            return False
        if detour.shut.within_m < self._pays_within_m(table, row, waits_s):
            return False
        return bool(np.isinf(self._left_m(table, row, detour.row)))

    def _shut_by(
        self,
        table: AgentTable,
        row: int,
        slot: int,
        discs: NDArray[np.float64],
        around_m: float,
    ) -> NDArray[np.bool_]:
        agents = table.agents
        x, y = agents.positions[row].tolist()
        return self._shut_ways().shut_by(
            self._grid.arrays,
            int(agents.bodies[row]),
            self._potentials.arrays[slot],
            int(agents.cells[row]),
            (x, y),
            discs,
            float(agents.parameters["radius_m"][row]),
            around_m,
        )

    def _shut_ways(self) -> ShutWays:
        if self._ways is None:
            self._ways = ShutWays(len(self._grid.layered.floors))
        return self._ways

    def _weigh(self, table: AgentTable, row: int, waits_s: float) -> None:
        """Send an actor the way on which it arrives sooner; it would wait so long on its own."""
        agents, trips = table.agents, table.trips
        detour = self._detour(table, row)
        if detour is None or not self._around.is_there(detour.row):
            return
        own_m = self._left_m(table, row, int(trips.own_rows[row]))
        other_m = self._left_m(table, row, detour.row)
        speed = float(agents.parameters["speed_mps"][row])
        own_s, other_s = own_m / speed + waits_s, other_m / speed
        if not trips.detours[row]:
            if waits_s > 0.0 and other_s + GAIN_S < own_s:
                trips.detours[row] = True
                self._lead(table, row)
        elif not np.isfinite(other_s) or own_s + GAIN_S < other_s:
            self._return(table, row)
        else:  # its potential may have been derived only now
            self._lead(table, row)

    def _left_m(self, table: AgentTable, row: int, slot: int) -> float:
        cell = int(table.agents.cells[row])
        if cell < 0:
            return float("inf")
        left, x, y = self._potentials.arrays[slot, cell, :3].tolist()
        here = table.agents.positions[row].tolist()
        return float(left + np.hypot(x - here[0], y - here[1]))

    def _detour(self, table: AgentTable, row: int) -> WayAround | None:
        return self._around.of(self._key(table, row))

    def _lead(self, table: AgentTable, row: int) -> None:
        detour = self._detour(table, row)
        if detour is not None and self._around.is_there(detour.row):
            self._go_by(table, row, detour.row)

    def _return(self, table: AgentTable, row: int) -> None:
        table.trips.detours[row] = False
        self._go_by(table, row, int(table.trips.own_rows[row]))

    def _go_by(self, table: AgentTable, row: int, slot: int) -> None:
        """Let an actor go by another potential of its goal; what it follows is weighed anew."""
        agents, trips = table.agents, table.trips
        if agents.potential_rows[row] == slot:
            return
        agents.potential_rows[row] = slot
        agents.left_m[row] = np.nan
        agents.passages[row] = 0.0
        left_m = self._left_m(table, row, slot)
        if np.isfinite(left_m):
            trips.nearest_m[row] = left_m


def _enough_m(needed_m: float) -> float:
    """The least of the distances that ways are derived for which is enough."""
    within_m = LEAST_M
    while within_m < min(needed_m, MOST_M):
        within_m *= 2.0
    return math.inf if needed_m > MOST_M else within_m
