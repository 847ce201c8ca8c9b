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
WIDER_M: Final = 0.25, 0.35
WIDEST_M: Final = 0.75
"""A gap is shut by so much more room to whoever stands beside it, the more up to that radius."""


class Standing(NamedTuple):
    """K bodies that stand: `discs` (K, 4) of `Disc`, with room, and `stood_s` (K,) seconds, > 0."""

    discs: NDArray[np.float64]
    stood_s: NDArray[np.float64]


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


def widest(discs: set[Disc]) -> set[Disc]:
    """Of discs around one place the widest."""
    best: dict[tuple[float, ...], Disc] = {}
    for disc in discs:
        if disc[3] > best.get(disc[:3], disc)[3] or disc[:3] not in best:
            best[disc[:3]] = disc
    return set(best.values())


def as_known(discs: NDArray[np.float64], known: Sequence[Disc]) -> NDArray[np.float64]:
    """Discs (K, 4) with the room that those of them have which are known."""
    rooms = {disc[:3]: disc[3] for disc in known}
    found = discs.copy()
    for k, (x, y, z, room) in enumerate(discs.tolist()):
        found[k, 3] = max(rooms.get((x, y, z), 0.0), room)
    return found
