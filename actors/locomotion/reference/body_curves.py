"""Curves of Boulic et al. (1990) for pelvis, chest and arms, and the durations of a cycle.

They hold for all phases and velocities. The live step evaluates only what it needs of them, in
`gait/_curve_kernels.py`; tests hold the kernels to what stands here. Angles are in radians.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.gait.curves import checked_velocities, eval_curve, support_share
from esplanade.planning.compiled.arrays import Floats


class Timing(NamedTuple):
    """One walking cycle of two steps: RL in leg lengths, the others in seconds."""

    relative_length: Floats
    cycle_s: Floats
    support_s: Floats
    balance_s: Floats
    double_support_s: Floats


class PelvisMotion(NamedTuple):
    """Offsets in leg lengths (up, left, forward) and angles in radians, in the body frame.

    The yaw is about Y, the roll about Z, and the lean about X, positive forward.
    """

    up: Floats
    left: Floats
    forward: Floats
    yaw: Floats
    roll: Floats
    lean: Floats


class UpperAngles(NamedTuple):
    """Torsion of the chest about Y against the pelvis; flexion of one shoulder and elbow."""

    torsion: Floats
    shoulder: Floats
    elbow: Floats


def timing(rv: ArrayLike) -> Timing:
    """Durations within a cycle: Jing et al. 2015, eqs. (1) to (5).

    Raises
    ------
    ValueError
        A relative velocity is 0 or outside the range of the curves.
    """
    rv = checked_velocities(rv)
    if np.any(rv <= 0.0):
        raise ValueError("rv must be above 0, because a cycle without speed never ends")
    length = 1.346 * np.sqrt(rv)
    cycle = length / rv
    return Timing(
        length, cycle, 0.752 * cycle - 0.143, 0.248 * cycle + 0.143, 0.252 * cycle - 0.143
    )


def pelvis_motion(rv: Floats, phase: Floats) -> PelvisMotion:
    """Motion and turning of the pelvis about its mean, by the phase of the left leg.

    The amplitudes sideways and forward keep one sign throughout; the sources let them flip at
    rv = .5.
    """
    a = np.minimum(rv, 0.5)
    swell = a - a * a
    turn = 2.0 * np.pi
    sway = 0.128 * swell
    surge = 0.084 * swell
    dip = 8.0 * swell
    roll_by = 1.66 * rv
    half = phase % 0.5
    ahead = 0.625 - support_share(rv)
    rolled = -roll_by + roll_by * np.where(
        half < 0.15, np.cos(turn * half / 0.3), -np.cos(turn * (half - 0.15) / 0.7)
    )
    rolled = np.where(phase % 1.0 < 0.5, rolled, -rolled)
    return PelvisMotion(
        up=0.015 * rv * (np.sin(turn * (2.0 * phase - 0.35)) - 1.0),
        left=sway * np.sin(turn * (phase - 0.1)),
        forward=surge * np.sin(turn * 2.0 * (phase + ahead)),
        yaw=np.radians(-4.0 * rv * np.cos(turn * phase)),
        roll=np.radians(-rolled),
        lean=np.radians(dip - dip * np.sin(turn * (2.0 * phase - 0.1))),
    )


def upper_angles(rv: Floats, phase: Floats) -> UpperAngles:
    """Torsion of the chest by the phase of the left leg; an arm by that of the leg on its side."""
    b = np.minimum(np.maximum((rv - 0.5) / 0.8, 0.0), 1.0)
    c = np.minimum(np.maximum((rv - 1.3) / 1.7, 0.0), 1.0)
    a = np.minimum(rv, 0.5)
    at = np.ones_like(rv)
    torsion = [
        (0.1 * at, 4.0 / 3.0 * rv),
        (0.4 * at, -1.5 * rv),
        (0.6 * at, -4.0 / 3.0 * rv),
        (0.9 * at, 1.5 * rv),
    ]
    elbow = [
        (0.05 * at, 3.0 + 6.0 * a + 8.0 * b - 6.0 * c),
        (0.5 + 0.01 * b + 0.04 * c, 3.0 + 34.0 * a + 24.0 * b + 26.0 * c),
        (0.9 - 0.1 * c, 3.0 + 10.0 * a + 9.0 * b - 6.0 * c),
    ]
    shoulder = 3.0 - 4.94 * rv - 9.88 * rv * np.cos(2.0 * np.pi * phase)
    return UpperAngles(
        np.radians(eval_curve(torsion, phase)),
        np.radians(shoulder),
        np.radians(eval_curve(elbow, phase)),
    )
