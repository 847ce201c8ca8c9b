"""What a leg does that is too short: ease up to its length, raise the heel, bring the hip down."""

from __future__ import annotations

import math

from esplanade.actors.locomotion.skeleton import FOOT
from esplanade.planning.compiled.jit import inlined

FULL = 0.9999
"""Legs are never stretched further: a knee that locks moves with infinite speed."""

_ZONE = 0.006
"""Before that they are slowed down over so much."""

_STEEPEST = math.radians(75.0)


@inlined
def eased(distance: float) -> float:
    """A distance that stays below FULL: as it is up to a zone before, then ever closer."""
    over = (distance - (FULL - _ZONE)) / _ZONE
    if over <= 0.0:
        return distance
    return FULL - _ZONE * math.exp(-over)


@inlined
def raised_heel(ahead: float, aside: float, up: float, pitch: float) -> float:
    """Pitch at which a foot that turns about its toe brings the ankle into reach of the hip.

    The hip is so far ahead of the toe, aside of it and above. The ankle moves on a circle about
    the toe; where its distance from the hip is the eased one is a closed form. Pitches are
    negative with the heel up, and only ever get more so.
    """
    square = ahead * ahead + aside * aside + up * up
    raised = -pitch
    along = up * math.sin(raised) - ahead * math.cos(raised)
    distance = math.sqrt(max(square + FOOT * FOOT - 2.0 * FOOT * along, 0.0))
    wanted = eased(distance)
    if wanted >= distance:
        return pitch
    projected = (square + FOOT * FOOT - wanted * wanted) / (2.0 * FOOT)
    share = projected / max(math.hypot(ahead, up), 1e-9)
    needed = math.atan2(up, -ahead) - math.acos(min(max(share, -1.0), 1.0))
    return -max(min(needed, max(raised, _STEEPEST)), raised)


@inlined
def hip_too_high(x: float, y: float, z: float, reach: float) -> float:
    """How much a hip at x, y, z from an ankle must come down for it to be in reach."""
    level = min(x * x + y * y, 0.8 * reach * reach)
    return max(z - math.sqrt(reach * reach - level), 0.0)
