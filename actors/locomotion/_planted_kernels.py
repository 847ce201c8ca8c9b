"""The planted step, one moment of one step at a time.

Within, the standing foot is the left one, its heel the origin, and it points along x; leg lengths.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from actors.locomotion._gait_kernels import (
    arm,
    chest_torsion,
    mix,
    pelvis,
    smooth,
    support_share,
    swinging_leg,
)
from actors.locomotion._reach_kernels import FULL, eased, hip_too_high, raised_heel
from actors.locomotion._stairs_kernels import ground_under_way, swing_over, unevenness
from actors.locomotion._turning_kernels import (
    CROUCH,
    BothDown,
    Footprint,
    Poses,
    both_down,
    hermite,
)
from actors.locomotion.footfalls import Footfalls, Targets
from actors.locomotion.skeleton import FOOT, SHIN, THIGH, TRACK_HALF_WIDTH, Floats
from actors.locomotion.step_length import RV_LONGEST
from planning._jit import inlined, kernel

_TURN = 2.0 * math.pi
_CREST = 0.35
"""The wave of the hips starts so far after its trough, as that of Boulic's pelvis does."""

_ASIDE = 0.15
"""Relative velocity of shifts that are no longer taken for a step ahead."""

_AT_ENDS = 0.04
"""Share of a step at its ends in which a foot is where the footprint has it, whatever the leg."""

_SPARE = 0.004
_LOWEST = 0.03
_MOVES_FROM = 0.1


class _Hips(NamedTuple):
    """The body at one moment."""

    x: float
    """Of the root, with its sway."""
    y: float
    z: float
    yaw: float
    lean: float
    roll: float
    aside: tuple[float, float, float]
    """From the root to the joint of the standing (left) leg."""
    place: tuple[float, float]
    """Root without its sway; feet swing beside this."""
    way: float
    """Heading without the pelvis' own twist."""
    height: float
    """Of the root above level ground as the curves have it."""
    rv: float


class _Foot(NamedTuple):
    x: float
    """Of the ankle."""
    y: float
    z: float
    pitch: float


@kernel
def fill_targets(
    falls: Footfalls, u: Floats, poses: Poses, clearances: Floats, out: Targets
) -> None:
    """Targets of N steps at shares u (N, K). clearances is what `fill_clearances` made."""
    for i in range(u.shape[0]):
        mirror = -1.0 if falls.right[i] else 1.0
        lifted = _seen(falls.lifted[i], falls.standing[i], falls.leg_m[i], mirror)
        landing = _seen(falls.landing[i], falls.standing[i], falls.leg_m[i], mirror)
        here = (0.0, 0.0, 0.0, 0.0)
        before, after = both_down(lifted, here, 1.0, poses), both_down(here, landing, -1.0, poses)
        lift = _lift(before, after)
        lift_by = _clearance(before, after, lifted, landing, clearances)
        out.lift[i] = lift
        for k in range(u.shape[1]):
            hips = _hips_at(before, after, u[i, k])
            standing = _standing_foot(before, after, hips, u[i, k])
            swinging = _swinging_foot(before, after, lifted, landing, hips, u[i, k], lift, lift_by)
            height = hips.z - _too_high(hips, standing, swinging)
            pace = mix(before.pace, after.pace, smooth(u[i, k]))
            turned = mix(lifted[3], landing[3], smooth((u[i, k] - lift) / (1.0 - lift)))
            _put(out.root[i, k], hips.x, hips.y, height, falls.standing[i], falls.leg_m[i], mirror)
            _put(
                out.swing_ankle[i, k],
                swinging.x,
                swinging.y,
                swinging.z,
                falls.standing[i],
                falls.leg_m[i],
                mirror,
            )
            out.yaw[i, k] = falls.standing[i, 3] + mirror * hips.yaw
            out.lean[i, k], out.roll[i, k] = hips.lean, mirror * hips.roll
            out.swing_pitch[i, k], out.standing_pitch[i, k] = swinging.pitch, standing.pitch
            out.swing_heading[i, k] = falls.standing[i, 3] + mirror * turned
            out.torsion[i, k] = mirror * chest_torsion(pace, u[i, k])
            near, far = (1, 0) if falls.right[i] else (0, 1)
            out.shoulders[i, k, near], out.elbows[i, k, near] = arm(pace, 0.5 * u[i, k])
            out.shoulders[i, k, far], out.elbows[i, k, far] = arm(pace, 0.5 + 0.5 * u[i, k])


@inlined
def _seen(footprint: Floats, standing: Floats, leg_m: float, mirror: float) -> Footprint:
    """A footprint from the standing foot, as if that were the left one."""
    cos, sin = math.cos(standing[3]), math.sin(standing[3])
    x, y = (footprint[0] - standing[0]) / leg_m, (footprint[1] - standing[1]) / leg_m
    turned = (footprint[3] - standing[3] + math.pi) % _TURN - math.pi
    return (
        x * cos + y * sin,
        mirror * (y * cos - x * sin),
        (footprint[2] - standing[2]) / leg_m,
        mirror * turned,
    )


@inlined
def _put(
    out: Floats, x: float, y: float, z: float, standing: Floats, leg_m: float, mirror: float
) -> None:
    """Write a place as it is in the world."""
    cos, sin = math.cos(standing[3]), math.sin(standing[3])
    out[0] = standing[0] + leg_m * (x * cos - mirror * y * sin)
    out[1] = standing[1] + leg_m * (x * sin + mirror * y * cos)
    out[2] = standing[2] + leg_m * z


@inlined
def _lift(before: BothDown, after: BothDown) -> float:
    """When the toe leaves the ground: earlier when going aside or back, where no toe pushes off."""
    rv, pace = 0.5 * (before.rv + after.rv), 0.5 * (before.pace + after.pace)
    return (2.0 * support_share(pace) - 1.0) * (1.0 - 0.5 * smooth((pace - rv) / _ASIDE))


@kernel
def _hips_at(before: BothDown, after: BothDown, u: float) -> _Hips:
    s = smooth(u)
    rv = mix(before.rv, after.rv, s)
    x = hermite(u, before.x, before.speed_x, after.x, after.speed_x)
    y = hermite(u, before.y, before.speed_y, after.y, after.speed_y)
    way = hermite(u, before.yaw, before.turning, after.yaw, after.turning)
    sway, twist, lean, roll = pelvis(rv, u)
    wave = math.sin(_TURN * (u - _CREST)) + math.sin(_TURN * _CREST)
    height = mix(
        before.hip_height + 0.425 * (1.0 - CROUCH - before.hip_height) * wave,
        after.hip_height + 0.425 * (1.0 - CROUCH - after.hip_height) * wave,
        s,
    )
    ground = ground_under_way(before.ground, after.ground, u)
    yaw = way + twist
    cos, sin = math.cos(yaw), math.sin(yaw)
    left, up = TRACK_HALF_WIDTH * math.cos(roll), TRACK_HALF_WIDTH * math.sin(roll)
    ahead = up * math.sin(lean)
    return _Hips(
        x - sway * math.sin(way),
        y + sway * math.cos(way),
        ground + height - mix(before.lowered, after.lowered, s),
        yaw,
        lean,
        roll,
        (ahead * cos - left * sin, ahead * sin + left * cos, up * math.cos(lean)),
        (x, y),
        way,
        height,
        rv,
    )


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
def _raised(hips: _Hips, side: float, footprint: Footprint, pitch: float) -> float:
    """Pitch of a foot on its toe so that its ankle is in reach; side is 1 for the standing leg."""
    cos, sin = math.cos(footprint[3]), math.sin(footprint[3])
    x = hips.x + side * hips.aside[0] - footprint[0] - FOOT * cos
    y = hips.y + side * hips.aside[1] - footprint[1] - FOOT * sin
    up = hips.z + side * hips.aside[2] - footprint[2]
    return raised_heel(x * cos + y * sin, y * cos - x * sin, up, pitch)


@kernel
def _standing_foot(before: BothDown, after: BothDown, hips: _Hips, u: float) -> _Foot:
    """Down on the heel, flat, up on the toe; where the leg is too short the heel rises more."""
    down = before.strike * (1.0 - smooth(u / 0.2))
    pitch = down - math.asin(after.heel * smooth((u - 0.55) / 0.45) / FOOT)
    here = (0.0, 0.0, 0.0, 0.0)
    if pitch <= 0.0:
        pitch = mix(pitch, _raised(hips, 1.0, here, pitch), smooth(u / _AT_ENDS))
    x, y, z = _over_toe(here, min(pitch, 0.0))
    return _Foot(x, y, z, pitch)


@inlined
def _pinned_pitch(
    before: BothDown, lifted: Footprint, hips: _Hips, u: float, lift: float, by_curves: float
) -> float:
    """Of the other foot as if its toe stayed down."""
    pitch = mix(-math.asin(before.heel / FOOT), by_curves, smooth(u / lift))
    return _raised(hips, -1.0, lifted, pitch)


@inlined
def _bump(swung: float) -> float:
    return smooth(swung / 0.3) * (1.0 - smooth((swung - 0.5) / 0.5))


@inlined
def _level_swing(
    pinned: _Foot,
    under: float,
    landing: Footprint,
    strike: float,
    hips: _Hips,
    u: float,
    lift: float,
) -> _Foot:
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
    return _Foot(
        mix(x, landing[0], settle),
        mix(y, landing[1], settle),
        mix(z, landing[2], settle),
        mix(pitch, strike, settle),
    )


@kernel
def _swinging_foot(
    before: BothDown,
    after: BothDown,
    lifted: Footprint,
    landing: Footprint,
    hips: _Hips,
    u: float,
    lift: float,
    lift_by: float,
) -> _Foot:
    """On its toe until it lifts, then along the curves, then down on its footprint."""
    hip, knee, ankle = swinging_leg(hips.rv, u)
    pitch = _pinned_pitch(before, lifted, hips, u, lift, hip - knee + ankle)
    pinned_at = _over_toe(lifted, pitch)
    pinned = _Foot(pinned_at[0], pinned_at[1], pinned_at[2], pitch)
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
    return _Foot(
        mix(hip_x, x, shrunk),
        mix(hip_y, y, shrunk),
        mix(hip_z, z, shrunk),
        mix(level.pitch, flat, uneven),
    )


@inlined
def _too_high(hips: _Hips, standing: _Foot, swinging: _Foot) -> float:
    """How much the hips must come down for the legs of both feet to reach them."""
    x, y, z = hips.aside
    down = hip_too_high(
        hips.x + x - standing.x, hips.y + y - standing.y, hips.z + z - standing.z, FULL
    )
    return down + hip_too_high(
        hips.x - x - swinging.x, hips.y - y - swinging.y, hips.z - down - z - swinging.z, FULL
    )


@kernel
def _clearance(
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
            lift = _lift(before, after)
            table[i, j] = 0.0
            for u in np.linspace(0.4, 0.99, 60):
                bump = _bump((u - lift) / (1.0 - lift))
                if bump <= 0.02:
                    continue
                hips = _hips_at(before, after, u)
                hip, knee, ankle = swinging_leg(hips.rv, u)
                pitch = _pinned_pitch(before, lifted, hips, u, lift, hip - knee + ankle)
                x, y, z = _over_toe(lifted, pitch)
                foot = _level_swing(
                    _Foot(x, y, z, pitch), 0.0, landing, after.strike, hips, u, lift
                )
                short = FOOT * max(-math.sin(foot.pitch), 0.0) - foot.z
                table[i, j] = max(table[i, j], short / bump + _SPARE)
