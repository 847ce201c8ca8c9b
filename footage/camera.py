"""Places of points of the world on a picture, in parallel projection."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from esplanade.planning.compiled.arrays import Floats


@dataclass(frozen=True)
class Camera:
    """A camera that looks at a point from a direction."""

    target: tuple[float, float, float]
    """The point in the middle of the picture, metres."""
    azimuth_deg: float
    """Direction that it looks from, counter-clockwise from the east."""
    elevation_deg: float
    """Angle that it looks down by."""
    scale: float
    """Pixels a metre."""
    size: tuple[int, int]
    """Width and height, pixels."""

    @property
    def axes(self) -> Floats:
        """(3, 3): unit vectors to the right, up, and towards the camera."""
        a, e = math.radians(self.azimuth_deg), math.radians(self.elevation_deg)
        right = (-math.sin(a), math.cos(a), 0.0)
        up = (-math.cos(a) * math.sin(e), -math.sin(a) * math.sin(e), math.cos(e))
        towards = (math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e))
        return np.array((right, up, towards))

    def seen(self, points: ArrayLike) -> Floats:
        """Points (N, 3) from the target: float64 (N, 3), metres, to the right, up, nearer."""
        return np.asarray((np.asarray(points, dtype=np.float64) - self.target) @ self.axes.T)

    def pixels(self, points: ArrayLike) -> Floats:
        """Pixels of points (N, 3), metres, from the upper left corner: float64 (N, 2)."""
        seen = self.seen(points)
        across = 0.5 * self.size[0] + self.scale * seen[:, 0]
        down = 0.5 * self.size[1] - self.scale * seen[:, 1]
        return np.stack((across, down), axis=1)
