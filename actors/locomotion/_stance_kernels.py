"""How the legs of bodies in a step stand: one after the other."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion._gait_kernels import smooth
from esplanade.actors.locomotion._motion_kernels import (
    ANKLE,
    PELVIS,
    SETTLE,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
)
from esplanade.actors.locomotion.skeleton import FOOT, TRACK_HALF_WIDTH, Floats
from esplanade.planning.compiled.jit import inlined, kernel

REACH = 0.9995
STEEPEST_RAD = -1.3
"""A heel is raised no further on its toe."""
EASE_RAD = 0.1
"""A foot on the ground with its heel up by as much rises on its toe where the leg is short."""


@inlined
def _ankle_from_toe(ankle: Floats, toe: Floats, pitch: float, heading: float, foot: float) -> None:
    level = foot * math.cos(pitch)
    ankle[0] = toe[0] - level * math.cos(heading)
    ankle[1] = toe[1] - level * math.sin(heading)
    ankle[2] = toe[2] - foot * math.sin(pitch)


@inlined
def _toe_of(toe: Floats, ankle: Floats, pitch: float, heading: float, foot: float) -> None:
    level = foot * math.cos(pitch)
    toe[0] = ankle[0] + level * math.cos(heading)
    toe[1] = ankle[1] + level * math.sin(heading)
    toe[2] = ankle[2] + foot * math.sin(pitch)


@inlined
def _raised(
    hip: Floats, toe: Floats, pitch: float, heading: float, foot: float, reach: float
) -> float:
    """Pitch at which a foot on its toe brings the ankle as near as the leg reaches."""
    along = (hip[0] - toe[0]) * math.cos(heading) + (hip[1] - toe[1]) * math.sin(heading)
    up = hip[2] - toe[2]
    square = (hip[0] - toe[0]) ** 2 + (hip[1] - toe[1]) ** 2 + up * up
    # The heel is at -foot (cos p, sin p): as far from the hip as the leg reaches.
    cosine = (reach * reach - square - foot * foot) / (2.0 * foot * math.hypot(along, up))
    steeper = math.atan2(up, along) - math.acos(min(max(cosine, -1.0), 1.0))
    return min(max(steeper, STEEPEST_RAD), pitch)


@inlined
def _apart(a: Floats, b: Floats) -> float:
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@kernel
def fill_stances(
    right: NDArray[np.bool_],
    standing: Floats,
    landing: Floats,
    lift: Floats,
    u: Floats,
    key: Floats,
    leg_m: Floats,
    root: Floats,
    hips: Floats,
    ankles: Floats,
    pitches: Floats,
    headings: Floats,
) -> None:
    """Legs of N steps at shares u (N,), drawn with key (N, WIDTH) -> the last five, as `Legs`."""
    toe = np.empty(3)
    for i in range(len(u)):
        leg = leg_m[i]
        foot, reach = FOOT * leg, REACH * leg
        stands = 1 if right[i] else 0
        swings = 1 - stands
        w, x, y, z = key[i, PELVIS], key[i, PELVIS + 1], key[i, PELVIS + 2], key[i, PELVIS + 3]
        left = (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x))
        for d in range(3):
            root[i, d] = standing[i, d] + key[i, d]
            hips[i, 0, d] = root[i, d] + TRACK_HALF_WIDTH * leg * left[d]
            hips[i, 1, d] = root[i, d] - TRACK_HALF_WIDTH * leg * left[d]
            ankles[i, swings, d] = landing[i, d] + key[i, ANKLE + d]
        pitch = key[i, STANDING_PITCH]
        pitches[i, stands], headings[i, stands] = pitch, standing[i, 3]
        pitches[i, swings] = key[i, SWING_PITCH]
        headings[i, swings] = landing[i, 3] + key[i, SWING_HEADING]
        # On its heel while the toe is up, else on its toe.
        _toe_of(toe, standing[i], 0.0, standing[i, 3], foot)
        _ankle_from_toe(ankles[i, stands], toe, min(pitch, 0.0), standing[i, 3], foot)
        for side in range(2):
            on_toe = smooth(-pitches[i, side] / EASE_RAD)
            if side == swings:
                on_toe *= 1.0 - smooth((u[i] - lift[i]) / SETTLE) if lift[i] > 0.0 else 0.0
            if on_toe <= 0.0 or _apart(hips[i, side], ankles[i, side]) <= reach:
                continue
            pitch, heading = pitches[i, side], headings[i, side]
            _toe_of(toe, ankles[i, side], pitch, heading, foot)
            raised = _raised(hips[i, side], toe, pitch, heading, foot, reach)
            pitches[i, side] = pitch + on_toe * (raised - pitch)
            _ankle_from_toe(ankles[i, side], toe, pitches[i, side], heading, foot)
        drop = 0.0
        for side in range(2):
            level2 = (hips[i, side, 0] - ankles[i, side, 0]) ** 2
            level2 += (hips[i, side, 1] - ankles[i, side, 1]) ** 2
            high = math.sqrt(reach * reach - min(level2, reach * reach))
            drop = max(drop, hips[i, side, 2] - ankles[i, side, 2] - high)
        root[i, 2] -= drop
        hips[i, 0, 2] -= drop
        hips[i, 1, 2] -= drop
