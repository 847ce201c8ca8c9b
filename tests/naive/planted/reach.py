"""Legs that are too short: they slow down near full length, raise the heel, and lower the hip."""

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.planning.compiled.arrays import Floats

FULL = 0.9999
"""Legs are stretched to this at most, because a knee that locks moves with infinite speed."""

_ZONE = 0.006
"""Length before FULL over which legs are slowed down."""

_STEEPEST = np.radians(75.0)


def soft_reach(distance: Floats) -> Floats:
    """A distance that stays below FULL: it is kept up to a zone before, then comes ever closer."""
    over = np.maximum(distance - (FULL - _ZONE), 0.0) / _ZONE
    kept: Floats = np.minimum(distance, FULL - _ZONE * np.exp(-np.minimum(over, 700.0)))
    return kept


def drawn_to_hip(hip: Floats, ankle: Floats) -> Floats:
    """Ankles (..., 3) of feet in the air, along the leg into reach."""
    leg = ankle - hip
    distance = np.sqrt(np.sum(leg * leg, axis=-1))
    shrink = soft_reach(distance) / np.maximum(distance, 1e-9)
    moved: Floats = hip + leg * shrink[..., None]
    return moved


def raised_heel(hip: Floats, toe: Floats, heading: Floats, pitch: Floats) -> Floats:
    """Pitch at which a foot that turns about its toe brings the ankle into reach of the hip.

    The ankle moves on a circle about the toe; a closed form says where its distance from the hip is
    the soft reach. Pitches are negative with the heel up, and only ever get more so.
    """
    to_hip = hip - toe
    back = -(np.cos(heading) * to_hip[..., 0] + np.sin(heading) * to_hip[..., 1])
    up = to_hip[..., 2]
    square = np.sum(to_hip * to_hip, axis=-1)
    raised = -pitch
    distance = np.sqrt(
        np.maximum(
            square + FOOT**2 - 2.0 * FOOT * (back * np.cos(raised) + up * np.sin(raised)), 0.0
        )
    )
    wanted = soft_reach(distance)
    projected = (square + FOOT**2 - wanted**2) / (2.0 * FOOT)
    nearest = np.arctan2(up, back)
    spread = np.arccos(np.clip(projected / np.maximum(np.hypot(back, up), 1e-9), -1.0, 1.0))
    needed = np.minimum(nearest - spread, np.maximum(raised, _STEEPEST))
    result: Floats = np.where(wanted < distance, -np.maximum(needed, raised), pitch)
    return result


def hip_ceiling(hip: Floats, ankle: Floats, reach: float) -> Floats:
    """The greatest height at which a hip has an ankle in reach, their distance on the map given."""
    aside = hip[..., :2] - ankle[..., :2]
    level = np.minimum(np.sum(aside * aside, axis=-1), 0.8 * reach**2)
    ceiling: Floats = ankle[..., 2] + np.sqrt(reach**2 - level)
    return ceiling
