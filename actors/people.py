"""The people that actors see at a tick, as arrays; a mapping for those who look one up."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.people.prediction import Coordinates

Place = tuple[float, float, float]
"""x, y and the height of the feet, metres."""


class ObservedPeople(Mapping[Hashable, Place]):
    """P people: `ids` (P,) int64 and `places` (P, 3) m, x, y and the height of the feet.

    As a mapping it is id -> place; that is made when it is first looked into.
    """

    def __init__(self, ids: NDArray[np.int64], places: NDArray[np.float64]) -> None:
        self.ids = ids
        self.places = places

    @cached_property
    def _by_id(self) -> dict[Hashable, Place]:
        return {
            who: (x, y, z)
            for who, (x, y, z) in zip(self.ids.tolist(), self.places.tolist(), strict=True)
        }

    def __getitem__(self, who: Hashable) -> Place:
        return self._by_id[who]

    def __iter__(self) -> Iterator[Hashable]:
        return iter(self._by_id)

    def __len__(self) -> int:
        return len(self.ids)


NOBODY = ObservedPeople(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))

People = Mapping[Hashable, Coordinates]
"""id -> (x, y) or (x, y, z); `ObservedPeople` where they come as arrays."""
