"""Remembers who stands where, and for how long: people and actors that are not on their way."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

STRAY_M: Final = 0.4
"""A body that moves no further than this from where it stands goes on standing there."""
LEVEL_M: Final = 0.5
FADES_PER_S: Final = 2.0
"""A place that has cleared is forgotten this many times faster than it was remembered."""
LONGEST_FADE_S: Final = 3.0
"""A place that has cleared counts for no longer than somebody who has stood there so long."""
LONGEST_S: Final = 60.0
"""To have stood for longer tells no more."""


def stand_on(
    places: NDArray[np.float64],
    anchors: NDArray[np.float64],
    stood_s: NDArray[np.float64],
    tick_s: float,
) -> None:
    """Keep account of bodies at places (N, 3): where each stands (N, 3), and for how long (N,).

    Both are written in place. The place of one that has gone fades before another one counts.
    """
    gone = np.hypot(places[:, 0] - anchors[:, 0], places[:, 1] - anchors[:, 1]) > STRAY_M
    gone |= np.abs(places[:, 2] - anchors[:, 2]) > LEVEL_M
    faded = np.minimum(stood_s, LONGEST_FADE_S) - FADES_PER_S * tick_s
    stood_s[:] = np.where(gone, faded, np.minimum(stood_s + tick_s, LONGEST_S))
    fresh = stood_s <= 0.0
    stood_s[fresh] = 0.0
    anchors[fresh] = places[fresh]


class StandingPeople:
    """Where people stand, by their ids. `anchors` (P, 3) m and `stood_s` (P,) go by `ids`."""

    def __init__(self) -> None:
        self.ids: list[Hashable] = []
        self.anchors: NDArray[np.float64] = np.zeros((0, 3))
        self.stood_s: NDArray[np.float64] = np.zeros(0)
        self._version = -1

    def observe(
        self,
        ids: Sequence[Hashable],
        places: NDArray[np.float64],
        version: int,
        tick_s: float,
    ) -> None:
        """Take in where everyone is; the ids are others only if the version is. O(people)."""
        if version != self._version:
            self._match(list(ids), places)
            self._version = version
        stand_on(places, self.anchors, self.stood_s, tick_s)

    def save(self) -> list[list[Any]]:
        """Those who stand, as plain data: the id, the place and the seconds of each."""
        return [
            [who, *self.anchors[k].tolist(), float(self.stood_s[k])]
            for k, who in enumerate(self.ids)
            if self.stood_s[k] > 0.0 and isinstance(who, str | int)
        ]

    def load(self, saved: Sequence[Sequence[Any]]) -> None:
        """Remember those who stood when this was saved, until people are seen again.

        Raises
        ------
        ValueError, TypeError
            It is no such data.
        """
        rows = np.array([row[1:] for row in saved], dtype=np.float64).reshape(-1, 4)
        if not np.isfinite(rows).all() or (np.abs(rows) > 1e6).any() or (rows[:, 3] < 0.0).any():
            raise ValueError("a place where somebody stands is none")
        self.ids = [row[0] for row in saved]
        self.anchors, self.stood_s = rows[:, :3].copy(), rows[:, 3].copy()
        self._version = -1

    def save_exactly(self) -> dict[str, Any]:
        """Everybody, those included who do not stand, as plain data and copies of arrays."""
        ids = list(self.ids)
        return {"ids": ids, "anchors": self.anchors.copy(), "stood_s": self.stood_s.copy()}

    def load_exactly(self, saved: Mapping[str, Any]) -> None:
        """Remember everybody as when this was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save_exactly` gives.
        """
        self.ids, count = list(saved["ids"]), len(saved["ids"])
        self.anchors = np.array(saved["anchors"], dtype=np.float64).reshape(count, 3)
        self.stood_s = np.array(saved["stood_s"], dtype=np.float64).reshape(count)
        if not (np.isfinite(self.anchors).all() and np.isfinite(self.stood_s).all()):
            raise ValueError("a place where somebody stands is none")
        self._version = -1

    def _match(self, ids: list[Hashable], places: NDArray[np.float64]) -> None:
        known = {who: k for k, who in enumerate(self.ids)}
        anchors, stood_s = places.copy(), np.zeros(len(ids))
        for row, who in enumerate(ids):
            if (k := known.get(who)) is not None:
                anchors[row], stood_s[row] = self.anchors[k], self.stood_s[k]
        self.ids, self.anchors, self.stood_s = ids, anchors, stood_s
