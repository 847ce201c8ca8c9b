"""Joint angles of free walking over a cycle, after Boulic et al. (1990); angles in radians.

A leg's phase runs from 0 at its own heel strike to 1; the right leg is half a cycle behind the
left. A curve is a few keys per cycle with level tangents. Up to a relative velocity of .5 values
grow with it (a), between .5 and 1.3 legs stay as they are, beyond they change once more (c).
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.skeleton import Floats

RV_MAX = 3.0
_FADED_BELOW = 0.05


class Timing(NamedTuple):
    """One walking cycle of two steps: RL in leg lengths, the rest in seconds."""

    relative_length: Floats
    cycle_s: Floats
    support_s: Floats
    balance_s: Floats
    double_support_s: Floats


class PelvisMotion(NamedTuple):
    """Offsets in leg lengths (up, left, forward) and angles in radians.

    yaw about Y, roll about Z, lean about X (forward positive), in the body frame.
    """

    up: Floats
    left: Floats
    forward: Floats
    yaw: Floats
    roll: Floats
    lean: Floats


class UpperAngles(NamedTuple):
    """Chest torsion about Y against the pelvis; shoulder and elbow flexion of one side."""

    torsion: Floats
    shoulder: Floats
    elbow: Floats


def smooth(share: Floats) -> Floats:
    """3s² - 2s³ of s kept within [0, 1]: from 0 to 1, level at both ends."""
    s = np.minimum(np.maximum(share, 0.0), 1.0)
    result: Floats = s * s * (3.0 - 2.0 * s)
    return result


def timing(rv: ArrayLike) -> Timing:
    """Jing et al., eqs. (1) to (5), for relative velocities above 0."""
    rv = _checked(rv)
    if np.any(rv <= 0.0):
        raise ValueError("rv must be above 0: a cycle without speed never ends")
    length = 1.346 * np.sqrt(rv)
    cycle = length / rv
    return Timing(
        length, cycle, 0.752 * cycle - 0.143, 0.248 * cycle + 0.143, 0.252 * cycle - 0.143
    )


def support_share(rv: Floats) -> Floats:
    """Share of a cycle that a foot is on the ground, Ds/Dc of eqs. (2) and (3); fit for rv = 0."""
    share: Floats = 0.752 - 0.143 / 1.346 * np.sqrt(rv)
    return share


def leg_keys(rv: Floats, *, faded: bool = True) -> tuple[list[tuple[Floats, Floats]], ...]:
    """Keys (time, degrees) of hip, knee and ankle over one cycle.

    Up to rv = .05 the constant 3 and -3 degrees of knee and ankle are faded in, so that a body
    at rv = 0 stands neutral; `faded=False` gives the curves as published.
    """
    a = np.minimum(rv, 0.5)
    c = np.minimum(np.maximum((rv - 1.3) / 1.7, 0.0), 1.0)
    three = 3.0 * smooth(rv / _FADED_BELOW) if faded else np.full_like(rv, 3.0)
    at = np.ones_like(rv)
    hip = [
        (-0.1 + 0.2 * c, 50.0 * a + 5.0 * c),
        (0.5 * at, -30.0 * a),
        (0.9 * at, 50.0 * a + 6.0 * c),
    ]
    knee = [
        (0.17 - 0.05 * c, three + 22.0 * c),
        (0.4 * at, three),
        (0.75 - 0.05 * c, 140.0 * a - 5.0 * c),
        (1.0 - 0.03 * c, three + 3.0 * c),
    ]
    ankle = [
        (0.0 * at, 5.0 * c - three),
        (0.08 * at, -30.0 * a - three + 4.0 * c),
        (0.5 - 0.1 * c, 22.0 * a - three - 3.0 * c),
        (support_share(rv), -34.0 * a - three - 8.0 * c),
        (0.85 * at, 5.0 * c - three),
    ]
    return hip, knee, ankle


def eval_curve(keys: list[tuple[Floats, Floats]], phase: Floats) -> Floats:
    """Value of a periodic curve through keys (time, value), level at each of them.

    Jing et al., appendix A, as one sum over all stretches, of which those ahead add nothing.
    """
    first, value = keys[0]
    since = (phase - first) % 1.0
    closed = [*keys, (first + 1.0, value)]
    total = value
    for (start, low), (end, high) in pairwise(closed):
        stretch = np.maximum(end - start, 1e-12)  # the hip's last and first key may coincide
        total = total + (high - low) * smooth((since - (start - first)) / stretch)
    return total


def leg_angles(rv: ArrayLike, phase: ArrayLike) -> Floats:
    """Hip flexion, knee flexion and dorsiflexion of a leg.

    Parameters
    ----------
    rv : float64 (N,), in [0, 3]
        Relative velocity: leg lengths a second.
    phase : float64 (N,), cycles
        0 at the leg's own heel strike.

    Returns
    -------
    float64 (N, 3), radians

    Raises
    ------
    ValueError
        A relative velocity outside [0, 3], or something that is not a finite number.
    """
    rv, phase = np.broadcast_arrays(_checked(rv), np.asarray(phase, dtype=np.float64))
    if not np.all(np.isfinite(phase)):
        raise ValueError("phase holds something that is not a finite number")
    return joint_angles(rv, phase)


def joint_angles(rv: Floats, phase: Floats, *, faded: bool = True) -> Floats:
    """As leg_angles, of arrays that are known to be sound and of one shape."""
    return np.radians(
        np.stack([eval_curve(keys, phase) for keys in leg_keys(rv, faded=faded)], axis=-1)
    )


def pelvis_motion(rv: Floats, phase: Floats) -> PelvisMotion:
    """How the pelvis moves and turns about its mean, by the left leg's phase.

    Sideways and forward amplitudes keep one sign throughout: sources let them flip at rv = .5.
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
    """Chest torsion by the left leg's phase; shoulder and elbow by the leg on their side."""
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


def _checked(rv: ArrayLike) -> Floats:
    rv = np.asarray(rv, dtype=np.float64)
    if not np.all((rv >= 0.0) & (rv <= RV_MAX)):
        raise ValueError(f"relative velocities must lie in [0, {RV_MAX}]")
    return rv
