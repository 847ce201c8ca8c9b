"""Both feet during a planted step, one moment at a time; frame and units as in `_hips_kernels`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion._gait_kernels import mix, smooth, swinging_leg
from esplanade.actors.locomotion._hips_kernels import Hips, hips_at, lift_of
from esplanade.actors.locomotion._reach_kernels import FULL, eased, hip_too_high, raised_heel
from esplanade.actors.locomotion._stairs_kernels import swing_over, unevenness
from esplanade.actors.locomotion._turning_kernels import BothDown, Footprint, Poses, both_down
from esplanade.actors.locomotion.skeleton import FOOT, SHIN, THIGH, TRACK_HALF_WIDTH, Floats
from esplanade.actors.locomotion.step_length import RV_LONGEST
from esplanade.planning.compiled.jit import inlined, kernel

_AT_ENDS = 0.04
"""Share of a step at its ends in which a foot is where the footprint has it, whatever the leg."""

_SPARE = 0.004
"""What feet clear the ground by where they come nearest to it."""

_LOWEST = 0.03
"""Feet that move are lifted at least so much beyond the curves."""

_MOVES_FROM = 0.1
"""Leg lengths; feet that move less are lifted less."""


class Foot(NamedTuple):
    x: float
    """Of the ankle."""
    y: float
    z: float
    pitch: float


@inlined
def _over_toe(footprint: Footprint, pitch: float) -> tuple[float, float, float]:
    """Ankle of a foot that is pitched about its toe, which keeps to the footprint."""
    drawn = FOOT * (1.0 - math.cos(pitch))
    return (
        footprint[0] + drawn * math.cos(footprint[3]),
        footprint[1] + drawn * math.sin(footprint[3]),
        footprint[2] - FOOT * math.sin(pitch),
    )


@inlined
def _raised(hips: Hips, side: float, footprint: Footprint, pitch: float) -> float:
    """Pitch of a foot on its toe so that its ankle is in reach; side is 1 for the standing leg."""
    cos, sin = math.cos(footprint[3]), math.sin(footprint[3])
    x = hips.x + side * hips.aside[0] - footprint[0] - FOOT * cos
    y = hips.y + side * hips.aside[1] - footprint[1] - FOOT * sin
    up = hips.z + side * hips.aside[2] - footprint[2]
    return raised_heel(x * cos + y * sin, y * cos - x * sin, up, pitch)


@kernel
def standing_foot(before: BothDown, after: BothDown, hips: Hips, u: float) -> Foot:
    """Down on the heel, flat, up on the toe; where the leg is too short the heel rises more."""
    down = before.strike * (1.0 - smooth(u / 0.2))
    pitch = down - math.asin(after.heel * smooth((u - 0.55) / 0.45) / FOOT)
    here = (0.0, 0.0, 0.0, 0.0)
    if pitch <= 0.0:
        pitch = mix(pitch, _raised(hips, 1.0, here, pitch), smooth(u / _AT_ENDS))
    x, y, z = _over_toe(here, min(pitch, 0.0))
    return Foot(x, y, z, pitch)


@inlined
def _pinned_pitch(
    before: BothDown, lifted: Footprint, hips: Hips, u: float, lift: float, by_curves: float
) -> float:
    """Of the other foot as if its toe stayed down."""
    pitch = mix(-math.asin(before.heel / FOOT), by_curves, smooth(u / lift))
    return _raised(hips, -1.0, lifted, pitch)


@inlined
def _bump(swung: float) -> float:
    return smooth(swung / 0.3) * (1.0 - smooth((swung - 0.5) / 0.5))


@inlined
def _level_swing(
    pinned: Foot,
    under: float,
    landing: Footprint,
    strike: float,
    hips: Hips,
    u: float,
    lift: float,
) -> Foot:
    """From the toe over to the curves, under hips that go straight ahead, and to the landing.

    under is the height of the ground below the foot.
    """
    hip, knee, ankle = swinging_leg(hips.rv, u)
    ahead = THIGH * math.sin(hip) + SHIN * math.sin(hip - knee)
    below = THIGH * math.cos(hip) + SHIN * math.cos(hip - knee)
    cos, sin = math.cos(hips.way), math.sin(hips.way)
    release, settle = smooth((u - lift) / 0.35), smooth((u - 0.7) / 0.3)
    x = mix(pinned.x, hips.place[0] + ahead * cos + TRACK_HALF_WIDTH * sin, release)
    y = mix(pinned.y, hips.place[1] + ahead * sin - TRACK_HALF_WIDTH * cos, release)
    z = mix(pinned.z, under + hips.height - below, release)
    pitch = mix(pinned.pitch, hip - knee + ankle, release)
    return Foot(
        mix(x, landing[0], settle),
        mix(y, landing[1], settle),
        mix(z, landing[2], settle),
        mix(pitch, strike, settle),
    )


@kernel
def swinging_foot(
    before: BothDown,
    after: BothDown,
    lifted: Footprint,
    landing: Footprint,
    hips: Hips,
    u: float,
    lift: float,
    lift_by: float,
) -> Foot:
    """On its toe until it lifts, then along the curves, then down on its footprint."""
    hip, knee, ankle = swinging_leg(hips.rv, u)
    pitch = _pinned_pitch(before, lifted, hips, u, lift, hip - knee + ankle)
    pinned_at = _over_toe(lifted, pitch)
    pinned = Foot(pinned_at[0], pinned_at[1], pinned_at[2], pitch)
    swung = max((u - lift) / (1.0 - lift), 0.0)
    if swung <= 0.0:
        return pinned
    under = mix(lifted[2], landing[2], smooth(swung))
    level = _level_swing(pinned, under, landing, after.strike, hips, u, lift)
    floor = under + FOOT * max(-math.sin(level.pitch), 0.0)
    height = max(level.z + lift_by * _bump(swung), floor)

    top = max(lifted[2], landing[2], 0.0)
    uneven = unevenness(top - min(lifted[2], landing[2], 0.0))
    over = swing_over(pinned_at, landing, top, swung)
    x, y = mix(level.x, over[0], uneven), mix(level.y, over[1], uneven)
    z = mix(height, over[2], uneven)
    flat = mix(pitch, after.strike, smooth(swung / 0.5))

    hip_x, hip_y = hips.x - hips.aside[0], hips.y - hips.aside[1]
    hip_z = hips.z - hips.aside[2]
    distance = math.sqrt((x - hip_x) ** 2 + (y - hip_y) ** 2 + (z - hip_z) ** 2)
    free = smooth(swung / 0.1) * (1.0 - smooth((u - 1.0 + _AT_ENDS) / _AT_ENDS))
    shrunk = mix(1.0, eased(distance) / max(distance, 1e-9), free)
    return Foot(
        mix(hip_x, x, shrunk),
        mix(hip_y, y, shrunk),
        mix(hip_z, z, shrunk),
        mix(level.pitch, flat, uneven),
    )


@inlined
def too_high(hips: Hips, standing: Foot, swinging: Foot) -> float:
    """How much the hips must come down for the legs of both feet to reach them."""
    x, y, z = hips.aside
    down = hip_too_high(
        hips.x + x - standing.x, hips.y + y - standing.y, hips.z + z - standing.z, FULL
    )
    return down + hip_too_high(
        hips.x - x - swinging.x, hips.y - y - swinging.y, hips.z - down - z - swinging.z, FULL
    )


@kernel
def clearance(
    before: BothDown, after: BothDown, lifted: Footprint, landing: Footprint, table: Floats
) -> float:
    """How much a foot is lifted beyond the curves: so that it clears the ground.

    Feet that hardly move are hardly lifted.
    """
    last = len(table) - 1
    row, column = before.rv / RV_LONGEST * last, after.rv / RV_LONGEST * last
    i, j = min(int(row), last - 1), min(int(column), last - 1)
    needed = mix(
        mix(table[i, j], table[i + 1, j], row - i),
        mix(table[i, j + 1], table[i + 1, j + 1], row - i),
        column - j,
    )
    moved = math.hypot(landing[0] - lifted[0], landing[1] - lifted[1])
    moved += FOOT * abs(landing[3] - lifted[3])
    return max(needed, _LOWEST) * smooth(moved / _MOVES_FROM)


@kernel
def fill_clearances(lengths: Floats, poses: Poses, table: Floats) -> None:
    """What straight steps on level ground need, by lengths (M,) at both ends, (M, M).

    In leg lengths: the largest lift that any of 60 moments of a step asks for.
    """
    aside = -2.0 * TRACK_HALF_WIDTH
    here = (0.0, 0.0, 0.0, 0.0)
    for i in range(len(lengths)):
        for j in range(len(lengths)):
            lifted, landing = (-lengths[i], aside, 0.0, 0.0), (lengths[j], aside, 0.0, 0.0)
            before = both_down(lifted, here, 1.0, poses)
            after = both_down(here, landing, -1.0, poses)
            lift = lift_of(before, after)
            table[i, j] = 0.0
            for u in np.linspace(0.4, 0.99, 60):
                bump = _bump((u - lift) / (1.0 - lift))
                if bump <= 0.02:
                    continue
                hips = hips_at(before, after, u)
                hip, knee, ankle = swinging_leg(hips.rv, u)
                pitch = _pinned_pitch(before, lifted, hips, u, lift, hip - knee + ankle)
                x, y, z = _over_toe(lifted, pitch)
                foot = _level_swing(Foot(x, y, z, pitch), 0.0, landing, after.strike, hips, u, lift)
                short = FOOT * max(-math.sin(foot.pitch), 0.0) - foot.z
                table[i, j] = max(table[i, j], short / bump + _SPARE)
