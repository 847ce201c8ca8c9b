"""The duration of a step, from the speed of a body and the reach of its legs."""

from __future__ import annotations

from typing import Final

import numpy as np

from esplanade.actors.locomotion.gait.durations import step_duration_s
from esplanade.actors.locomotion.planted.footprints import Z
from esplanade.planning.compiled.arrays import Floats
from tests.naive.footsteps.course import AHEAD_S, WALKING_MPS, Course
from tests.naive.footsteps.limits import distance_and_limit, longest_step

CLOSING_S: Final = 0.5
"""Duration of a step that goes nowhere: a foot is drawn up to the other, or the body turns."""
SHORTEST_S: Final = 0.2
SHORTEST_UP_S: Final = 0.25
"""Shortest duration of a step on stairs, up or down."""
SHORTEST_REST_S: Final = 0.2
"""Shortest rest of a step under way that has to end elsewhere."""
LONGEST_S: Final = 0.8

_RISE_M: Final = 0.15
"""Stairs are walked tread by tread: a step that would climb more than this is shortened,"""
_HURRY: Final = 2.5
"""but to no less than its length divided by this."""
_UNEVEN_M: Final = 0.12
"""A step with a rise above this is one on stairs."""


def durations_s(course: Course, standing: Floats, leg_m: Floats, cadence_factor: Floats) -> Floats:
    """Durations of the next steps of N bodies.

    Parameters
    ----------
    course : of the bodies
    standing : float64 (N, 4), footprints of the feet that stand during these steps
    leg_m : float64 (N,), metres
    cadence_factor : float64 (N,), see `WalkerTraits`

    Returns
    -------
    float64 (N,), seconds

    Notes
    -----
    Length times duration of a free walk is fixed (`gait/durations.py`), so that the speed decides
    both. A body that stands takes CLOSING_S.
    """
    velocity = course.velocity(np.full(len(leg_m), 2.0 * AHEAD_S))
    legs_a_second = np.maximum(np.hypot(velocity[:, 0], velocity[:, 1]) / leg_m, 1e-9)
    natural = np.sqrt(step_duration_s(np.full_like(leg_m, 0.6)) * 0.6 * legs_a_second)
    length = np.minimum(natural, longest_step(legs_a_second))
    seconds = length / legs_a_second / cadence_factor
    standing_still = legs_a_second * leg_m < 0.5 * WALKING_MPS
    seconds = np.where(standing_still, CLOSING_S, np.minimum(seconds, LONGEST_S))
    rise = np.abs(course.at(seconds)[:, 2] - standing[:, Z])
    shortest = np.where(rise > _UNEVEN_M, SHORTEST_UP_S, SHORTEST_S)
    return np.maximum(within_reach_s(course, standing, leg_m, seconds), shortest)


def within_reach_s(course: Course, standing: Floats, leg_m: Floats, seconds: Floats) -> Floats:
    """Durations cut so that bodies do not get too far past their standing feet by then.

    Parameters
    ----------
    course : of N bodies
    standing : float64 (N, 4), footprints
    leg_m : float64 (N,), metres
    seconds : float64 (N,), how long the steps would take from now on

    Returns
    -------
    float64 (N,), seconds, SHORTEST_REST_S or more
    """
    place = course.at(seconds)
    speed = np.maximum(np.hypot(*course.velocity(seconds).T), 0.1)
    distance, limit = distance_and_limit(place[:, :2], standing, speed / leg_m)
    seconds = seconds - np.maximum(distance - limit * leg_m, 0.0) / speed
    rise = np.abs(place[:, 2] - course.ahead[:, 0, 2])
    steep = np.maximum(rise / _RISE_M, 1.0)
    return np.asarray(np.maximum(seconds / np.minimum(steep, _HURRY), SHORTEST_REST_S))
