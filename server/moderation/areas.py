"""Areas of one storey or of all, as polygons."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

Place = tuple[float, float, float]
"""x, y and height, metres."""

TREAD_M: Final = 0.5
"""Who stands so much lower than a storey already counts to it: a step, or the head of a ramp."""


@dataclass(frozen=True)
class Area:
    """A polygon on the storey that is nearest to a height, or on all of them."""

    polygon: tuple[tuple[float, float], ...]
    storey_m: float | None

    def holds(self, place: Place, storeys: Sequence[float]) -> bool:
        """Whether a place is inside; `storeys` are the heights of all, the lowest first."""
        x, y, z_m = place
        if self.storey_m is not None and not same_storey(z_m, self.storey_m, storeys):
            return False
        inside = False
        x0, y0 = self.polygon[-1]
        for x1, y1 in self.polygon:
            if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
                inside = not inside
            x0, y0 = x1, y1
        return inside


def same_storey(z_m: float, storey_m: float, storeys: Sequence[float]) -> bool:
    """Whether a height belongs to the storey that another one names."""
    return _storey(z_m, storeys) == _storey(storey_m, storeys)


def _storey(z_m: float, storeys: Sequence[float]) -> int:
    """The number of the highest storey that is not above a height; 0 for one below all."""
    return max(1, bisect_right(storeys, z_m + TREAD_M))
