"""Legs that reach a point, in closed form; and the way back, from angles to points.

Frame: forward, left, up of the pelvis; lengths in shares of the leg's.
"""

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.skeleton import SHIN, THIGH, Floats


class LegAngles(NamedTuple):
    """Rotations from hip to knee, radians, each (...,): of the hip R_up(yaw) R_forward(abduction).

    A positive abduction leads to the left; flexion and knee are those of Boulic's curves.
    """

    yaw: Floats
    abduction: Floats
    flexion: Floats
    knee: Floats


def knee_of_reach(distance: Floats, upper: float, lower: float) -> Floats:
    """Flexion of the joint between two bones whose ends are so far apart; law of cosines."""
    cosine = (upper**2 + lower**2 - distance**2) / (2.0 * upper * lower)
    flexion: Floats = np.pi - np.arccos(np.clip(cosine, -1.0, 1.0))
    return flexion


def leg_ik(ankle: Floats, yaw: Floats) -> tuple[LegAngles, Floats]:
    """Angles that bring an ankle to a point, the knee bending in the plane the foot points along.

    Parameters
    ----------
    ankle : float64 (..., 3), leg lengths
        From the hip joint.
    yaw : float64 (...,), radians
        Heading of the foot against the pelvis, counter-clockwise.

    Returns
    -------
    LegAngles, and float64 (...,): how far from the point the ankle ends up, 0 within reach

    Notes
    -----
    Chen et al., eqs. (2) to (4), in the plane of the leg; hip R_y(yaw) R_z(abduction) R_x(-flexion)
    of the body frame. A point out of reach is approached along the line to it; nothing is NaN.
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    ahead = cos * ankle[..., 0] + sin * ankle[..., 1]
    aside = cos * ankle[..., 1] - sin * ankle[..., 0]
    below = -ankle[..., 2]
    abduction = np.arctan2(aside, below)
    depth = np.hypot(aside, below)
    distance = np.hypot(ahead, depth)
    reached = np.clip(distance, abs(SHIN - THIGH), SHIN + THIGH)
    knee = knee_of_reach(reached, THIGH, SHIN)
    bent_out = np.arctan2(SHIN * np.sin(knee), THIGH + SHIN * np.cos(knee))
    flexion = np.arctan2(ahead, depth) + bent_out
    angles = LegAngles(np.broadcast_to(yaw, knee.shape), abduction, flexion, knee)
    return angles, np.abs(distance - reached)


def leg_ends(angles: LegAngles) -> tuple[Floats, Floats]:
    """Knee and ankle of a leg, each (..., 3) from the hip joint; leg_ik backwards."""
    shin = angles.flexion - angles.knee
    knee_at = _out_of_plane(angles, THIGH * np.sin(angles.flexion), THIGH * np.cos(angles.flexion))
    return knee_at, knee_at + _out_of_plane(angles, SHIN * np.sin(shin), SHIN * np.cos(shin))


def _out_of_plane(angles: LegAngles, ahead: Floats, below: Floats) -> Floats:
    """From the plane of the leg to the frame of the pelvis."""
    aside = below * np.sin(angles.abduction)
    cos, sin = np.cos(angles.yaw), np.sin(angles.yaw)
    return np.stack(
        [cos * ahead - sin * aside, sin * ahead + cos * aside, -below * np.cos(angles.abduction)],
        axis=-1,
    )
