"""Headings on the map: angles from +x, counter-clockwise, and the axes that they give."""

import numpy as np

from esplanade.planning.compiled.arrays import Floats


def wrap_angle(angle: Floats) -> Floats:
    """The same angles in [-pi, pi), radians, any shape."""
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def forward_and_left(headings: Floats) -> tuple[Floats, Floats]:
    """Unit vectors forward and to the left of headings (N,), radians: two float64 (N, 2)."""
    forward = np.stack([np.cos(headings), np.sin(headings)], axis=1)
    return forward, np.stack([-forward[:, 1], forward[:, 0]], axis=1)
