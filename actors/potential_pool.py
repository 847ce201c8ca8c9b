"""Potentials of the goals that actors are on their way to, shared by all with the same goal."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import astuple, dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.rows_to_come import rows_to_come
from esplanade.actors.saved_detours import plain_around, read_around
from esplanade.planning import Body, LayeredGrid, Potential
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.routes.shut_way import Around
from esplanade.planning.scene.bodies import LIMITS

Goal = tuple[float, float, float]
"""x, y and height, metres."""
GoalKey = tuple[float, float, float, Body]
"""x, y, height and kind of body, of `kind_for_ways`."""
DetourKey = tuple[float, float, float, Body, Around]
"""The same, and what ways lead around."""
DoorStates = tuple[bool, ...]
"""Whether each door of a ground is open, in their order."""
Origin = tuple[GoalKey | DetourKey, DoorStates]
"""The goal and the ground by which the values of a row were derived."""
_DETOUR_LENGTH = 5
_IDLE_KEPT = 32
_NO_BOUND = int(LIMITS["edge_cells"][1])
"""For bodies whose M forbids nothing, where that of others may."""
_ROWS = ("idle", "spare", "stale", "outdated", "provisional")
_SLACK_M = 0.02
"""A goal may lie closer to a wall than the radius by this."""


@dataclass(frozen=True, eq=False)
class RenewedPotential:
    """The potential of a goal, derived anew outside of ticks."""

    goal: GoalKey | DetourKey
    changes: int
    """The number of changes of the ground when it was derived."""
    values: NDArray[np.float32]
    doors: DoorStates = ()
    """The doors that stood open then."""


class PotentialPool:
    """One row a goal and kind of body in a single array that kernels index.

    Rows nobody uses are kept for the next who goes there and reused, oldest first, when more
    than 32 lie idle. Memory: 16 bytes a cell and goal.
    """

    def __init__(self, grid: LayeredGrid) -> None:
        self._grid = grid
        self.derived_outside = False
        """Whether nobody waits for a goal that is new: its row is provisional until `renew`."""
        self._provisional: set[int] = set()
        self.arrays: NDArray[np.float32] = np.empty(
            (0, len(grid.layered.floors), 4), dtype=np.float32
        )
        self._slots: dict[GoalKey | DetourKey, int] = {}
        self._keys: list[GoalKey | DetourKey | None] = []
        self._origins: list[Origin | None] = []
        """By rows; None for values by which no path leads anywhere."""
        self._users: list[int] = []
        self._idle: list[int] = []
        self._spare: list[int] = []
        """Rows of nothing."""
        self._stale: list[int] = []
        self._changes = 0
        self._outdated: dict[int, None] = {}
        """Rows that wait to be renewed outside of ticks, the longest out of date first."""
        self._plain: tuple[list[Any], dict[str, Any]] | None = None
        """Keys and origins of rows, and the same as plain data, made anew when they are others."""

    def take(
        self,
        key: GoalKey | DetourKey,
        prepared: Mapping[GoalKey, NDArray[np.float32]] | None = None,
    ) -> int:
        """Row of a goal, for one more user.

        A goal that is new is derived here unless it is among those `prepared`. Where potentials are
        derived outside, its row is provisional instead: that of another kind of body with the same
        goal, or one by which no path leads anywhere.
        """
        slot = self._slots.get(key)
        if slot is None:
            ready: Mapping[Any, NDArray[np.float32]] = prepared or {}
            if key in ready:
                slot = self._keep(key, ready[key])
            elif self.derived_outside:
                slot = self._keep_provisional(key)
            else:
                slot = self._keep(key, potential_of(self._grid, key))
        elif slot in self._idle:
            self._idle.remove(slot)
        self._users[slot] += 1
        return slot

    def key(self, slot: int) -> GoalKey | DetourKey | None:
        """The key of a row; None for an empty one."""
        return self._keys[slot]

    def row(self, key: GoalKey | DetourKey) -> int:
        """The row of a goal; -2 if it has none."""
        return self._slots.get(key, -2)

    def used(self, key: GoalKey | DetourKey) -> bool:
        """Whether anybody uses the row of a goal."""
        slot = self._slots.get(key)
        return slot is not None and self._users[slot] > 0

    def has(self, key: GoalKey | DetourKey) -> bool:
        """Whether the row of a goal is there, and not provisional."""
        slot = self._slots.get(key)
        return slot is not None and slot not in self._provisional

    def provisional(self, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Tell for each of some rows (A,) whether it is provisional, bool (A,)."""
        return np.isin(rows, list(self._provisional))

    @property
    def users(self) -> tuple[int, ...]:
        """Number of users of each row."""
        return tuple(self._users)

    def prepare(self, goals: Iterable[GoalKey], threads: int) -> None:
        """Derive the potentials of goals for later users, on threads."""
        wanted = [key for key in dict.fromkeys(goals) if key not in self._slots]
        for *_, body in wanted:
            self._grid.row_of(body)  # derived here, since the threads share the grid
        # Copying rows when one more is needed takes seconds on large ground.
        fresh = min(len(wanted), max(0, _IDLE_KEPT + 1 - len(self._idle)))
        self._reserve(len(self._keys) + fresh)
        with ThreadPoolExecutor(threads, thread_name_prefix="potentials") as pool:
            derive = partial(potential_of, self._grid)
            for key, values in zip(wanted, pool.map(derive, wanted), strict=True):
                self._idle.append(self._keep(key, values))

    def _keep(self, key: GoalKey | DetourKey, values: NDArray[np.float32] | np.float32) -> int:
        slot = self._fresh_slot()
        self.arrays[slot] = values
        self._origins[slot] = key, self._doors()
        self._outdated.pop(slot, None)
        self._provisional.discard(slot)
        self._slots[key] = slot
        self._keys[slot] = key
        return slot

    def _keep_provisional(self, key: GoalKey | DetourKey) -> int:
        alike = [
            slot
            for each, slot in self._slots.items()
            if each[:3] == key[:3] and len(each) < _DETOUR_LENGTH
        ]
        values = self.arrays[alike[0]].copy() if alike else np.float32(np.inf)
        origin = self._origins[alike[0]] if alike else None
        slot = self._keep(key, values)
        self._origins[slot] = origin
        self._outdated[slot] = None
        self._provisional.add(slot)
        return slot

    def release(self, slot: int) -> None:
        """One user less; -1 is nobody's row."""
        if slot < 0:
            return
        self._users[slot] -= 1
        if self._users[slot] == 0:
            self._idle.append(slot)

    def drop(self, slot: int) -> None:
        """One user less of a row that nobody will come back to: it is the next to be used again."""
        self.release(slot)
        if self._users[slot] == 0:
            self._idle.remove(slot)
            self._empty(slot)
            self._spare.append(slot)

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
                self.arrays[slot] = potential_of(self._grid, key)
                self._origins[slot] = key, self._doors()
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

        Provisional ones come before all others. Rows in use by nobody, for bodies that the grid has
        forgotten, are given up. What is returned is heavy and runs in any thread; None if nothing
        is out of date.
        """
        for slot in [slot for slot in self._outdated if not self._users[slot]]:
            key = self._keys[slot]
            if key is not None and not self._grid.knows(key[3]):
                del self._slots[key], self._outdated[slot]
                self._keys[slot] = None
                self._provisional.discard(slot)
        goals = self.outdated_goals()
        if not goals:
            return None
        return partial(self._renewed, self._grid.fork(), goals[0], self._changes, self._doors())

    def outdated_goals(self) -> list[GoalKey | DetourKey]:
        """The goals of potentials that are out of date, in the order in which they are derived.

        Those of bodies that the grid has forgotten are left out, unless somebody uses them.
        """
        order = sorted(
            self._outdated,
            key=lambda slot: (not self._users[slot], slot not in self._provisional),
        )
        keys = [(slot, self._keys[slot]) for slot in order]
        return [
            key
            for slot, key in keys
            if key is not None and (self._users[slot] or self._grid.knows(key[3]))
        ]

    def derived_now(self, goal: GoalKey | DetourKey) -> RenewedPotential:
        """Derive on the ground as it is."""
        return self.derived_again(goal, self._changes)

    def derived_again(self, goal: GoalKey | DetourKey, changes: int) -> RenewedPotential:
        """Derive on the ground as it is what was derived after so many changes of it."""
        return self._renewed(self._grid.fork(), goal, changes, self._doors())

    def renew(self, renewed: RenewedPotential) -> None:
        """Take a potential that was derived anew; it is derived again if the ground has changed."""
        slot = self._slots.get(renewed.goal)
        if slot is None or slot not in self._outdated:
            return
        self.arrays[slot] = renewed.values
        self._origins[slot] = renewed.goal, renewed.doors
        self._provisional.discard(slot)
        del self._outdated[slot]
        if renewed.changes != self._changes:
            self._outdated[slot] = None

    def _renewed(
        self, grid: LayeredGrid, key: GoalKey | DetourKey, changes: int, doors: DoorStates
    ) -> RenewedPotential:
        return RenewedPotential(key, changes, self._values(grid, key), doors)

    def _values(self, grid: LayeredGrid, key: GoalKey | DetourKey) -> NDArray[np.float32]:
        try:
            return potential_of(grid, key)
        except ValueError:  # nobody can stand there any more
            return np.full(self.arrays.shape[1:], np.inf, dtype=np.float32)

    def _doors(self) -> DoorStates:
        doors = self._grid.doors
        return tuple(doors.is_open(name) for name in doors)

    # --- the exact state -----------------------------------------------------------------

    def save(self) -> dict[str, Any]:
        """The rows as plain data. Their values are not in it, but how these were derived."""
        derived = [*self._keys, *self._origins]
        if self._plain is None or self._plain[0] != derived:
            keys = [None if key is None else plain_key(key) for key in self._keys]
            origins = [
                None if each is None or key is None else [plain_key(each[0]), list(each[1])]
                for key, each in zip(self._keys, self._origins, strict=True)
            ]
            self._plain = derived, {"keys": keys, "origins": origins}
        return {
            "derived_outside": self.derived_outside,
            "changes": self._changes,
            **self._plain[1],
            "users": list(self._users),
            "idle": list(self._idle),
            "spare": list(self._spare),
            "stale": list(self._stale),
            "outdated": list(self._outdated),
            "provisional": sorted(self._provisional),
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Have the rows that were saved, and no others; their values are derived anew.

        Doors of the ground move meanwhile, and stand at the end as they did. Heavy: the time of
        each row is that of a new goal, unless a row here has the same values already.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` gives. Nothing is to be done with this pool then.
        """
        keys = [None if each is None else key_of(each) for each in saved["keys"]]
        origins = [
            None if each is None else (key_of(each[0]), tuple(map(bool, each[1])))
            for each in saved["origins"]
        ]
        lists = {name: list(map(int, saved[name])) for name in _ROWS}
        if not len(keys) == len(origins) == len(saved["users"]) or not all(
            0 <= row < len(keys) for rows in lists.values() for row in rows
        ):
            raise ValueError("rows of potentials are named that are not there")
        self._fill(keys, origins)
        self._users = list(map(int, saved["users"]))
        self._slots = {key: row for row, key in enumerate(keys) if key is not None}
        self._idle, self._spare, self._stale = (lists[name] for name in _ROWS[:3])
        self._outdated = dict.fromkeys(lists["outdated"])
        self._provisional = set(lists["provisional"])
        self._changes = int(saved["changes"])
        self.derived_outside = bool(saved["derived_outside"])

    def _fill(self, keys: list[GoalKey | DetourKey | None], origins: list[Origin | None]) -> None:
        """Write the values of rows, each on the ground on which it was derived."""
        known = {
            origin: self.arrays[row].copy()
            for row, origin in enumerate(self._origins)
            if origin is not None
        }
        now, names = self._doors(), tuple(self._grid.doors)
        for doors in sorted(
            {each[1] for each in origins if each is not None and each not in known}
        ):
            for name, is_open in zip(names, doors, strict=True):
                if self._grid.doors.is_open(name) != is_open:
                    self._grid.set_door(name, is_open)
            for origin in origins:
                if origin is not None and origin[1] == doors and origin not in known:
                    known[origin] = self._values(self._grid, origin[0])
        for name, is_open in zip(names, now, strict=True):
            if self._grid.doors.is_open(name) != is_open:
                self._grid.set_door(name, is_open)
        self._keys, self._origins = keys, origins
        self._reserve(len(keys))
        for row, origin in enumerate(origins):
            self.arrays[row] = np.float32(np.inf) if origin is None else known[origin]

    def reserve(self, rows: int) -> None:
        """Make room for so many rows more than are known, before a tick has to."""
        self._reserve(len(self._keys) + rows)

    def _reserve(self, rows: int) -> None:
        """Make room for so many rows; where it has to grow, what stands in those is copied."""
        before = len(self.arrays)
        if rows > before:
            grown = rows_to_come(rows, self.arrays.shape[1:])
            grown[:before] = self.arrays
            self.arrays = grown

    def _empty(self, slot: int) -> None:
        key = self._keys[slot]
        if key is not None:
            del self._slots[key]
            self._keys[slot] = None
        self._outdated.pop(slot, None)
        self._provisional.discard(slot)
        self._stale = [each for each in self._stale if each != slot]

    def _fresh_slot(self) -> int:
        if self._spare:
            return self._spare.pop()
        if len(self._idle) > _IDLE_KEPT:
            slot = self._idle.pop(0)
            self._empty(slot)
            return slot
        slot = len(self._keys)
        if slot == len(self.arrays):
            self._reserve(max(4, 2 * slot))
        self._keys.append(None)
        self._origins.append(None)
        self._users.append(0)
        return slot


def potential_of(grid: LayeredGrid, key: GoalKey | DetourKey) -> NDArray[np.float32]:
    """The potential of a goal for a kind of body; heavy."""
    x, y, z_m, kind, *more = key
    places, within_m = more[0] if more else Around((), math.inf)
    return Potential(
        grid, (x, y), z_m, kind.radius_m, body=kind, shut=places, within_m=within_m
    ).values


@lru_cache(maxsize=4096)
def plain_key(key: GoalKey | DetourKey) -> tuple[Any, ...]:
    """A key as plain data, of which `key_of` makes it again; kept, since goals stay."""
    x, y, z_m, kind, *more = key
    return (x, y, z_m, astuple(kind), *(plain_around(each) for each in more))


def key_of(plain: Sequence[Any]) -> GoalKey | DetourKey:
    """The key of which that was made.

    Raises
    ------
    ValueError, TypeError
        It is no key.
    """
    x, y, z_m, kind, *more = plain
    radius_m, height_m, step_on_m, leg_length_m = map(float, kind[:4])
    body = Body(radius_m, height_m, step_on_m, leg_length_m, int(kind[4]))
    goal = float(x), float(y), float(z_m), body
    if not all(map(math.isfinite, goal[:3])) or len(more) > 1:
        raise ValueError(f"no goal is at ({x}, {y}, {z_m})")
    return (*goal, read_around(*more[0])) if more else goal


def kind_for_ways(grid: LayeredGrid, body: Body) -> Body:
    """The kind of a body, with its own M only where M can forbid a way: else ways are shared."""
    kind = kind_of(body)
    own = replace(kind, edge_cells=body.edge_cells)
    if grid.bounds_edges(own):
        return own
    return replace(kind, edge_cells=_NO_BOUND) if grid.bounds_edges(kind) else kind


def goal_key(grid: LayeredGrid, goal: Goal, body: Body) -> GoalKey | None:
    """The goal of a body, moved to where its kind of body fits; None where it fits nowhere."""
    kind = kind_for_ways(grid, body)
    free = grid.nearest_free(goal[:2], goal[2], kind.radius_m - _SLACK_M, kind)
    return None if free is None else (*free, goal[2], kind)
