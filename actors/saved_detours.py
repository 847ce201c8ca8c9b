"""Saved ways around those who stand; what cannot be there is refused before anything changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from esplanade.planning.routes.shut_way import Around

MOST_DETOURS: Final = 16
"""No more goals than this have a way around people at once; other actors wait."""


class SavedDetour(NamedTuple):
    """A way to the goal of the actor in a row, around `shut`; one around `wanted` is to follow."""

    row: int
    shut: Around
    wanted: Around
    derived_s: float
    """Time since its latest potential was asked for."""

    def plain(self) -> list[Any]:
        """The same as plain data."""
        ways = *plain_around(self.wanted), *plain_around(self.shut)
        return [self.row, *ways, self.derived_s]


def read_detours(saved: Sequence[Sequence[Any]], actors: int) -> list[SavedDetour]:
    """Ways around those who stand, of as many actors, from plain data.

    Data of earlier versions have a row and the places in `wanted` only.

    Raises
    ------
    ValueError, TypeError
        It is no such data.
    """
    if len(saved) > MOST_DETOURS:
        raise ValueError(f"there are {len(saved)} ways around people, {MOST_DETOURS} are possible")
    found = []
    for row, places, *more in saved:
        if not 0 <= int(row) < actors:
            raise ValueError(f"a way around people is of actor {row}, of {actors}")
        within_m, shut, shut_within_m, derived_s = more or (None, places, None, 0.0)
        if not 0.0 <= float(derived_s) < math.inf:
            raise ValueError(f"the time since a way around people was derived is {derived_s}")
        if places:
            ways = read_around(shut, shut_within_m), read_around(places, within_m)
            found.append(SavedDetour(int(row), *ways, float(derived_s)))
    return found


def plain_around(way: Around) -> list[Any]:
    """A way around places as plain data, the arguments of `read_around`."""
    within_m = None if math.isinf(way.within_m) else way.within_m
    return [[list(disc) for disc in way.places], within_m]


def read_around(saved: Sequence[Sequence[Any]], within_m: float | None) -> Around:
    """The way around places of which that plain data was made.

    Raises
    ------
    ValueError, TypeError
        It is no such data.
    """
    places = tuple((float(x), float(y), float(z), float(r)) for x, y, z, r in saved)
    if not np.isfinite(np.array(places)).all():
        raise ValueError("a place that a way leads around is none")
    if within_m is not None and not 0.0 < float(within_m) < math.inf:
        raise ValueError(f"a way around people leads from within {within_m} m")
    return Around(places, math.inf if within_m is None else float(within_m))
