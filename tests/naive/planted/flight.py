"""Running: steps so long that both feet are in the air at their ends; arrays of any one shape."""

from __future__ import annotations

import numpy as np

from esplanade.actors.locomotion.gait.curves import smooth
from esplanade.planning.compiled.arrays import Floats

SHORTEST_RUN = 0.87
"""A step that is longer than this has a flight, leg lengths."""
LANDS_AHEAD = 0.28
LANDING_HEIGHT = 0.95
STRIKE = 0.06
LAST_PITCH = 1.15


def flight_share(ahead: Floats, rise: Floats) -> Floats:
    """Shares of steps that are flown at their ends, by what lies between their footprints."""
    runs = (ahead > SHORTEST_RUN) & (np.abs(rise) <= 0.2)
    return np.where(runs, np.minimum(1.0 - 0.8 / np.maximum(ahead, SHORTEST_RUN), 0.45), 0.0)


def running_height(u: Floats) -> Floats:
    """Height of the hips of runners above level ground."""
    turn = 2.0 * np.pi
    wave = np.cos(turn * (u - 0.87)) - np.cos(turn * 0.87)
    return np.asarray(LANDING_HEIGHT + 0.026 * wave)


def flown(u: Floats, flight: Floats) -> Floats:
    """Shares of flights that are over."""
    over = (u - 1.0 + flight) / np.where(flight > 0.0, flight, 1.0)
    return np.where(flight > 0.0, np.clip(over, 0.0, 1.0), 0.0)


def pushing_pitch(u: Floats, flight: Floats) -> Floats:
    """Angles by which heels of feet that push off are up about their toes."""
    raised = 0.5 * smooth((u - 0.35) / (1.0 - flight - 0.35))
    return np.asarray(raised + (LAST_PITCH - raised) * flown(u, flight) ** 2)


def towed(travel: Floats, flight: Floats) -> Floats:
    """Ways (..., 3) of toes behind in flights while hips travel (..., 2) in the whole steps."""
    up = 0.45 * flight * np.hypot(travel[..., 0], travel[..., 1])
    return np.concatenate([(0.5 * flight)[..., None] * travel, up[..., None]], axis=-1)
