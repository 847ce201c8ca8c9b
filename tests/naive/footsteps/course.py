"""Courses, and where bodies are on them after a time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, WALKING_MPS
from esplanade.planning.compiled.arrays import Floats, Ints

__all__ = ["AHEAD", "AHEAD_S", "WALKING_MPS", "Course", "desired_headings"]


class Course(NamedTuple):
    """As `esplanade.actors.locomotion.footsteps.course.Course`."""

    headings: Floats
    ahead: Floats

    def take(self, rows: Ints) -> Course:
        return Course(self.headings[rows], self.ahead[rows])

    def at(self, seconds: Floats) -> Floats:
        """Places after times (N,), seconds from now: float64 (N, 3), metres."""
        place = np.clip(seconds / AHEAD_S, 0.0, AHEAD - 1.0)
        k = np.minimum(place.astype(np.int64), AHEAD - 2)
        rows = np.arange(len(k))
        before, after = self.ahead[rows, k], self.ahead[rows, k + 1]
        return np.asarray(before + (place - k)[:, None] * (after - before))

    def velocity(self, seconds: Floats) -> Floats:
        """Velocities about times (N,), seconds from now: float64 (N, 2), metres a second."""
        half = 0.5 * AHEAD_S
        before = np.minimum(half, np.maximum(seconds, 0.0))
        moved = self.at(seconds + half) - self.at(seconds - before)
        return np.asarray(moved[:, :2] / (half + before)[:, None])


def desired_headings(course: Course, velocity: Floats) -> Floats:
    """Headings that bodies want: the direction in which they walk, else as their courses say."""
    walking = np.hypot(velocity[:, 0], velocity[:, 1]) > WALKING_MPS
    return np.where(walking, np.arctan2(velocity[:, 1], velocity[:, 0]), course.headings)
