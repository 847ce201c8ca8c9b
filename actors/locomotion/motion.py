"""What a step under way is made of: six keys of a body, and curves through them."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion import _motion_kernels as kernels

Floats = NDArray[np.float64]

KEYS: Final = kernels.KEYS
"""Keys of a step, evenly spread over it: at 0, 1/5, ... 1."""
WIDTH: Final = kernels.WIDTH
"""Numbers of a key."""
SETTLE: Final = kernels.SETTLE
"""Share of a step in which a foot that has left the ground comes over to its curve."""

# Columns of a key.
ROOT: Final = slice(0, 3)
"""Hip centre from the standing footprint, metres, world axes."""
PELVIS: Final = slice(kernels.PELVIS, kernels.PELVIS + 4)
"""Quaternion w, x, y, z, from the frame forward, left, up of a body that faces +x."""
ANKLE: Final = slice(kernels.ANKLE, kernels.ANKLE + 3)
"""Ankle of the swinging foot from the landing footprint, metres, world axes."""
SWING_PITCH: Final = kernels.SWING_PITCH
"""Radians, toe up positive."""
STANDING_PITCH: Final = kernels.STANDING_PITCH
SWING_HEADING: Final = kernels.SWING_HEADING
"""Of the swinging foot, from the landing footprint's heading, radians."""
CHEST: Final = slice(kernels.CHEST, kernels.CHEST + 4)
"""Quaternion relative to the pelvis."""
SHOULDERS: Final = slice(17, 19)
"""Flexion left, right, radians, arm forward positive."""
ELBOWS: Final = slice(19, 21)
ARMS: Final = slice(17, 21)
"""Shoulders and elbows together."""


class Steps(NamedTuple):
    """N steps, row by row. Places are metres in world axes, headings radians from +x.

    A footprint is x, y, z of the heel on the ground, and where the toe points.
    """

    right: NDArray[np.bool_]
    """(N,): the standing foot is the right one."""
    again: NDArray[np.bool_]
    """(N,): goes on from a step that was under way."""
    start: NDArray[np.int64]
    """(N,): tick at which it begins."""
    ticks: NDArray[np.int64]
    """(N,): how many ticks it takes; 0 for who just stands in the pose of the last key."""
    standing: Floats
    """(N, 4): footprint of the standing foot."""
    landing: Floats
    """(N, 4): footprint where the other foot lands."""
    lift: Floats
    """(N,): share of the step until which the other foot's toe stays where key 0 has it."""
    keys: Floats
    """(N, KEYS, WIDTH): at even shares, the first at 0 and the last at 1."""

    def share(self, tick: int | float) -> Floats:
        """How far each is at a time in ticks, (N,) in [0, 1]; 1 after its end."""
        gone = np.clip((tick - self.start) / np.maximum(self.ticks, 1), 0.0, 1.0)
        return np.where(self.ticks > 0, gone, 1.0)

    def take(self, rows: NDArray[np.int64] | NDArray[np.bool_]) -> Steps:
        """Some of the steps."""
        return Steps._make(column[rows] for column in self)

    def heads(self, rows: NDArray[np.int64]) -> Steps:
        """Some of the steps without their keys, which are most of what they weigh."""
        return Steps._make((*(column[rows] for column in self[:-1]), self.keys[:0]))

    def put(self, rows: NDArray[np.int64] | NDArray[np.bool_], steps: Steps) -> None:
        """Write other steps over some of these."""
        for column, new in zip(self, steps, strict=True):
            column[rows] = new


def no_steps(count: int) -> Steps:
    """Room for so many steps, all zero."""
    return Steps(
        np.zeros(count, dtype=np.bool_),
        np.zeros(count, dtype=np.bool_),
        np.zeros(count, dtype=np.int64),
        np.zeros(count, dtype=np.int64),
        np.zeros((count, 4)),
        np.zeros((count, 4)),
        np.zeros(count),
        np.zeros((count, KEYS, WIDTH)),
    )


def smooth(share: Floats) -> Floats:
    """From 0 to 1 with level ends: 3 s^2 - 2 s^3, of what is cut to [0, 1]."""
    s = np.clip(share, 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))


def between(keys: Floats, u: Floats) -> Floats:
    """Keys (N, KEYS, WIDTH) at shares u (N,): (N, WIDTH).

    All numbers go along cubic curves through the keys with the tangents of Catmull and Rom, at
    the ends those of the parabola through three keys. Quaternions do so component by component and
    are made unit again: keys of one step are some degrees apart, where that is as good as going
    along great circles. Neighbours among the keys must have the same sign (`align`). What moves
    the swinging foot comes to rest at the end: there its curves are level.
    """
    out = np.empty((len(u), WIDTH))
    kernels.fill_between(keys, u, out)
    return out


def align(keys: Floats) -> None:
    """Give each quaternion the sign that is nearest to the key before; in place."""
    for part in (PELVIS, CHEST):
        for k in range(1, KEYS):
            dots = np.einsum("nd,nd->n", keys[:, k, part], keys[:, k - 1, part])
            keys[dots < 0.0, k, part] *= -1.0


def heel_from_toe(pitch: Floats, heading: Floats, foot_m: Floats) -> Floats:
    """Ankle from toe of feet that are pitched and headed so, (N,) each: (N, 3) metres."""
    level = foot_m * np.cos(pitch)
    return np.stack(
        [-level * np.cos(heading), -level * np.sin(heading), -foot_m * np.sin(pitch)], axis=1
    )


def standing_ankles(footprints: Floats, pitch: Floats, foot_m: Floats) -> Floats:
    """Ankles over footprints (N, 4), (N, 3): on the heel when the toe is up, else over the toe."""
    level = np.zeros_like(pitch)
    heading = footprints[:, 3]
    down = np.minimum(pitch, 0.0)
    moved = heel_from_toe(down, heading, foot_m) - heel_from_toe(level, heading, foot_m)
    return np.asarray(footprints[:, :3] + moved)


def under_way(steps: Steps, u: Floats, foot_m: Floats) -> Floats:
    """What is drawn of steps at shares u (N,): keys (N, WIDTH), the swinging ankle as it is.

    Until it lifts, the swinging foot turns on its toe, which stays where key 0 has it; then what
    is missing to its curve fades.
    """
    out = np.empty((len(u), WIDTH))
    kernels.fill_under_way(steps.keys, steps.landing, steps.lift, u, foot_m, out)
    return out
