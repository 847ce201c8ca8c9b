"""The targets of a step for the body: places of hips and feet, turns of trunk and arms."""

from typing import NamedTuple

import numpy as np

from esplanade.planning.compiled.arrays import Floats


class Targets(NamedTuple):
    """Targets for inverse kinematics at K shares of N steps; metres and radians, world axes."""

    root: Floats
    """(N, K, 3): the middle between the hip joints."""
    yaw: Floats
    """(N, K): heading of the pelvis, whose axes forward, left, up are Rz(yaw) Ry(lean) Rx(roll)."""
    lean: Floats
    """(N, K): positive where the pelvis leans forward."""
    roll: Floats
    """(N, K): positive with the left hip higher."""
    swing_ankle: Floats
    """(N, K, 3)."""
    swing_pitch: Floats
    """(N, K): pitch of the swing foot, positive with the toe up."""
    swing_heading: Floats
    """(N, K)."""
    standing_pitch: Floats
    """(N, K): positive where the foot turns about its heel, negative where about its toe."""
    torsion: Floats
    """(N, K): of the chest against the pelvis, counter-clockwise."""
    shoulders: Floats
    """(N, K, 2): flexion left, right."""
    elbows: Floats
    """(N, K, 2): flexion left, right."""
    lift: Floats
    """(N,): toe-off, the share of the step until which the swing foot's toe stays where it was."""
    flight: Floats
    """(N,): share of the step, at its end, in which the standing foot is in the air too."""


def empty_targets(count: int, shares: int) -> Targets:
    """Targets of N = `count` steps at K = `shares` shares whose values are yet to be written."""
    flat = (count, shares)
    return Targets(
        root=np.empty((*flat, 3)),
        yaw=np.empty(flat),
        lean=np.empty(flat),
        roll=np.empty(flat),
        swing_ankle=np.empty((*flat, 3)),
        swing_pitch=np.empty(flat),
        swing_heading=np.empty(flat),
        standing_pitch=np.empty(flat),
        torsion=np.empty(flat),
        shoulders=np.empty((*flat, 2)),
        elbows=np.empty((*flat, 2)),
        lift=np.empty(count),
        flight=np.empty(count),
    )
