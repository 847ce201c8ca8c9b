"""Footprints, and steps that are given by them."""

from typing import Final, NamedTuple

from esplanade.planning.compiled.arrays import Bools, Floats

# Columns of an array of footprints (N, 4).
PLACE: Final = slice(0, 3)
"""Heel on the ground: x, y, z."""
ON_MAP: Final = slice(0, 2)
"""Heel on the map: x, y."""
Z: Final = 2
"""Height of the ground."""
HEADING: Final = 3
"""The direction of the toe, radians from +x, counter-clockwise."""


class Footprint(NamedTuple):
    """One footprint; in kernels its place is in leg lengths."""

    x: float
    """Place of the heel on the ground."""
    y: float
    z: float
    heading: float
    """The direction of the toe, radians."""


class StepFootprints(NamedTuple):
    """N steps by their footprints: x, y, z of the heel (metres) and heading (radians), world axes.

    During a step one foot stands, and the other one swings from one footprint to the next.
    """

    on_right: Bools
    """(N,): whether the standing foot is the right one."""
    lifted: Floats
    """(N, 4): footprint that the swing foot leaves."""
    standing: Floats
    """(N, 4): footprint of the standing foot."""
    landing: Floats
    """(N, 4): footprint on which the swing foot lands."""
    leg_m: Floats
    """(N,): length of the leg."""
