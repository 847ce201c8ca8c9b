"""The skeleton: where joints sit, as shares of the leg length, and where angles put a leg.

The body frame has X to the left, Y up and Z forward, and is right-handed. Its origin is that of
Jing et al. 2015, table 1. Lengths of the upper body are fractions of the stature divided by .491,
which is the leg length as a share of the stature.
"""

from typing import Final, NamedTuple

import numpy as np

from esplanade.planning.compiled.arrays import Floats

THIGH: Final = 0.466
SHIN: Final = 0.534
FOOT: Final = 0.2
"""The foot reaches from the heel, which lies under the ankle joint, to the toe."""

HIP_HALF_WIDTH: Final = 0.178
"""Distance of each hip joint from the middle in table 1 of Jing et al.

There each leg has a plane of its own, far from the other one. Only chains that reach use it.
"""
TRACK_HALF_WIDTH: Final = 0.1
"""Distance of each hip joint and of each footprint from the middle of a body that takes steps.

People walk on a narrower track than table 1 has it.
"""

HIP_DEPTH: Final = 0.178
"""Depth of the line through both hip joints below the origin, where the spine bends."""

CHEST_HEIGHT: Final = 0.20
"""Height of the chest joint above the origin."""
HEAD_TOP: Final = 0.674
"""Height of the top of the head above the origin."""


class Arms(NamedTuple):
    """Lengths of a pair of arms, and where the shoulders are, as shares of the trunk's scale."""

    shoulder_height: float
    """Above the origin, along the chest."""
    shoulder_aside: float
    """Distance of each shoulder from the middle."""
    upper_arm: float
    forearm: float


# Two pairs of arms differ on purpose, and no value of either may change: test vectors hold the web
# client to both.
REACHING_ARMS: Final = Arms(
    shoulder_height=0.409, shoulder_aside=0.264, upper_arm=0.383, forearm=0.310
)
"""Arms of the chains that reach (`reaching/two_stage.py`).

They have the lengths of the gait's source, whose shoulders are broad and high and whose arms are
long. Nothing on a screen has them: a browser that points solves the chain of HANGING_ARMS.
"""
HANGING_ARMS: Final = Arms(
    shoulder_height=0.35, shoulder_aside=0.215, upper_arm=0.345, forearm=0.27
)
"""Arms that hang and swing on a body as it is drawn (`reference/posing.py` and the web client).

They have the lengths of measured people (Drillis and Contini).
"""
ARMS_OUT_RAD: Final = 0.12
"""Angle by which hanging arms stand off the body."""


def leg_points(angles: Floats) -> tuple[Floats, Floats, Floats]:
    """Place knee, ankle (which is the heel) and toe of a leg that swings in the sagittal plane.

    Parameters
    ----------
    angles : float64 (..., 3), radians
        Flexion of the hip, flexion of the knee, dorsiflexion of the ankle.

    Returns
    -------
    three float64 (..., 2), leg lengths
        Knee, ankle and toe, forward (Z) and up (Y) from the hip joint.

    Notes
    -----
    Jing et al. 2015, eqs. (7) and (8): rotations about X by -hip, +knee, -ankle.
    """
    hip, knee, ankle = angles[..., 0], angles[..., 1], angles[..., 2]
    shin = hip - knee
    pitch = shin + ankle
    knee_at = THIGH * np.stack([np.sin(hip), -np.cos(hip)], axis=-1)
    heel_at = knee_at + SHIN * np.stack([np.sin(shin), -np.cos(shin)], axis=-1)
    toe_at = heel_at + FOOT * np.stack([np.cos(pitch), np.sin(pitch)], axis=-1)
    return knee_at, heel_at, toe_at


def foot_pitch(angles: Floats) -> Floats:
    """Pitch of the foot against the ground.

    Parameters
    ----------
    angles : float64 (..., 3), radians
        As in `leg_points`.

    Returns
    -------
    float64 (...,), radians
        Positive with the toe up.
    """
    pitch: Floats = angles[..., 0] - angles[..., 1] + angles[..., 2]
    return pitch
