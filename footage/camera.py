"""Where points of the world are on a picture; parallel lines stay parallel."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from esplanade.planning.compiled.arrays import Floats


@dataclass(frozen=True)
class Camera:
    """Looks at a point from a direction."""

    target: tuple[float, float, float]
    """What is amid the picture, metres."""
    azimuth_deg: float
    """From where it looks, counter-clockwise from the east."""
    elevation_deg: float
    """How far above the ground it stands."""
    scale: float
    """Pixels a metre."""
    size: tuple[int, int]
    """Width and height, pixels."""

    @property
    def axes(self) -> Floats:
        """(3, 3): to the right, up, and towards the camera; unit rows."""
        a, e = math.radians(self.azimuth_deg), math.radians(self.elevation_deg)
        right = (-math.sin(a), math.cos(a), 0.0)
        up = (-math.cos(a) * math.sin(e), -math.sin(a) * math.sin(e), math.cos(e))
        towards = (math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e))
        return np.array((right, up, towards))

    def seen(self, points: ArrayLike) -> Floats:
        """Metres (N, 3) to the right, up and nearer than the target, of points (N, 3)."""
        return np.asarray((np.asarray(points, dtype=np.float64) - self.target) @ self.axes.T)

    def pixels(self, points: ArrayLike) -> Floats:
        """Pixels (N, 2) of points (N, 3), from the upper left corner."""
        seen = self.seen(points)
        across = 0.5 * self.size[0] + self.scale * seen[:, 0]
        down = 0.5 * self.size[1] - self.scale * seen[:, 1]
        return np.stack((across, down), axis=1)
