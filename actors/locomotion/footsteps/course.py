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


def planned_places(
    planned: Floats, slice_s: float, now_s: float, places: Floats
) -> tuple[Floats, Ints]:
    """Places of bodies from now on that follow plans, as in `Course.ahead`.

    A body that has been pushed aside or back since its plan began goes on so for about a step: its
    feet land where it is pushed to, not where it would go. One that is only slower than planned, as
    while it starts to walk, is expected to be on its plan.

    Parameters
    ----------
    planned : float64 (N, K, 3), metres, `slice_s` seconds apart
    slice_s : seconds between the places of a plan
    now_s : seconds since the plans began, above 0
    places : float64 (N, 3), metres: where the bodies are, wherever limits of speed and others have
        let them get; within a second they are back on their plans

    Returns
    -------
    ahead : float64 (N, AHEAD, 3), metres
    pushed : int64 (L,)
        Rows of the bodies that do not follow their plans, for which heights are still the plans'.
    """
    out = np.empty((len(planned), AHEAD, 3))
    kernels.follow_plans(planned, slice_s, now_s, places, out)
    moved = places[:, :2] - planned[:, 0, :2]
    return out, kernels.go_on_pushed(planned, slice_s, now_s, moved, out)
