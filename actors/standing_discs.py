"""Discs around those who stand: the places that ways lead around, with the room that they get."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.routes.shut_way import Disc

PERSON_ROOM_M: Final = 0.25
"""Room that a way leaves to people who stand; through narrower gaps hardly anybody presses."""
ACTOR_ROOM_M: Final = 0.05
NARROW_ROOM_M: Final = 0.1
"""Room that a way leaves where none leads otherwise."""
WIDER_M: Final = 0.25, 0.35
WIDEST_M: Final = 0.75
"""A gap is shut by so much more room to whoever stands beside it, the more up to that radius."""


class Standing(NamedTuple):
    """K bodies that stand: `discs` (K, 4) of `Disc`, with room, and `stood_s` (K,) seconds, > 0.

    `radii` (K,) are those of the bodies alone, metres.
    """

    discs: NDArray[np.float64]
    stood_s: NDArray[np.float64]
    radii: NDArray[np.float64]


def disc_of(disc: NDArray[np.float64]) -> Disc:
    """A row of discs as a `Disc`, to the centimetre."""
    x, y, z, radius = np.round(disc, 2).tolist()
    return x, y, z, radius


def still_there(known: Sequence[Disc], discs: NDArray[np.float64]) -> tuple[Disc, ...]:
    """Those of the known places, to the centimetre, at which one of `discs` (K, 4) is."""
    places = np.round(discs[:, :3], 2)
    there = (np.array(known)[:, None, :3] == places).all(axis=2).any(axis=1)
    return tuple(disc for disc, stands in zip(known, there.tolist(), strict=True) if stands)


def wider(disc: NDArray[np.float64]) -> Disc:
    """The same place with so much room that no gap beside it is left."""
    x, y, z, radius = disc_of(disc)
    least, most = WIDER_M
    return x, y, z, round(max(radius + least, min(radius + most, WIDEST_M)), 2)


def narrower(disc: NDArray[np.float64], radius_m: float) -> Disc:
    """The same place with hardly any room beside a body of a radius."""
    x, y, z, radius = disc_of(disc)
    return x, y, z, min(radius, round(radius_m + NARROW_ROOM_M, 2))


def widest(discs: set[Disc]) -> set[Disc]:
    """Of discs around one place the widest."""
    best: dict[tuple[float, ...], Disc] = {}
    for disc in discs:
        if disc[3] > best.get(disc[:3], disc)[3] or disc[:3] not in best:
            best[disc[:3]] = disc
    return set(best.values())


def narrowed(known: set[Disc], discs: NDArray[np.float64]) -> set[Disc]:
    """Those of the known discs that have less room than `discs` (K, 4) at the same places."""
    rooms = {disc[:3]: disc[3] for disc in map(disc_of, discs)}
    return {disc for disc in known if disc[3] < rooms.get(disc[:3], 0.0)}


def with_those(discs: set[Disc], others: set[Disc]) -> set[Disc]:
    """The others, and discs at other places."""
    places = {disc[:3] for disc in others}
    return others | {disc for disc in discs if disc[:3] not in places}


def as_known(discs: NDArray[np.float64], known: Sequence[Disc]) -> NDArray[np.float64]:
    """Discs (K, 4) with the room that those of them have which are known, if that is more."""
    rooms = {disc[:3]: disc[3] for disc in known}
    found = discs.copy()
    for k, (x, y, z, room) in enumerate(discs.tolist()):
        found[k, 3] = max(rooms.get((x, y, z), 0.0), room)
    return found
