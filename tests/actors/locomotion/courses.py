"""Courses and footprints of a single body, for tests."""

import numpy as np

from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, Course
from esplanade.planning.compiled.arrays import Floats

LEG = np.array([0.9])


def course(velocity: tuple[float, float], heading: float = 0.0, rise_mps: float = 0.0) -> Course:
    """A course from the origin straight on."""
    times = np.arange(AHEAD) * AHEAD_S
    ahead = np.stack([velocity[0] * times, velocity[1] * times, rise_mps * times], axis=1)
    return Course(np.array([heading]), ahead[None])


def standing_on(x: float, y: float, heading: float = 0.0, z: float = 0.0) -> Floats:
    """A footprint (1, 4)."""
    return np.array([[x, y, z, heading]])
