"""Joint angles of a leg over a cycle of free walking, after Boulic et al. (1990); radians.

A leg's phase runs from 0 at its own heel strike to 1; the right leg is half a cycle behind the
left one. A curve is a few keys per cycle with level tangents. Up to a relative velocity of .5 the
values grow with it (`a` below), between .5 and 1.3 they stay as they are, and beyond that they
change once more (`c` below).
"""

from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from esplanade.planning.compiled.arrays import Floats

RV_MAX: Final = 3.0
"""Largest relative velocity that the curves are given for, leg lengths a second."""
_FADED_BELOW: Final = 0.05


def smooth(share: Floats) -> Floats:
    """The smoothstep 3s² - 2s³ of shares clipped to [0, 1]: it is level at both ends."""
    s = np.minimum(np.maximum(share, 0.0), 1.0)
    result: Floats = s * s * (3.0 - 2.0 * s)
    return result


def support_share(rv: Floats) -> Floats:
    """Duty factor: the share of a cycle during which a foot is on the ground.

    It is Ds/Dc of Jing et al. 2015, eqs. (2) and (3), in a form that also holds for rv = 0.
    """
    share: Floats = 0.752 - 0.143 / 1.346 * np.sqrt(rv)
    return share


def leg_keys(rv: Floats, *, faded: bool = True) -> tuple[list[tuple[Floats, Floats]], ...]:
    """Keys (time in cycles, angle in degrees) of hip, knee and ankle over one cycle.

    Up to rv = .05 the constant 3 and -3 degrees of knee and ankle are faded in, so that a body
    at rv = 0 stands with straight legs; `faded=False` gives the curves as published.
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
    """Value of a periodic curve through keys (time, value) that is level at each of them.

    This is Jing et al. 2015, appendix A, as one sum over all stretches between keys: stretches
    that lie ahead of the phase add nothing.
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
    """Flexion of hip and knee and dorsiflexion of the ankle of a leg.

    Parameters
    ----------
    rv : float64 (N,), in [0, 3]
        Relative velocity, leg lengths a second.
    phase : float64 (N,), cycles
        Phase of the leg: 0 at its own heel strike.

    Returns
    -------
    float64 (N, 3), radians

    Raises
    ------
    ValueError
        A relative velocity is outside [0, 3], or a phase is not a finite number.

    Notes
    -----
    Curves of Boulic et al. 1990; docs/walking.md says where the coefficients come from.
    """
    rv, phase = np.broadcast_arrays(checked_velocities(rv), np.asarray(phase, dtype=np.float64))
    if not np.all(np.isfinite(phase)):
        raise ValueError("every phase must be a finite number")
    return joint_angles(rv, phase)


def joint_angles(rv: Floats, phase: Floats, *, faded: bool = True) -> Floats:
    """Return the same as `leg_angles`, for sound arrays of one shape, whatever it is.

    With `faded=False` the curves are those published, see `leg_keys`.
    """
    return np.radians(
        np.stack([eval_curve(keys, phase) for keys in leg_keys(rv, faded=faded)], axis=-1)
    )


def checked_velocities(rv: ArrayLike) -> Floats:
    """Relative velocities as an array.

    Raises
    ------
    ValueError
        One of them is outside [0, RV_MAX].
    """
    rv = np.asarray(rv, dtype=np.float64)
    if not np.all((rv >= 0.0) & (rv <= RV_MAX)):
        raise ValueError(
            f"relative velocities must lie between 0 and {RV_MAX} leg lengths a second"
        )
    return rv
