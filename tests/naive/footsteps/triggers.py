"""Step triggers: which bodies take a step now, and which steps under way have to end elsewhere."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.motion.key_poses import (
    ROOT_ON_MAP,
    STANDING_PITCH,
    SWING_PITCH,
    Steps,
)
from esplanade.actors.locomotion.planted.footprints import HEADING, ON_MAP
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from tests.naive.footsteps.course import WALKING_MPS, Course, desired_headings
from tests.naive.footsteps.timing import durations_s, within_reach_s
from tests.naive.headings import wrap_angle

_SOON_S: Final = 0.3
"""Feet follow where a body will be after this time."""
_OFF_M: Final = 0.08
"""A body that stands lets its feet be this far from where they should be."""
_TURNED_RAD: Final = 0.35
"""A body that stands lets its feet be turned away by this angle."""
_RAISED_RAD: Final = 0.03
"""A foot that is pitched by less lies flat."""
_SETTLED_M: Final = 0.004
"""Hips that are further from the body shift their weight."""

_MOVED_M: Final = 0.06
"""A step is re-aimed when its end has moved by more than this."""
_VEERED_RAD: Final = 0.26
"""A step is re-aimed when the body wants to face elsewhere by more than this angle."""
_LATEST: Final = 0.75
"""A step is not re-aimed after this share of it, unless the foot would land far off."""
_REST_S: Final = 0.15
"""A step is not re-aimed before this time has passed since it was last re-aimed, unless the
foot would land far off."""
_LEAPT_M: Final = 0.15
"""A foot would land far off if that is further than this from where it was to land."""
_LAST: Final = 0.95
"""A step whose foot would land far off is re-aimed up to this share of it."""
_QUICK_S: Final = 0.25
"""A foot that would land far off comes down within this time."""
_FEWEST_TICKS: Final = 2


class StepGoals(NamedTuple):
    """The targets of the steps under way of N walkers, and traits of their bodies."""

    body: Floats
    """(N, 2), metres: where the body was to be at the end."""
    velocity: Floats
    """(N, 2), metres a second: how fast it was to go then."""
    heading: Floats
    """(N,), radians: where it was to face."""
    whole_s: Floats
    """(N,): how long the step takes in all."""
    leg_m: Floats
    """(N,)."""
    cadence_factor: Floats
    """(N,), see `WalkerTraits`."""


class TriggeredSteps(NamedTuple):
    """The steps of some of N walkers that begin, or are re-aimed, in this tick."""

    rows: Ints
    """(D,): which of the walkers."""
    swapped: Bools
    """(D,): whether the foot that swung last stands now."""
    re_aimed: Bools
    """(D,): whether the step goes on from the one under way."""
    ticks: Ints
    """(D,): how long it takes from now on."""
    whole_s: Floats
    """(D,): how long it takes in all."""


def steps_to_begin(
    tick: int, tick_s: float, idle: Steps, goals: StepGoals, course: Course
) -> tuple[TriggeredSteps, Ints]:
    """Find which of N idle walkers take another step, and which only shift their weight.

    A body that goes, or turns, or has its feet apart, takes a step, which lands where the body will
    be over both feet. A body that stands on both feet, but beside them, only shifts its weight.

    Parameters
    ----------
    tick, tick_s : the present tick, and seconds a tick
    idle : the last steps of the walkers
    goals, course : of the walkers

    Returns
    -------
    TriggeredSteps, and int64 (S,), rows of the walkers that shift their weight
    """
    rows = np.arange(len(idle.start))
    leg_m = goals.leg_m
    soon = np.full(len(rows), _SOON_S)
    there = course.at(soon)[:, :2]
    velocity = course.velocity(soon)
    desired = desired_headings(course, velocity)
    flat = idle.keys[:, -1, STANDING_PITCH] > -_RAISED_RAD
    flat &= idle.keys[:, -1, SWING_PITCH] < _RAISED_RAD
    side = np.where(idle.on_right, 1.0, -1.0)
    stood = _deviations(idle.standing, there, desired, -side, leg_m)
    swung = _deviations(idle.landing, there, desired, side, leg_m)
    off_m, off_rad = np.maximum(stood, swung)
    stepping = (off_m > _OFF_M) | (off_rad > _TURNED_RAD) | ~flat

    # The foot that is worse off goes first; in a turn, the one on the inner side. A body that
    # walks steps with its feet in turn.
    turn = wrap_angle(desired - idle.standing[:, HEADING])
    worse = stood[0] - swung[0] + 0.25 * (stood[1] - swung[1]) - 0.1 * side * turn
    walks_on = (np.hypot(velocity[:, 0], velocity[:, 1]) > WALKING_MPS) & (
        idle.start + idle.ticks == tick
    )
    swapped = (worse > -1e-6) | ~flat | walks_on
    standing = np.where(swapped[:, None], idle.landing, idle.standing)
    seconds = durations_s(course, standing, leg_m, goals.cadence_factor)
    ticks = _ticks(seconds, tick_s)
    never = np.zeros(len(rows), dtype=np.bool_)
    begun = TriggeredSteps(rows, swapped, never, ticks, np.asarray(ticks * tick_s))

    hips = idle.standing[:, ON_MAP] + idle.keys[:, -1, ROOT_ON_MAP]
    here = course.ahead[:, 0, :2]
    still = np.hypot(*(there - here).T) < _SETTLED_M
    beside = np.hypot(*(here - hips).T) > _SETTLED_M
    chosen = TriggeredSteps._make(column[stepping] for column in begun)
    return chosen, rows[~stepping & still & beside]


def steps_to_re_aim(
    tick: int, tick_s: float, steps: Steps, goals: StepGoals, course: Course
) -> TriggeredSteps:
    """The steps under way that have to end elsewhere, because the body goes another way.

    Parameters
    ----------
    tick, tick_s : the present tick, and seconds a tick
    steps : the steps of N walkers; their keys are not needed
    goals, course : of the walkers
    """
    share = steps.share(tick)
    rows = np.flatnonzero((share > 0.0) & (share < _LAST) & (share < 1.0 - steps.flight))
    course = course.take(rows)
    left_s = np.asarray((steps.start[rows] + steps.ticks[rows] - tick) * tick_s)
    velocity = course.velocity(left_s)
    moved = course.at(left_s)[:, :2] - goals.body[rows]
    # Feet land ahead of the body, and the further, the faster it is.
    leap = moved + _SOON_S * (velocity - goals.velocity[rows])
    leapt = np.hypot(leap[:, 0], leap[:, 1]) > _LEAPT_M
    veered = np.abs(wrap_angle(desired_headings(course, velocity) - goals.heading[rows]))
    elsewhere = (np.hypot(moved[:, 0], moved[:, 1]) > _MOVED_M) | (veered > _VEERED_RAD)
    rested = (tick - steps.start[rows]) * tick_s >= _REST_S
    re_aimed = leapt | elsewhere & rested & (share[rows] < _LATEST)

    left_s = np.where(leapt, np.minimum(left_s, _QUICK_S), left_s)[re_aimed]
    rows, course = rows[re_aimed], course.take(np.flatnonzero(re_aimed))
    left_s = within_reach_s(course, steps.standing[rows], goals.leg_m[rows], left_s)
    never = np.zeros(len(rows), dtype=np.bool_)
    return TriggeredSteps(rows, never, ~never, _ticks(left_s, tick_s), goals.whole_s[rows])


def _ticks(seconds: Floats, tick_s: float) -> Ints:
    return np.maximum(np.rint(seconds / tick_s), _FEWEST_TICKS).astype(np.int64)


def _deviations(
    footprints: Floats, place: Floats, heading: Floats, side: Floats, leg_m: Floats
) -> Floats:
    """Deviations of feet (N, 4) from where they should be beside a place: float64 (2, N).

    The first row is a distance in metres, the second one an angle in radians.
    """
    aside = side * TRACK_HALF_WIDTH * leg_m
    x = place[:, 0] - aside * np.sin(heading) - footprints[:, 0]
    y = place[:, 1] + aside * np.cos(heading) - footprints[:, 1]
    return np.stack([np.hypot(x, y), np.abs(wrap_angle(heading - footprints[:, HEADING]))])
