"""Doors: barriers that open and close while the world runs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Doors:
    """The doors of a zone by name, as the first rows of its barriers.

    An open door has a rise of 0, so that it stops nobody.
    """

    barriers: NDArray[np.float64]
    """All barriers of the zone, see `esplanade.planning.ground.barriers.Barriers`; not a copy."""
    rows: Mapping[str, int]

    def __iter__(self) -> Iterator[str]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def is_open(self, name: str) -> bool:
        """Whether a door is open; KeyError when there is none of that name."""
        return bool(self.barriers[self.rows[name], 6] == 0.0)

    def set_open(self, name: str, is_open: bool) -> tuple[float, float, float, float]:
        """Open or close a door, in place.

        Floors and links stay as they are. What was derived from barriers changes only within
        reach of the rectangle that is returned: x0, y0, x1, y1 in metres.

        Raises
        ------
        KeyError
            There is no door of that name.
        """
        row = self.barriers[self.rows[name]]
        row[6] = 0.0 if is_open else math.inf
        x0, y0, x1, y1 = (float(v) for v in row[:4])
        return min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
