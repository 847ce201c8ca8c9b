"""The legs of bodies in a step, one body after the other."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait._curve_kernels import smooth
from esplanade.actors.locomotion.motion._key_pose_kernels import (
    ANKLE,
    KEYS,
    PELVIS,
    SETTLE,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
)
from esplanade.actors.locomotion.planted._flight_kernels import flown, towed
from esplanade.actors.locomotion.planted.footprints import HEADING
from esplanade.planning.compiled.arrays import Bools, Floats
from esplanade.planning.compiled.jit import inlined, kernel

REACH = 0.9995
KEY_REACH = 0.9991
"""Legs are stretched to this share at the ends of steps, as they are sent: numbers that are rounded
to a tenth of a millimetre leave them within REACH still."""
STEEPEST_RAD = -1.3
"""A heel is raised about its toe no further than to this pitch."""
EASE_RAD = 0.1
"""A foot on the ground whose heel is up by this angle may raise it more where the leg is short."""


class Placement(NamedTuple):
    """All that decides, besides a pose, the places of the feet of N steps; fields as in `Steps`."""

    on_right: Bools
    standing: Floats
    landing: Floats
    lift: Floats
    flight: Floats
    keys: Floats
    leg_m: Floats
    """(N,): length of the leg."""


class LegPoses(NamedTuple):
    """Legs of N bodies in the world but for the knees; pairs are left, right."""

    root: Floats
    """(N, 3), metres: hip centre."""
    hips: Floats
    """(N, 2, 3), metres: hip joints."""
    ankles: Floats
    """(N, 2, 3), metres."""
    pitches: Floats
    """(N, 2): of the feet, radians, toe up positive."""
    headings: Floats
    """(N, 2): of the feet, radians from +x."""


@inlined
def _set_ankle_from_toe(
    ankle: Floats, toe: Floats, pitch: float, heading: float, foot: float
) -> None:
    level = foot * math.cos(pitch)
    ankle[0] = toe[0] - level * math.cos(heading)
    ankle[1] = toe[1] - level * math.sin(heading)
    ankle[2] = toe[2] - foot * math.sin(pitch)


@inlined
def _set_toe_from_ankle(
    toe: Floats, ankle: Floats, pitch: float, heading: float, foot: float
) -> None:
    level = foot * math.cos(pitch)
    toe[0] = ankle[0] + level * math.cos(heading)
    toe[1] = ankle[1] + level * math.sin(heading)
    toe[2] = ankle[2] + foot * math.sin(pitch)


@inlined
def _reaching_pitch(
    hip: Floats, toe: Floats, pitch: float, heading: float, foot: float, reach: float
) -> float:
    """Pitch at which a foot on its toe brings the ankle as near to the hip as the leg reaches."""
    along = (hip[0] - toe[0]) * math.cos(heading) + (hip[1] - toe[1]) * math.sin(heading)
    up = hip[2] - toe[2]
    square = (hip[0] - toe[0]) ** 2 + (hip[1] - toe[1]) ** 2 + up * up
    # The heel is at -foot (cos p, sin p): as far from the hip as the leg reaches.
    cosine = (reach * reach - square - foot * foot) / (2.0 * foot * math.hypot(along, up))
    steeper = math.atan2(up, along) - math.acos(min(max(cosine, -1.0), 1.0))
    return min(max(steeper, STEEPEST_RAD), pitch)


@inlined
def _distance(a: Floats, b: Floats) -> float:
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@kernel
def new_leg_poses(count: int) -> LegPoses:
    """Legs of N = `count` bodies that are yet to be written."""
    return LegPoses(
        np.empty((count, 3)),
        np.empty((count, 2, 3)),
        np.empty((count, 2, 3)),
        np.empty((count, 2)),
        np.empty((count, 2)),
    )


@kernel
def fill_leg_poses(
    given: Placement, u: Floats, key: Floats, reach_share: float, out: LegPoses
) -> None:
    """Write the legs of N steps at shares u (N,), where `sample_keys` has given key (N, WIDTH).

    Legs are stretched to that share of their length at most.
    """
    root, hips, ankles, pitches, headings = out
    standing, landing, lift = given.standing, given.landing, given.lift
    first, last = given.keys[:, 0], given.keys[:, KEYS - 1]
    toe = np.empty(3)
    for i in range(len(u)):
        leg = given.leg_m[i]
        foot, reach = FOOT * leg, reach_share * leg
        stands = 1 if given.on_right[i] else 0
        swings = 1 - stands
        w, x, y, z = key[i, PELVIS], key[i, PELVIS + 1], key[i, PELVIS + 2], key[i, PELVIS + 3]
        left = (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x))
        for d in range(3):
            root[i, d] = standing[i, d] + key[i, d]
            hips[i, 0, d] = root[i, d] + TRACK_HALF_WIDTH * leg * left[d]
            hips[i, 1, d] = root[i, d] - TRACK_HALF_WIDTH * leg * left[d]
            ankles[i, swings, d] = landing[i, d] + key[i, ANKLE + d]
        pitch = key[i, STANDING_PITCH]
        pitches[i, stands], headings[i, stands] = pitch, standing[i, HEADING]
        pitches[i, swings] = key[i, SWING_PITCH]
        headings[i, swings] = landing[i, HEADING] + key[i, SWING_HEADING]
        # The standing foot is on its heel while the toe is up, else on its toe.
        _set_toe_from_ankle(toe, standing[i], 0.0, standing[i, HEADING], foot)
        over = flown(u[i], given.flight[i])
        if over > 0.0:
            way = towed(last[i, 0] - first[i, 0], last[i, 1] - first[i, 1], given.flight[i])
            for d in range(3):
                toe[d] += over * over * way[d]
        _set_ankle_from_toe(ankles[i, stands], toe, min(pitch, 0.0), standing[i, HEADING], foot)
        for side in range(2):
            on_toe = smooth(-pitches[i, side] / EASE_RAD)
            if side == swings:
                on_toe *= 1.0 - smooth((u[i] - lift[i]) / SETTLE) if lift[i] > 0.0 else 0.0
            if on_toe <= 0.0 or _distance(hips[i, side], ankles[i, side]) <= reach:
                continue
            pitch, heading = pitches[i, side], headings[i, side]
            _set_toe_from_ankle(toe, ankles[i, side], pitch, heading, foot)
            raised = _reaching_pitch(hips[i, side], toe, pitch, heading, foot, reach)
            pitches[i, side] = pitch + on_toe * (raised - pitch)
            _set_ankle_from_toe(ankles[i, side], toe, pitches[i, side], heading, foot)
        drop = 0.0
        for side in range(2):
            level2 = (hips[i, side, 0] - ankles[i, side, 0]) ** 2
            level2 += (hips[i, side, 1] - ankles[i, side, 1]) ** 2
            high = math.sqrt(reach * reach - min(level2, reach * reach))
            drop = max(drop, hips[i, side, 2] - ankles[i, side, 2] - high)
        root[i, 2] -= drop
        hips[i, 0, 2] -= drop
        hips[i, 1, 2] -= drop


@kernel
def let_legs_reach(given: Placement, keys: Floats) -> None:
    """Bring the last of keys (N, KEYS, WIDTH) to the pose that is drawn of it; in place.

    Heels are raised, and hips come down, until both legs reach their feet. At the end of a step its
    record then says the pose that is drawn, and the next step begins with the same numbers.
    """
    count, last = len(keys), keys.shape[1] - 1
    key, ends = np.empty((count, keys.shape[2])), np.ones(count)
    for i in range(count):
        key[i] = keys[i, last]
    legs = new_leg_poses(count)
    fill_leg_poses(given, ends, key, KEY_REACH, legs)
    for i in range(count):
        stands = 1 if given.on_right[i] else 0
        swings = 1 - stands
        keys[i, last, 2] = legs.root[i, 2] - given.standing[i, 2]
        keys[i, last, STANDING_PITCH] = legs.pitches[i, stands]
        keys[i, last, SWING_PITCH] = legs.pitches[i, swings]
        for d in range(3):
            keys[i, last, ANKLE + d] = legs.ankles[i, swings, d] - given.landing[i, d]
