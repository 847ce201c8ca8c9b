"""The body in shares of its leg length: where joints sit, and where angles put them.

Body frame: X left, Y up, Z forward, right-handed; the origin is that of Jing et al., Table 1.
Upper body: fractions of stature, divided by .491 (leg length as a share of stature).
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

THIGH = 0.466
SHIN = 0.534
FOOT = 0.2
"""From the heel, which lies under the ankle joint, to the toe."""

HIP_HALF_WIDTH = 0.178
TRACK_HALF_WIDTH = 0.1
"""Hip joints and footprints of a body that takes real steps, to either side.

Table 1 (above) has legs in planes of their own, wide apart; people walk on a narrower track.
"""

HIP_DEPTH = 0.178
"""How far the line through both hip joints lies below the origin."""

CHEST_HEIGHT = 0.20
NECK_HEIGHT = 0.409
HEAD_TOP = 0.674
SHOULDER_HALF_WIDTH = 0.264
UPPER_ARM = 0.383
FOREARM = 0.310


def leg_points(angles: Floats) -> tuple[Floats, Floats, Floats]:
    """Place knee, ankle (= heel) and toe of a leg that swings in the sagittal plane.

    Parameters
    ----------
    angles : float64 (..., 3), radians
        Hip flexion, knee flexion, dorsiflexion of the ankle.

    Returns
    -------
    three float64 (..., 2), leg lengths, from the hip joint: forward Z, up Y

    Notes
    -----
    Jing et al., eqs. (7) and (8): rotations about X of -hip, +knee, -ankle.
    """
    hip, knee, ankle = angles[..., 0], angles[..., 1], angles[..., 2]
    shin = hip - knee
    pitch = shin + ankle
    knee_at = THIGH * np.stack([np.sin(hip), -np.cos(hip)], axis=-1)
    heel_at = knee_at + SHIN * np.stack([np.sin(shin), -np.cos(shin)], axis=-1)
    toe_at = heel_at + FOOT * np.stack([np.cos(pitch), np.sin(pitch)], axis=-1)
    return knee_at, heel_at, toe_at


def foot_pitch(angles: Floats) -> Floats:
    """Pitch of the foot against the ground, radians, toe-up positive; angles as in leg_points."""
    pitch: Floats = angles[..., 0] - angles[..., 1] + angles[..., 2]
    return pitch


def ankle_over_toe(footprint: Floats, pitch: Floats) -> Floats:
    """Ankle (..., 3) of a foot that is pitched about its toe, which keeps to the footprint.

    footprint : float64 (..., 4), leg lengths: heel x, y, z on the ground (z up), heading (radians)
    """
    heading = footprint[..., 3]
    drawn = FOOT * (1.0 - np.cos(pitch))
    return np.stack(
        [
            footprint[..., 0] + drawn * np.cos(heading),
            footprint[..., 1] + drawn * np.sin(heading),
            footprint[..., 2] - FOOT * np.sin(pitch),
        ],
        axis=-1,
    )
