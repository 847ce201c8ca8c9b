"""From heights to floors and back: clients speak of heights, the grid of layers."""

import numpy as np

from server.world.state import Floats, Slots
from server.world.ways import Point


def point_at(x: float, y: float, _z: float) -> Point:
    """The place that a client means by x, y and the height of the feet, metres.

    A zone has one floor, the ground; whatever height is named, that is the nearest one.
    """
    return x, y, 0


def heights_at(positions: Floats, _layers: Slots) -> Floats:
    """Heights of the floor at positions (N, 2), metres: that of the ground, float64 (N,)."""
    return np.zeros(len(positions))
