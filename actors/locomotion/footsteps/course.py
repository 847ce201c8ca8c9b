"""Courses: where bodies are and are going, as far as is known."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.footsteps import _course_kernels as kernels
from esplanade.planning.compiled.arrays import Floats, Ints

AHEAD_S: Final = kernels.AHEAD_S
"""Time between the places of a course."""
AHEAD: Final = kernels.AHEAD
"""Number of places of a course."""

WALKING_MPS: Final = kernels.WALKING_MPS
"""A body that is faster than this turns to where it goes."""


class Course(NamedTuple):
    """Reference trajectories of N bodies over the next 1.2 seconds."""

    headings: Floats
    """(N,), radians from +x: where the bodies face while they stand."""
    ahead: Floats
    """(N, AHEAD, 3), metres: places from now on, AHEAD_S apart."""

    def take(self, rows: Ints) -> Course:
        """The courses of some of the bodies."""
        return Course(self.headings[rows], self.ahead[rows])


def planned_places(planned: Floats, slice_s: float, now_s: float, places: Floats) -> Floats:
    """Places of bodies from now on that follow plans, as in `Course.ahead`.

    Parameters
    ----------
    planned : float64 (N, K, 3), metres, `slice_s` seconds apart
    slice_s : seconds between the places of a plan
    now_s : seconds since the plans began
    places : float64 (N, 3), metres: where the bodies are, wherever limits of speed have let them
        get; within a second they are back on their plans

    Returns
    -------
    float64 (N, AHEAD, 3), metres
    """
    out = np.empty((len(planned), AHEAD, 3))
    kernels.follow_plans(planned, slice_s, now_s, places, out)
    return out
