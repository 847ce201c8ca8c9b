"""What to call a place of which nothing is known but where it lies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.scenery.values import Point

_THIRD: Final = 1.0 / 3.0


@dataclass(frozen=True)
class Ground:
    """Ground that people get to: points (N, 3) all over it, and the heights of its storeys, m."""

    points: NDArray[np.float64]
    storeys: tuple[float, ...]

    def name_of(self, point: Point) -> str:
        """Such as `north-east`, or `floor 1, middle` where there is more than one floor."""
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
