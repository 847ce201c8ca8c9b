"""Names for places that are generated: they say in which part of the ground a place is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.scenery.values import Point

_THIRD: Final = 1.0 / 3.0


@dataclass(frozen=True)
class PlaceNamer:
    """Names places by storey and direction within some ground."""

    points: NDArray[np.float64]
    """Points all over the ground, float64 (N, 3), metres."""
    storeys: tuple[float, ...]
    """The heights of its storeys, metres."""

    def name_of(self, point: Point) -> str:
        """The name of a place, such as `north-east`, or `floor 1, middle` with several storeys."""
        low, high = self.points[:, :2].min(axis=0), self.points[:, :2].max(axis=0)
        half = np.maximum(0.5 * (high - low), 1e-6)
        east, north = (np.array(point[:2]) - 0.5 * (low + high)) / half
        words = (
            "north" if north > _THIRD else "south" if north < -_THIRD else "",
            "east" if east > _THIRD else "west" if east < -_THIRD else "",
        )
        where = "-".join(word for word in words if word) or "middle"
        if len(self.storeys) < 2:
            return where
        storey = int(np.abs(np.array(self.storeys) - point[2]).argmin())
        return f"{f'floor {storey}' if storey else 'ground floor'}, {where}"
