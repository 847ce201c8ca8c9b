"""Areas of portals: which of some places lie in which."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.heights import SAME_SURFACE_M
from esplanade.planning.scene.scene import Portal

NO_PORTAL = -1
"""The number of no portal."""


def portals_at(
    portals: Sequence[Portal], positions: NDArray[np.float64], heights: NDArray[np.float64]
) -> NDArray[np.int64]:
    """The number of the portal that each place lies in, int64 (N,); `NO_PORTAL` for none.

    Positions are float64 (N, 2), heights of feet float64 (N,), metres. A place lies in a portal
    if a ray from it to the east crosses an odd number of the edges (Shimrat, CACM Algorithm 112)
    and its height is within `SAME_SURFACE_M` of the portal's. Of portals that overlap, the first
    counts.
    Cost O(N × corners).
    """
    found = np.full(len(positions), NO_PORTAL, dtype=np.int64)
    x, y = positions[:, 0], positions[:, 1]
    for number in range(len(portals) - 1, -1, -1):
        portal = portals[number]
        inside = np.zeros(len(positions), dtype=np.bool_)
        x0, y0 = portal.points[-1]
        for x1, y1 in portal.points:
            if y0 != y1:
                crosses = (y0 > y) != (y1 > y)
                inside ^= crosses & (x < x0 + (y - y0) / (y1 - y0) * (x1 - x0))
            x0, y0 = x1, y1
        found[inside & (np.abs(heights - portal.z_m) <= SAME_SURFACE_M)] = number
    return found
