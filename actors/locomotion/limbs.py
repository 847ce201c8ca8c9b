"""Legs and arms that reach a point, in closed form; and the way back, from angles to points.

Frame: forward, left, up of the pelvis (legs) or chest (arms); lengths in shares of the leg's.
"""

from typing import NamedTuple

import numpy as np

from actors.locomotion.skeleton import FOREARM, SHIN, THIGH, UPPER_ARM, Floats

_TINY = 1e-12


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


def arm_ik(hand: Floats, elbow_towards: Floats) -> tuple[Floats, Floats, Floats]:
    """Where the elbow of an arm is whose hand reaches a point.

    Parameters
    ----------
    hand, elbow_towards : float64 (..., 3), leg lengths
        From the shoulder; a direction to which the elbow bends out (down, a little outward).

    Returns
    -------
    float64 (..., 3), (...,), (...,): elbow and its flexion (radians), how much the hand misses
    """
    distance = np.linalg.norm(hand, axis=-1)
    along = hand / np.maximum(distance, _TINY)[..., None]
    along = np.where((distance > _TINY)[..., None], along, (1.0, 0.0, 0.0))
    reached = np.clip(distance, abs(UPPER_ARM - FOREARM), UPPER_ARM + FOREARM)
    flexion = knee_of_reach(reached, UPPER_ARM, FOREARM)
    towards = _perpendicular(elbow_towards, along)
    share = np.arctan2(FOREARM * np.sin(flexion), UPPER_ARM + FOREARM * np.cos(flexion))
    elbow = UPPER_ARM * (np.cos(share)[..., None] * along + np.sin(share)[..., None] * towards)
    return elbow, flexion, np.abs(distance - reached)


def _perpendicular(direction: Floats, along: Floats) -> Floats:
    """The part of a direction across a unit vector, made unit; any such where there is none."""
    across = direction - np.sum(direction * along, axis=-1, keepdims=True) * along
    flat = np.abs(along[..., 2:]) < 0.9
    spare = np.where(flat, (0.0, 0.0, -1.0), (-1.0, 0.0, 0.0))
    spare = spare - np.sum(spare * along, axis=-1, keepdims=True) * along
    length = np.linalg.norm(across, axis=-1, keepdims=True)
    across = np.where(length > 1e-9, across, spare)
    unit: Floats = across / np.linalg.norm(across, axis=-1, keepdims=True)
    return unit
