"""Curves through the keys of steps, and feet that turn about their toes."""

from __future__ import annotations

import math

import numpy as np

from esplanade.actors.locomotion.gait._curve_kernels import smooth
from esplanade.actors.locomotion.planted.footprints import HEADING
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined, kernel

KEYS = 6
WIDTH = 21

# First columns of the parts of a key; `key_poses` says what they hold. The root is first.
PELVIS = 3
ANKLE = 7
SWING_PITCH = 10
STANDING_PITCH = 11
SWING_HEADING = 12
CHEST = 13
ARMS = 17

SETTLE = 0.1


@inlined
def slope_at(keys: Floats, k: int, d: int) -> float:
    """Slope of column d at key k, per interval: Catmull-Rom, at the ends that of a parabola.

    The columns that move the swing foot are level at the last key: the foot comes to rest.
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
    """Normalise the quaternion whose first column is given; in place."""
    length = 0.0
    for d in range(first, first + 4):
        length += row[d] * row[d]
    length = math.sqrt(length)
    for d in range(first, first + 4):
        row[d] /= length


@inlined
def interpolate(keys: Floats, u: float, out: Floats) -> None:
    """Write the pose at a share of a step with keys (KEYS, WIDTH) to out (WIDTH,)."""
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
def pin_toe(
    keys: Floats,
    landing_heading: float,
    lift: float,
    u: float,
    foot_m: float,
    at: Floats,
    out: Floats,
) -> None:
    """Let the swing foot of a pose `out` (WIDTH,) turn about its toe until toe-off; in place.

    After that the difference to its curve fades. `at` (WIDTH,) is scratch memory.
    """
    if lift <= 0.0 or u >= lift + SETTLE:
        return
    interpolate(keys, min(u, lift), at)
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
def fill_interpolated(keys: Floats, u: Floats, out: Floats) -> None:
    """Write the poses of keys (N, KEYS, WIDTH) at shares u (N,) to out (N, WIDTH)."""
    for i in range(len(u)):
        interpolate(keys[i], u[i], out[i])


@kernel
def fill_samples(
    keys: Floats, landing: Floats, lift: Floats, u: Floats, foot_m: Floats, out: Floats
) -> None:
    """Write the poses drawn of N steps at shares u (N,) to out (N, WIDTH)."""
    at = np.empty(WIDTH)
    for i in range(len(u)):
        interpolate(keys[i], u[i], out[i])
        pin_toe(keys[i], landing[i, HEADING], lift[i], u[i], foot_m[i], at, out[i])
