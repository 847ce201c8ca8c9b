"""The curves that a planted step needs, one moment at a time, for relative velocities up to .5.

`gait/curves.py` and `reference/body_curves.py` have them for all phases and velocities; here they
are written out for the phases of one step. In every function `u` is the share of the step in
[0, 1], `rv` the relative velocity, and angles are in radians.
"""

from __future__ import annotations

import math

from esplanade.planning.compiled.jit import inlined

_DEGREE = math.pi / 180.0
_TURN = 2.0 * math.pi


@inlined
def smooth(share: float) -> float:
    """The smoothstep 3s² - 2s³ of a share clipped to [0, 1]."""
    s = min(max(share, 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


@inlined
def mix(before: float, after: float, share: float) -> float:
    """Linear interpolation from `before` at share 0 to `after` at share 1."""
    return before + (after - before) * share


@inlined
def support_share(rv: float) -> float:
    """Duty factor: share of a cycle with the foot on the ground; Jing et al., eqs. (2) and (3)."""
    return 0.752 - 0.143 / 1.346 * math.sqrt(rv)


@inlined
def swing_leg(rv: float, u: float) -> tuple[float, float, float]:
    """Flexion of hip, knee and ankle of the swing leg, whose phase is (1 + u)/2."""
    phase = 0.5 + 0.5 * u
    constant = 3.0 * smooth(rv / 0.05)
    ends = support_share(rv)
    bent = 140.0 * rv - constant
    hip = rv * (-30.0 + 80.0 * (smooth((phase - 0.5) / 0.4) - smooth((phase - 0.9) / 0.6)))
    knee = constant + bent * (smooth((phase - 0.4) / 0.35) - smooth((phase - 0.75) / 0.25))
    ankle = 22.0 * rv - constant
    ankle += rv * (
        34.0 * smooth((phase - ends) / (0.85 - ends)) - 56.0 * smooth((phase - 0.5) / (ends - 0.5))
    )
    return hip * _DEGREE, knee * _DEGREE, ankle * _DEGREE


@inlined
def pelvis(rv: float, u: float) -> tuple[float, float, float, float]:
    """Sway to the left (leg lengths), yaw, lean, roll while the left leg stands, at phase u/2."""
    phase = 0.5 * u
    swell = rv - rv * rv
    sway = 0.128 * swell * math.sin(_TURN * (phase - 0.1))
    yaw = -4.0 * rv * math.cos(_TURN * phase)
    lean = 8.0 * swell * (1.0 - math.sin(_TURN * (2.0 * phase - 0.1)))
    if phase < 0.15:
        roll = 1.66 * rv * (1.0 - math.cos(_TURN * phase / 0.3))
    else:
        roll = 1.66 * rv * (1.0 + math.cos(_TURN * (phase - 0.15) / 0.7))
    return sway, yaw * _DEGREE, lean * _DEGREE, roll * _DEGREE


@inlined
def chest_torsion(rv: float, u: float) -> float:
    """Torsion of the chest against the pelvis while the left leg stands."""
    phase = 0.5 * u
    turned = (
        1.5
        - smooth((phase + 0.1) / 0.2) / 6.0
        - 17.0 / 6.0 * smooth((phase - 0.1) / 0.3)
        + smooth((phase - 0.4) / 0.2) / 6.0
    )
    return rv * turned * _DEGREE


@inlined
def arm(rv: float, phase: float) -> tuple[float, float]:
    """Flexion of shoulder and elbow by the phase, in [0, 1], of the leg on the same side."""
    shoulder = 3.0 - 4.94 * rv - 9.88 * rv * math.cos(_TURN * phase)
    elbow = 3.0 + rv * (
        10.0
        - 4.0 * smooth((phase + 0.1) / 0.15)
        + 28.0 * smooth((phase - 0.05) / 0.45)
        - 24.0 * smooth((phase - 0.5) / 0.4)
        - 4.0 * smooth((phase - 0.9) / 0.15)
    )
    return shoulder * _DEGREE, elbow * _DEGREE
