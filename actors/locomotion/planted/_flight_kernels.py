"""Running: steps so long that both feet are in the air at their ends.

A step has a flight if its footprints are further apart than legs reach. Like all else of a planted
step that follows from the footprints alone, so that one step ends as the next one begins. Lengths
are shares of the leg's.
"""

from __future__ import annotations

import math

from esplanade.actors.locomotion.gait._curve_kernels import mix, smooth
from esplanade.planning.compiled.jit import inlined

SHORTEST_RUN = 0.87
"""A step that is longer than this has a flight."""
LANDS_AHEAD = 0.28
"""A runner's heel lands this far ahead of the hips."""
LANDING_HEIGHT = 0.95
"""Height of a runner's hips above the ground at a landing."""
STRIKE = 0.06
"""Pitch of a runner's foot as it lands, radians: nearly flat."""
LAST_PITCH = 1.15
"""The foot that has pushed off is pitched by this at the end of the step, toe down, radians."""

_CONTACT = 0.8
"""A runner's foot bears the body over this distance."""
_STEEPEST_RUN = 0.2
"""Steps that rise or fall by more than this have no flight: stairs are climbed tread by tread."""
_LONGEST_FLIGHT = 0.45
"""Largest share of a step that is flown."""
_PUSH_PITCH = 0.5
"""Pitch at which the toe of the standing foot pushes off, radians."""
_RISES_FROM = 0.35
"""Share of a step from which the heel of the standing foot rises."""
_TOWED = 0.5
"""Share of the way of the hips in flight that the toe behind comes along."""
_TOWED_UP = 0.45
"""The height by which this toe rises, as a share of that way."""
_CREST = 0.87
"""Share of a step at which a runner's hips are highest, amid the flight."""
_SWELL = 0.026
"""Half of the height by which they rise and fall."""
_TURN = 2.0 * math.pi


@inlined
def flight_share(ahead: float, rise: float) -> float:
    """Share of a step that is flown, at its end; `ahead` and `rise` lie between its footprints."""
    if ahead <= SHORTEST_RUN or abs(rise) > _STEEPEST_RUN:
        return 0.0
    return min(1.0 - _CONTACT / ahead, _LONGEST_FLIGHT)


@inlined
def running_height(u: float) -> float:
    """Height of a runner's hips above level ground at a share of the step."""
    wave = math.cos(_TURN * (u - _CREST)) - math.cos(_TURN * _CREST)
    return LANDING_HEIGHT + _SWELL * wave


@inlined
def flown(u: float, flight: float) -> float:
    """Share of the flight that is over at a share of the step; 0 without a flight."""
    if flight <= 0.0:
        return 0.0
    return min(max((u - 1.0 + flight) / flight, 0.0), 1.0)


@inlined
def pushing_pitch(u: float, flight: float) -> float:
    """Angle by which the heel of a foot that pushes off is up about its toe, radians."""
    raised = smooth((u - _RISES_FROM) / (1.0 - flight - _RISES_FROM))
    over = flown(u, flight)
    return mix(_PUSH_PITCH * raised, LAST_PITCH, over * over)


@inlined
def towed(travel_x: float, travel_y: float, flight: float) -> tuple[float, float, float]:
    """Way of the toe of the foot behind in a flight, while hips travel so far in the whole step.

    The toe begins to move with the flight, and its way grows with the square of the time: a
    reader needs nothing but the share that is flown.
    """
    up = _TOWED_UP * flight * math.hypot(travel_x, travel_y)
    return _TOWED * flight * travel_x, _TOWED * flight * travel_y, up
