"""A step under way is made of six key poses of a body, and curves through them."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.motion import _key_pose_kernels as kernels
from esplanade.actors.locomotion.planted.footprints import HEADING, PLACE
from esplanade.planning.compiled.arrays import Bools, Floats, Ints

KEYS: Final = kernels.KEYS
"""Keys of a step, evenly spread over it: at 0, 1/5, ... 1."""
WIDTH: Final = kernels.WIDTH
"""Numbers of a key; the columns below name them."""
SETTLE: Final = kernels.SETTLE
"""Share of a step in which a foot that has left the ground comes over to its curve."""

# Columns of a key.
ROOT: Final = slice(0, 3)
"""Hip centre from the standing footprint, metres, world axes."""
ROOT_ON_MAP: Final = slice(0, 2)
"""The same without its height."""
PELVIS: Final = slice(kernels.PELVIS, kernels.PELVIS + 4)
"""Quaternion w, x, y, z, from the frame forward, left, up of a body that faces +x."""
ANKLE: Final = slice(kernels.ANKLE, kernels.ANKLE + 3)
"""Ankle of the swing foot from the landing footprint, metres, world axes."""
SWING_PITCH: Final = kernels.SWING_PITCH
"""Pitch of the swing foot, radians, toe up positive."""
STANDING_PITCH: Final = kernels.STANDING_PITCH
"""Pitch of the standing foot, radians, toe up positive."""
SWING_HEADING: Final = kernels.SWING_HEADING
"""Heading of the swing foot from that of the landing footprint, radians."""
CHEST: Final = slice(kernels.CHEST, kernels.CHEST + 4)
"""Quaternion of the chest relative to the pelvis."""
SHOULDERS: Final = slice(kernels.ARMS, kernels.ARMS + 2)
"""Flexion left, right, radians, arm forward positive."""
ELBOWS: Final = slice(kernels.ARMS + 2, kernels.ARMS + 4)
"""Flexion left, right, radians."""
ARMS: Final = slice(kernels.ARMS, kernels.ARMS + 4)
"""Shoulders and elbows together."""


class Steps(NamedTuple):
    """N steps, row by row. Places are metres in world axes, headings radians from +x.

    The columns of a footprint are in `planted/footprints.py`.
    """

    on_right: Bools
    """(N,): whether the standing foot is the right one."""
    re_aimed: Bools
    """(N,): whether it takes the place of the rest of a step that was under way."""
    start: Ints
    """(N,): tick at which it begins."""
    ticks: Ints
    """(N,): how many ticks it takes; 0 for a body that just stands in the pose of the last key."""
    standing: Floats
    """(N, 4): footprint of the standing foot."""
    landing: Floats
    """(N, 4): footprint on which the swing foot lands."""
    lift: Floats
    """(N,): toe-off, the share of the step until which the swing foot's toe stays where key 0 has
    it."""
    flight: Floats
    """(N,): share of the step, at its end, in which the standing foot is in the air too."""
    keys: Floats
    """(N, KEYS, WIDTH): at even shares, the first at 0 and the last at 1."""

    def share(self, tick: int | float) -> Floats:
        """Shares of the steps that have elapsed at a tick, (N,) in [0, 1]; 1 after their ends."""
        elapsed = np.clip((tick - self.start) / np.maximum(self.ticks, 1), 0.0, 1.0)
        return np.where(self.ticks > 0, elapsed, 1.0)

    def take(self, rows: Ints | Bools) -> Steps:
        """Some of the steps."""
        return Steps._make(column[rows] for column in self)

    def put(self, rows: Ints | Bools, steps: Steps) -> None:
        """Write other steps over some of these."""
        for column, new in zip(self, steps, strict=True):
            column[rows] = new


def no_steps(count: int) -> Steps:
    """N = `count` steps whose values are all zero."""
    return Steps(
        np.zeros(count, dtype=np.bool_),
        np.zeros(count, dtype=np.bool_),
        np.zeros(count, dtype=np.int64),
        np.zeros(count, dtype=np.int64),
        np.zeros((count, 4)),
        np.zeros((count, 4)),
        np.zeros(count),
        np.zeros(count),
        np.zeros((count, KEYS, WIDTH)),
    )


def interpolate(keys: Floats, u: Floats) -> Floats:
    """Poses between keys.

    Parameters
    ----------
    keys : float64 (N, KEYS, WIDTH)
        Quaternions of neighbouring keys must have the same sign.
    u : float64 (N,), shares of the step, in [0, 1]

    Returns
    -------
    float64 (N, WIDTH)

    Notes
    -----
    All numbers go along cubic curves through the keys with the tangents of Catmull and Rom, at the
    ends with those of the parabola through three keys. Quaternions do so component by component
    and are normalised: keys of one step are some degrees apart, where that is as good as slerp.
    The swing foot comes to rest at the end, so there its curves are level.
    """
    out = np.empty((len(u), WIDTH))
    kernels.fill_interpolated(keys, u, out)
    return out


def heel_from_toe(pitch: Floats, heading: Floats, foot_m: Floats) -> Floats:
    """Vectors from the toe to the ankle of N feet.

    Parameters
    ----------
    pitch, heading : float64 (N,), radians
    foot_m : float64 (N,), metres

    Returns
    -------
    float64 (N, 3), metres, world axes
    """
    level = foot_m * np.cos(pitch)
    return np.stack(
        [-level * np.cos(heading), -level * np.sin(heading), -foot_m * np.sin(pitch)], axis=1
    )


def standing_ankles(footprints: Floats, pitch: Floats, foot_m: Floats) -> Floats:
    """Ankles of standing feet: on the heel while the toe is up, else over the toe.

    Parameters
    ----------
    footprints : float64 (N, 4), metres and radians
    pitch : float64 (N,), radians
    foot_m : float64 (N,), metres

    Returns
    -------
    float64 (N, 3), metres
    """
    level = np.zeros_like(pitch)
    heading = footprints[:, HEADING]
    down = np.minimum(pitch, 0.0)
    moved = heel_from_toe(down, heading, foot_m) - heel_from_toe(level, heading, foot_m)
    return np.asarray(footprints[:, PLACE] + moved)


def sample_keys(steps: Steps, u: Floats, foot_m: Floats) -> Floats:
    """Poses drawn of N steps at shares of them, as keys.

    Parameters
    ----------
    steps : N steps
    u : float64 (N,), shares, in [0, 1]
    foot_m : float64 (N,), metres

    Returns
    -------
    float64 (N, WIDTH)

    Notes
    -----
    This is `interpolate` but for the ankle of the swing foot. Until toe-off the foot turns about
    its toe, which stays where key 0 has it; after that the difference to its curve fades.
    """
    out = np.empty((len(u), WIDTH))
    kernels.fill_samples(steps.keys, steps.landing, steps.lift, u, foot_m, out)
    return out
