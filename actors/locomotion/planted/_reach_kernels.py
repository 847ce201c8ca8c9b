"""Legs that are too short: they slow down near full length, raise the heel, and lower the hip.

Lengths are shares of the leg's.
"""

from __future__ import annotations

import math

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.planning.compiled.jit import inlined

FULL = 0.9999
"""Legs are stretched to this at most, because a knee that locks moves with infinite speed."""

_ZONE = 0.006
"""Length before FULL over which legs are slowed down."""

_STEEPEST = math.radians(75.0)
"""A heel is raised about its toe by this angle at most."""


@inlined
def soft_reach(distance: float) -> float:
    """A distance that stays below FULL: it is kept up to a zone before, then comes ever closer."""
    over = (distance - (FULL - _ZONE)) / _ZONE
    if over <= 0.0:
        return distance
    return FULL - _ZONE * math.exp(-over)


@inlined
def raised_heel(ahead: float, aside: float, up: float, pitch: float) -> float:
    """Pitch at which a foot that turns about its toe brings the ankle into reach of the hip.

    The hip is given by how far it is ahead of the toe, to its side, and above it. The ankle moves
    on a circle about the toe, and a closed form says where its distance from the hip is the soft
    reach. Pitches are negative with the heel up; the result is never above the pitch given.
    """
    square = ahead * ahead + aside * aside + up * up
    raised = -pitch
    along = up * math.sin(raised) - ahead * math.cos(raised)
    distance = math.sqrt(max(square + FOOT * FOOT - 2.0 * FOOT * along, 0.0))
    wanted = soft_reach(distance)
    if wanted >= distance:
        return pitch
    projected = (square + FOOT * FOOT - wanted * wanted) / (2.0 * FOOT)
    share = projected / max(math.hypot(ahead, up), 1e-9)
    needed = math.atan2(up, -ahead) - math.acos(min(max(share, -1.0), 1.0))
    return -max(min(needed, max(raised, _STEEPEST)), raised)


@inlined
def excess_height(x: float, y: float, z: float, reach: float) -> float:
    """The depth by which a hip at x, y, z from an ankle must come down to reach the ankle."""
    level = min(x * x + y * y, 0.8 * reach * reach)
    return max(z - math.sqrt(reach * reach - level), 0.0)
