"""Curves through the keys of steps, and feet that turn about their toes."""

from __future__ import annotations

import math

import numpy as np

from esplanade.actors.locomotion._gait_kernels import smooth
from esplanade.actors.locomotion.skeleton import Floats
from esplanade.planning.compiled.jit import inlined, kernel

KEYS = 6
WIDTH = 21
PELVIS = 3
ANKLE = 7
SWING_PITCH = 10
STANDING_PITCH = 11
SWING_HEADING = 12
CHEST = 13
SETTLE = 0.1


@inlined
def slope_at(keys: Floats, k: int, d: int) -> float:
    """Slope of a number at a key, per interval: Catmull-Rom, at the ends of a parabola.

    What moves the swinging foot comes to rest at the end.
    """
    if k == 0:
        return float(-1.5 * keys[0, d] + 2.0 * keys[1, d] - 0.5 * keys[2, d])
    if k < KEYS - 1:
        return float(0.5 * (keys[k + 1, d] - keys[k - 1, d]))
    if ANKLE <= d <= SWING_PITCH or d == SWING_HEADING:
        return 0.0
    return float(0.5 * keys[k - 2, d] - 2.0 * keys[k - 1, d] + 1.5 * keys[k, d])


@inlined
def make_unit(row: Floats, first: int) -> None:
    """Bring the quaternion that begins there to length 1."""
    length = 0.0
    for d in range(first, first + 4):
        length += row[d] * row[d]
    length = math.sqrt(length)
    for d in range(first, first + 4):
        row[d] /= length


@inlined
def between(keys: Floats, u: float, out: Floats) -> None:
    """Keys (KEYS, WIDTH) at a share of a step -> out (WIDTH,)."""
    place = min(max(u, 0.0), 1.0) * (KEYS - 1)
    k = min(int(place), KEYS - 2)
    s = place - k
    after = s * s * (3.0 - 2.0 * s)
    leaving = s * (1.0 - s) * (1.0 - s)
    reaching = s * s * (1.0 - s)
    for d in range(WIDTH):
        out[d] = (
            (1.0 - after) * keys[k, d]
            + after * keys[k + 1, d]
            + leaving * slope_at(keys, k, d)
            - reaching * slope_at(keys, k + 1, d)
        )
    make_unit(out, PELVIS)
    make_unit(out, CHEST)


@inlined
def keep_on_toe(
    keys: Floats,
    landing_heading: float,
    lift: float,
    u: float,
    foot_m: float,
    at: Floats,
    out: Floats,
) -> None:
    """Until it lifts, the swinging foot turns on its toe; then what is missing fades; in place.

    at (WIDTH,) is for this to write on.
    """
    if lift <= 0.0 or u >= lift + SETTLE:
        return
    between(keys, min(u, lift), at)
    level0 = foot_m * math.cos(keys[0, SWING_PITCH])
    level = foot_m * math.cos(at[SWING_PITCH])
    heading0 = landing_heading + keys[0, SWING_HEADING]
    heading = landing_heading + at[SWING_HEADING]
    fade = 1.0 - smooth((u - lift) / SETTLE)
    x = keys[0, ANKLE] + level0 * math.cos(heading0) - level * math.cos(heading)
    y = keys[0, ANKLE + 1] + level0 * math.sin(heading0) - level * math.sin(heading)
    z = keys[0, ANKLE + 2] + foot_m * (math.sin(keys[0, SWING_PITCH]) - math.sin(at[SWING_PITCH]))
    out[ANKLE] += fade * (x - at[ANKLE])
    out[ANKLE + 1] += fade * (y - at[ANKLE + 1])
    out[ANKLE + 2] += fade * (z - at[ANKLE + 2])


@kernel
def fill_between(keys: Floats, u: Floats, out: Floats) -> None:
    """Keys (N, KEYS, WIDTH) at shares (N,) -> (N, WIDTH)."""
    for i in range(len(u)):
        between(keys[i], u[i], out[i])


@kernel
def fill_under_way(
    keys: Floats, landing: Floats, lift: Floats, u: Floats, foot_m: Floats, out: Floats
) -> None:
    """What is drawn of N steps at shares (N,) -> keys (N, WIDTH)."""
    at = np.empty(WIDTH)
    for i in range(len(u)):
        between(keys[i], u[i], out[i])
        keep_on_toe(keys[i], landing[i, 3], lift[i], u[i], foot_m[i], at, out[i])
