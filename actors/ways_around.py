"""Ways around those who stand, one for each goal: derived one after the other, and given up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.potential_pool import GoalKey, PotentialPool, key_of, plain_key
from esplanade.actors.saved_detours import MOST_DETOURS, plain_around, read_around
from esplanade.actors.standing_discs import still_there
from esplanade.planning.routes.shut_way import Around

AGAIN_S: Final = 1.5
"""The way of a goal is derived anew no sooner than this after the last time, so that people who
come and go cost little."""
PAUSE_S: Final = 0.25
"""After the way of any goal was derived, that of another has to wait so long."""

State = tuple[Around, Around, float]
"""`shut`, `wanted` and `derived_s` of a `WayAround`."""


class WayAround(NamedTuple):
    """A way to a goal around `shut`, whose potential is in a row; another one may be on its way."""

    shut: Around
    row: int
    wanted: Around
    coming: tuple[Around, int] | None
    derived_s: float
    """Time since the latest potential was asked for."""


class WaysAround:
    """The ways by the keys of their goals, and their potentials, `MOST_DETOURS` at most."""

    def __init__(self, potentials: PotentialPool) -> None:
        self._potentials = potentials
        self._known: dict[GoalKey, WayAround] = {}

    def __len__(self) -> int:
        return len(self._known)

    def __contains__(self, key: GoalKey) -> bool:
        return key in self._known

    @property
    def is_full(self) -> bool:
        """Whether no goal may have a way that has none."""
        return len(self._known) >= MOST_DETOURS

    def items(self) -> Iterator[tuple[GoalKey, WayAround]]:
        """The goals with their ways."""
        return iter(self._known.items())

    def of(self, key: GoalKey | None) -> WayAround | None:
        """The way of a goal, if it has one."""
        return None if key is None else self._known.get(key)

    def is_there(self, row: int) -> bool:
        """Whether the potential in a row is derived already."""
        return not self._potentials.provisional(np.array([row]))[0]

    def states(self) -> Mapping[GoalKey, State]:
        """All from which `restore` makes the ways again."""
        return {key: (way.shut, way.wanted, way.derived_s) for key, way in self._known.items()}

    def restore(self, key: GoalKey, shut: Around, wanted: Around, derived_s: float) -> None:
        """Have a way derived as it was, around `shut`; that around `wanted` follows in its turn."""
        row = self._potentials.take((*key, shut))
        self._known[key] = WayAround(shut, row, wanted, None, derived_s)

    def save(self) -> list[list[Any]]:
        """All ways as plain data, with the rows of their potentials."""
        return [
            [
                plain_key(key),
                plain_around(way.shut),
                way.row,
                plain_around(way.wanted),
                None if way.coming is None else [plain_around(way.coming[0]), way.coming[1]],
                way.derived_s,
            ]
            for key, way in self._known.items()
        ]

    def load(self, saved: Sequence[Sequence[Any]]) -> None:
        """Have the ways that were saved, and no others; their potentials are there already.

        Raises
        ------
        ValueError, TypeError
            It is not what `save` gives.
        """
        self._known = {}
        for key, shut, row, wanted, coming, derived_s in saved:
            x, y, z_m, kind = key_of(key)[:4]
            self._known[x, y, z_m, kind] = WayAround(
                read_around(*shut),
                int(row),
                read_around(*wanted),
                None if coming is None else (read_around(*coming[0]), int(coming[1])),
                float(derived_s),
            )

    def want(self, key: GoalKey, wanted: Around) -> bool:
        """Have the way of a goal lead around places soon; False if it has none and has to wait."""
        way = self._known.get(key)
        if way is not None:
            self._known[key] = way._replace(wanted=wanted)
        elif self._has_just_derived():
            return False
        else:
            self.restore(key, wanted, wanted, 0.0)
        return True

    def pass_time(self, seconds: float) -> None:
        """Let time pass."""
        for key, way in self._known.items():
            self._known[key] = way._replace(derived_s=way.derived_s + seconds)

    def derive_next(self) -> None:
        """Have the way derived that has to lead around other places for longest, if any is due."""
        due = [
            (-way.derived_s, number, key)
            for number, (key, way) in enumerate(self._known.items())
            if way.coming is None and way.wanted != way.shut and way.derived_s >= AGAIN_S
        ]
        if due and not self._has_just_derived():
            _, _, key = min(due, key=lambda each: each[:2])
            way = self._known[key]
            coming = way.wanted, self._potentials.take((*key, way.wanted))
            self._known[key] = way._replace(coming=coming, derived_s=0.0)

    def take_over(self) -> list[GoalKey]:
        """Take the ways that have been derived meanwhile; returns their goals."""
        taken = []
        for key, way in self._known.items():
            if way.coming is None or not self.is_there(way.coming[1]):
                continue
            shut, row = way.coming
            self._potentials.drop(way.row)
            self._known[key] = way._replace(shut=shut, row=row, coming=None)
            taken.append(key)
        return taken

    def forget(self, discs: NDArray[np.float64]) -> list[GoalKey]:
        """Lead around no place at which none of `discs` (K, 4) is any more.

        Returns the goals whose ways are given up: nobody stands, or nobody has the goal.
        """
        ended = []
        for key, way in list(self._known.items()):
            places = still_there(way.wanted.places, discs)
            if not places or not self._potentials.used(key):
                self._end(key)
                ended.append(key)
            elif places != way.wanted.places:
                self.want(key, way.wanted._replace(places=places))
        return ended

    def clear(self) -> None:
        """Give up all ways."""
        for key in list(self._known):
            self._end(key)

    def _end(self, key: GoalKey) -> None:
        way = self._known.pop(key)
        self._potentials.drop(way.row)
        if way.coming is not None:
            self._potentials.drop(way.coming[1])

    def _has_just_derived(self) -> bool:
        """Whether the way of a goal was asked for a moment ago."""
        return any(way.derived_s < PAUSE_S - 1e-9 for way in self._known.values())
