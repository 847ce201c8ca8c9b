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

    The barrier of an open door has a climb of 0, so that it stops nobody.
    """

    barriers: NDArray[np.void]
    """(S,): the `Barriers` of the zone; shared, not copied."""
    rows: Mapping[str, int]
    """The row of each door among the barriers."""

    def __iter__(self) -> Iterator[str]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def is_open(self, name: str) -> bool:
        """Whether a door is open; raises KeyError if there is no door of that name."""
        return bool(self.barriers["climb_m"][self.rows[name]] == 0.0)

    def set_open(
        self, name: str, is_open: bool, barriers: NDArray[np.void] | None = None
    ) -> tuple[float, float, float, float]:
        """Open or close a door, in place; returns its rectangle x0, y0, x1, y1 in metres.

        With `barriers`, a copy of those of the zone, it moves there and not in the zone. Floors and
        links stay as they are. All data derived from barriers change only near the rectangle.

        Raises
        ------
        KeyError
            There is no door of that name.
        """
        row = self.rows[name]
        barriers = self.barriers if barriers is None else barriers
        barriers["climb_m"][row] = 0.0 if is_open else math.inf
        x0, y0, x1, y1 = barriers[["x0", "y0", "x1", "y1"]][row].tolist()
        return min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
