"""The duration of a step, from the speed of a body and the reach of its legs."""

from __future__ import annotations

import math

from esplanade.actors.locomotion.footsteps._course_kernels import (
    AHEAD_S,
    WALKING_MPS,
    along,
    velocity_about,
)
from esplanade.actors.locomotion.footsteps._limit_kernels import distance_and_limit, longest_step
from esplanade.actors.locomotion.gait.durations import step_duration_s
from esplanade.actors.locomotion.planted.footprints import Z
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined

CLOSING_S = 0.5
"""Duration of a step that goes nowhere: a foot is drawn up to the other, or the body turns."""
SHORTEST_S = 0.2
SHORTEST_UP_S = 0.25
"""Shortest duration of a step on stairs, up or down."""
SHORTEST_REST_S = 0.2
"""Shortest rest of a step under way that has to end elsewhere."""
LONGEST_S = 0.8

_RISE_M = 0.15
"""Stairs are walked tread by tread: a step that would climb more than this is shortened."""
_HURRY = 2.5
"""A step on stairs is shortened to no less than its length divided by this."""
_UNEVEN_M = 0.12
"""A step with a rise above this is one on stairs."""
_FREE = float(step_duration_s(0.6)) * 0.6
"""Length times duration of a step of a free walk, leg lengths times seconds."""


@inlined
def within_reach_s(ahead: Floats, standing: Floats, leg_m: float, seconds: float) -> float:
    """A duration cut so that a body does not get too far past its standing foot (4,) by then.

    The step would take `seconds` from now on; the result is SHORTEST_REST_S or more.
    """
    x_mps, y_mps = velocity_about(ahead, seconds)
    speed = max(math.hypot(x_mps, y_mps), 0.1)
    distance, limit = distance_and_limit(
        along(ahead, seconds, 0), along(ahead, seconds, 1), standing, speed / leg_m
    )
    rise = abs(along(ahead, seconds, 2) - ahead[0, 2])
    left = seconds - max(distance - limit * leg_m, 0.0) / speed
    steep = max(rise / _RISE_M, 1.0)
    return float(max(left / min(steep, _HURRY), SHORTEST_REST_S))


@inlined
def duration_s(ahead: Floats, standing: Floats, leg_m: float, cadence_factor: float) -> float:
    """Duration of the next step of a body on a course (AHEAD, 3), while its foot (4,) stands.

    Length times duration of a free walk is fixed (`gait/durations.py`), so that the speed decides
    both, up to the longest step of that speed. A body that stands takes CLOSING_S.
    """
    x_mps, y_mps = velocity_about(ahead, 2.0 * AHEAD_S)
    legs_a_second = max(math.hypot(x_mps, y_mps) / leg_m, 1e-9)
    natural = math.sqrt(_FREE * legs_a_second)
    length = min(natural, longest_step(legs_a_second))
    seconds = min(length / legs_a_second / cadence_factor, LONGEST_S)
    if legs_a_second * leg_m < 0.5 * WALKING_MPS:
        seconds = CLOSING_S
    rise = abs(along(ahead, seconds, 2) - standing[Z])
    shortest = SHORTEST_UP_S if rise > _UNEVEN_M else SHORTEST_S
    return max(within_reach_s(ahead, standing, leg_m, seconds), shortest)
