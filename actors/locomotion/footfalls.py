"""What a step is given by, and what it makes of the body: arrays over N steps."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.skeleton import Floats


class Footfalls(NamedTuple):
    """N steps by their footprints: x, y, z of the heel on the ground (metres), heading (radians).

    World axes, headings from +x counter-clockwise.
    """

    right: NDArray[np.bool_]
    """(N,): the standing foot is the right one."""
    lifted: Floats
    """(N, 4): where the other foot comes from."""
    standing: Floats
    """(N, 4)."""
    landing: Floats
    """(N, 4): where the other foot comes down."""
    leg_m: Floats
    """(N,)."""


class Targets(NamedTuple):
    """Where body and feet are at K shares of N steps; metres and radians, world axes."""

    root: Floats
    """(N, K, 3): the middle between the hip joints."""
    yaw: Floats
    """(N, K): where the pelvis faces; its frame forward, left, up is Rz(yaw) Ry(lean) Rx(roll)."""
    lean: Floats
    """(N, K): forward bow."""
    roll: Floats
    """(N, K): positive with the left hip higher."""
    swing_ankle: Floats
    """(N, K, 3)."""
    swing_pitch: Floats
    """(N, K): toe up positive."""
    swing_heading: Floats
    """(N, K)."""
    standing_pitch: Floats
    """(N, K): turns about the heel with the toe up, about the toe with the heel up (negative)."""
    torsion: Floats
    """(N, K): of the chest against the pelvis, counter-clockwise."""
    shoulders: Floats
    """(N, K, 2): flexion left, right."""
    elbows: Floats
    """(N, K, 2): flexion left, right."""
    lift: Floats
    """(N,): share of the step until which the swinging foot's toe stays on its old footprint."""


def room_for(count: int, shares: int) -> Targets:
    """Targets of so many steps, yet to be filled."""
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
    )
