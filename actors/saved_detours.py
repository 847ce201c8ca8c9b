"""Saved ways around those who stand; what cannot be there is refused before anything changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from esplanade.planning.routes.shut_way import Disc

MOST_DETOURS: Final = 16
"""No more goals than this have a way around people at once; other actors wait."""


class SavedDetour(NamedTuple):
    """A way to the goal of the actor in a row, around `shut`; one around `wanted` is to follow."""

    row: int
    shut: tuple[Disc, ...]
    wanted: tuple[Disc, ...]

    def plain(self) -> list[Any]:
        """The same as plain data."""
        return [self.row, [list(disc) for disc in self.wanted], [list(disc) for disc in self.shut]]


def read_detours(saved: Sequence[Sequence[Any]], actors: int) -> list[SavedDetour]:
    """Ways around those who stand, of as many actors, from plain data.

    Data of before the places in `shut` were saved have a row and `wanted` only.

    Raises
    ------
    ValueError, TypeError
        It is no such data.
    """
    if len(saved) > MOST_DETOURS:
        raise ValueError(f"there are {len(saved)} ways around people, {MOST_DETOURS} are possible")
    found = []
    for row, wanted, *shut in saved:
        if not 0 <= int(row) < actors:
            raise ValueError(f"a way around people is of actor {row}, of {actors}")
        places = _discs(wanted)
        if places:
            found.append(SavedDetour(int(row), _discs(shut[0]) if shut else places, places))
    return found


def _discs(saved: Sequence[Sequence[Any]]) -> tuple[Disc, ...]:
    discs = tuple((float(x), float(y), float(z), float(r)) for x, y, z, r in saved)
    if not np.isfinite(np.array(discs)).all():
        raise ValueError("a place that a way leads around is none")
    return discs
