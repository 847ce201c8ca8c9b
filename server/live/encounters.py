"""Encounters of actors and people: contacts that begin, and near misses."""

from typing import Final

import numpy as np
import numpy.typing as npt

from esplanade.planning.scene.heights import BODIES_OVERLAP_M
from esplanade.protocol.snapshot import HEADING_RAD, POSITION_M, SPEED_MPS
from esplanade.server.live.map_feed import MapFeed

Pairs = npt.NDArray[np.int64]
NEAR_M: Final = 0.45
"""Bodies that pass with less room between them than this have missed each other narrowly."""
WALKING_MPS: Final = 0.1
TOWARD_COS: Final = 0.5
"""Whoever moves within 60 degrees of the other moves toward it."""
_ID_BITS: Final = 32


class NewContacts:
    """Finds which of the pairs that touch did not in the tick before."""

    def __init__(self) -> None:
        self._before: Pairs = np.empty(0, dtype=np.int64)

    def take(self, touching: Pairs) -> list[tuple[int, int]]:
        """The pairs that are new: the id of an actor's avatar, and that of the other."""
        new = touching[~np.isin(touching, self._before)] if len(touching) else touching
        self._before = touching
        return [(pair >> _ID_BITS, pair & (2**_ID_BITS - 1)) for pair in new.tolist()]


class NearMisses:
    """Counts actors and people who come near without touching; once, until they part."""

    def __init__(self, feed: MapFeed) -> None:
        self._feed = feed
        self._near: Pairs = np.empty(0, dtype=np.int64)

    def count(self, touching: Pairs) -> int:
        """The number of new near misses, by the places of the latest tick."""
        near = self._pairs()
        near = near[~np.isin(near, touching)]
        new = int(np.count_nonzero(~np.isin(near, self._near)))
        self._near = near
        return new

    def _pairs(self) -> Pairs:
        feed, records = self._feed, self._feed.records
        actors, people = feed.rows_by_kind()
        if not len(actors) or not len(people):
            return np.empty(0, dtype=np.int64)
        radii_m = feed.radii_m
        reach = (radii_m[actors].max() + radii_m[people].max() + NEAR_M) / POSITION_M
        people = people[np.argsort(records["x"][people], kind="stable")]
        x_people, x_actors = records["x"][people].astype(float), records["x"][actors].astype(float)
        first = np.searchsorted(x_people, x_actors - reach)
        count = np.searchsorted(x_people, x_actors + reach, side="right") - first
        one = np.repeat(actors, count)
        place = np.arange(count.sum()) - np.repeat(count.cumsum() - count, count)
        other = people[np.repeat(first, count) + place]
        apart = [
            records[name][one].astype(np.float64) - records[name][other].astype(np.float64)
            for name in "xyz"
        ]
        room_m = np.hypot(apart[0], apart[1]) * POSITION_M - radii_m[one] - radii_m[other]
        near = (room_m < NEAR_M) & (np.abs(apart[2]) * POSITION_M < BODIES_OVERLAP_M)
        ids = feed.ids.astype(np.int64)
        return np.sort((ids[one[near]] << _ID_BITS) + ids[other[near]])


def moves_toward(feed: MapFeed, one: int, other: int) -> bool:
    """Whether the first of two avatars moves toward the second, as far as the records tell."""
    here, there = feed.place(one), feed.place(other)
    if here is None or there is None:
        return False
    record = feed.records[int(np.searchsorted(feed.ids, one))]
    if int(record["speed"]) * SPEED_MPS < WALKING_MPS:
        return False
    heading = int(record["heading"]) * HEADING_RAD
    away = np.array(there[:2]) - here[:2]
    length = float(np.hypot(*away)) or 1.0
    along = float(away @ (np.cos(heading), np.sin(heading))) / length
    return along >= TOWARD_COS
