"""Inverse kinematics of a leg in closed form, and its forward kinematics.

The frame is that of the pelvis: forward, left, up. Lengths are shares of the leg's.
"""

from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import SHIN, THIGH
from esplanade.planning.compiled.arrays import Floats


class LegAngles(NamedTuple):
    """Angles of hip and knee, radians, each (...,); the hip turns R_up(yaw) R_forward(abduction).

    A positive abduction leads to the left; flexion and knee are those of Boulic's curves.
    """

    yaw: Floats
    abduction: Floats
    flexion: Floats
    knee: Floats


def knee_of_reach(distance: Floats, upper: float, lower: float) -> Floats:
    """Flexion of the joint between two bones whose ends are a distance apart: law of cosines.

    Distances are (...,), in the unit of the bones; the result is in radians.
    """
    cosine = (upper**2 + lower**2 - distance**2) / (2.0 * upper * lower)
    flexion: Floats = np.pi - np.arccos(np.clip(cosine, -1.0, 1.0))
    return flexion


def leg_ik(ankle: Floats, yaw: Floats) -> tuple[LegAngles, Floats]:
    """Angles that bring an ankle to a point, the knee bending in the plane the foot points along.

    Parameters
    ----------
    ankle : float64 (..., 3), leg lengths
        Place of the ankle, from the hip joint.
    yaw : float64 (...,), radians
        Heading of the foot against the pelvis, counter-clockwise.

    Returns
    -------
    LegAngles (...,), radians
    float64 (...,), leg lengths
        Distance between the point and where the ankle ends up, 0 within reach.

    Notes
    -----
    Chen et al. 2012, eqs. (2) to (4), in the plane of the leg. In the body frame the hip turns
    R_y(yaw) R_z(abduction) R_x(-flexion). A point out of reach is approached along the line to it,
    and nothing is NaN.
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
    """Knee and ankle of a leg, each float64 (..., 3), leg lengths from the hip joint.

    This is the inverse of `leg_ik`.
    """
    shin = angles.flexion - angles.knee
    knee_at = _out_of_plane(angles, THIGH * np.sin(angles.flexion), THIGH * np.cos(angles.flexion))
    return knee_at, knee_at + _out_of_plane(angles, SHIN * np.sin(shin), SHIN * np.cos(shin))


def _out_of_plane(angles: LegAngles, ahead: Floats, below: Floats) -> Floats:
    """A point in the plane of the leg in the frame of the pelvis."""
    aside = below * np.sin(angles.abduction)
    cos, sin = np.cos(angles.yaw), np.sin(angles.yaw)
    return np.stack(
        [cos * ahead - sin * aside, sin * ahead + cos * aside, -below * np.cos(angles.abduction)],
        axis=-1,
    )
