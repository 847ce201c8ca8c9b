"""Step triggers: whether a body takes a step now, and whether one has to end elsewhere."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.footsteps._course_kernels import (
    WALKING_MPS,
    along,
    desired_heading,
    velocity_about,
)
from esplanade.actors.locomotion.footsteps._limit_kernels import wrapped
from esplanade.actors.locomotion.footsteps._timing_kernels import duration_s, within_reach_s
from esplanade.actors.locomotion.motion._current_pose_kernels import share_at
from esplanade.actors.locomotion.motion._key_pose_kernels import (
    KEYS,
    STANDING_PITCH,
    SWING_PITCH,
)
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.planted.footprints import HEADING
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import inlined

_SOON_S = 0.3
"""Feet follow where a body will be after this time."""
_OFF_M = 0.08
"""A body that stands lets its feet be this far from where they should be."""
_TURNED_RAD = 0.35
"""A body that stands lets its feet be turned away by this angle."""
_RAISED_RAD = 0.03
"""A foot that is pitched by less lies flat."""
_SETTLED_M = 0.004
"""Hips that are further from the body shift their weight."""

_MOVED_M = 0.06
"""A step is re-aimed when its end has moved by more than this."""
_VEERED_RAD = 0.26
"""A step is re-aimed when the body wants to face elsewhere by more than this angle."""
_LATEST = 0.75
"""A step is not re-aimed after this share of it, unless the foot would land far off."""
_REST_S = 0.15
"""A step is not re-aimed before this time has passed since it was last re-aimed, unless the
foot would land far off."""
_LEAPT_M = 0.15
"""A foot would land far off if that is further than this from where it was to land."""
_LAST = 0.95
"""A step whose foot would land far off is re-aimed up to this share of it."""
_QUICK_S = 0.25
"""A foot that would land far off comes down within this time."""
_FEWEST_TICKS = 2

GOES_ON = 0
STEPS = 1
RE_AIMS = 2
SHIFTS = 3
"""A walker does nothing new in a tick, or a step, the rest of a step anew, or a shift of weight."""


class StepGoals(NamedTuple):
    """The targets of the steps under way of N walkers, and traits of their bodies."""

    body: Floats
    """(N, 2), metres: place of the body at the end."""
    velocity: Floats
    """(N, 2), metres a second: its velocity then."""
    heading: Floats
    """(N,), radians: the heading that it wanted."""
    whole_s: Floats
    """(N,): duration of the whole step."""
    leg_m: Floats
    """(N,)."""
    cadence_factor: Floats
    """(N,), see `WalkerTraits`."""


class Trigger(NamedTuple):
    """Decision of one walker in a tick."""

    kind: int
    """GOES_ON, STEPS, RE_AIMS or SHIFTS."""
    swapped: bool
    """Whether the foot that swung last stands now."""
    ticks: int
    """Duration of the step from now on."""
    whole_s: float
    """Duration of the whole step."""


@inlined
def _ticks_of(seconds: float, tick_s: float) -> int:
    return int(max(np.rint(seconds / tick_s), _FEWEST_TICKS))


@inlined
def _deviation(
    footprint: Floats, x: float, y: float, heading: float, side: float, leg_m: float
) -> tuple[float, float]:
    """Deviation of a foot (4,) from where it should be beside a place: metres, radians."""
    aside = side * TRACK_HALF_WIDTH * leg_m
    off_x = x - aside * math.sin(heading) - footprint[0]
    off_y = y + aside * math.cos(heading) - footprint[1]
    return math.hypot(off_x, off_y), abs(wrapped(heading - footprint[HEADING]))


@inlined
def step_to_begin(
    tick: int,
    tick_s: float,
    steps: Steps,
    goals: StepGoals,
    slot: int,
    facing: float,
    ahead: Floats,
) -> Trigger:
    """Whether a walker whose step is over takes another step, or shifts its weight.

    A body that goes, or turns, or has its feet apart, takes a step, which lands where the body will
    be over both feet. A body that stands on both feet, but beside them, only shifts its weight. The
    body is on the course `ahead` (AHEAD, 3), `facing` somewhere.
    """
    leg_m = goals.leg_m[slot]
    last = steps.keys[slot, KEYS - 1]
    here, landed = steps.standing[slot], steps.landing[slot]
    x, y = along(ahead, _SOON_S, 0), along(ahead, _SOON_S, 1)
    x_mps, y_mps = velocity_about(ahead, _SOON_S)
    desired = desired_heading(facing, x_mps, y_mps)
    flat = last[STANDING_PITCH] > -_RAISED_RAD and last[SWING_PITCH] < _RAISED_RAD
    side = 1.0 if steps.on_right[slot] else -1.0
    stood_m, stood_rad = _deviation(here, x, y, desired, -side, leg_m)
    swung_m, swung_rad = _deviation(landed, x, y, desired, side, leg_m)
    stepping = max(stood_m, swung_m) > _OFF_M or max(stood_rad, swung_rad) > _TURNED_RAD
    if not stepping and flat:
        off_x = ahead[0, 0] - (here[0] + last[0])
        off_y = ahead[0, 1] - (here[1] + last[1])
        still = math.hypot(x - ahead[0, 0], y - ahead[0, 1]) < _SETTLED_M
        beside = math.hypot(off_x, off_y) > _SETTLED_M
        return Trigger(SHIFTS if still and beside else GOES_ON, False, 0, 0.0)

    # The foot that is worse off goes first; in a turn, the one on the inner side. A body that
    # walks steps with its feet in turn.
    turn = wrapped(desired - here[HEADING])
    worse = stood_m - swung_m + 0.25 * (stood_rad - swung_rad) - 0.1 * side * turn
    walks_on = math.hypot(x_mps, y_mps) > WALKING_MPS
    walks_on = walks_on and steps.start[slot] + steps.ticks[slot] == tick
    swapped = worse > -1e-6 or not flat or walks_on
    standing = landed if swapped else here
    seconds = duration_s(ahead, standing, leg_m, goals.cadence_factor[slot])
    ticks = _ticks_of(seconds, tick_s)
    return Trigger(STEPS, swapped, ticks, ticks * tick_s)


@inlined
def step_to_re_aim(
    tick: int,
    tick_s: float,
    steps: Steps,
    goals: StepGoals,
    slot: int,
    facing: float,
    ahead: Floats,
) -> Trigger:
    """Whether the step under way has to end elsewhere, because the body goes another way.

    Nobody turns in the air: a step that flies ends as it is. The arguments are those of
    `step_to_begin`.
    """
    never = Trigger(GOES_ON, False, 0, 0.0)
    start, end = steps.start[slot], steps.start[slot] + steps.ticks[slot]
    share = share_at(start, steps.ticks[slot], tick)
    if not 0.0 < share < _LAST or share >= 1.0 - steps.flight[slot]:
        return never
    left_s = (end - tick) * tick_s
    x_mps, y_mps = velocity_about(ahead, left_s)
    moved_x = along(ahead, left_s, 0) - goals.body[slot, 0]
    moved_y = along(ahead, left_s, 1) - goals.body[slot, 1]
    # Feet land ahead of the body, and the further, the faster it is.
    leap_x = moved_x + _SOON_S * (x_mps - goals.velocity[slot, 0])
    leap_y = moved_y + _SOON_S * (y_mps - goals.velocity[slot, 1])
    leapt = math.hypot(leap_x, leap_y) > _LEAPT_M
    if not leapt:
        veered = abs(wrapped(desired_heading(facing, x_mps, y_mps) - goals.heading[slot]))
        elsewhere = math.hypot(moved_x, moved_y) > _MOVED_M or veered > _VEERED_RAD
        rested = (tick - start) * tick_s >= _REST_S
        if not (elsewhere and rested and share < _LATEST):
            return never
    if leapt:
        left_s = min(left_s, _QUICK_S)
    left_s = within_reach_s(ahead, steps.standing[slot], goals.leg_m[slot], left_s)
    return Trigger(RE_AIMS, False, _ticks_of(left_s, tick_s), goals.whole_s[slot])
