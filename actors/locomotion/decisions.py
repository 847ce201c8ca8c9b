"""Who takes a step now, with which foot and for how long; and whose step has to end elsewhere."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.aims import (
    WALKING_MPS,
    Course,
    durations_s,
    wanted_headings,
    within_reach_s,
)
from esplanade.actors.locomotion.motion import STANDING_PITCH, SWING_PITCH, Floats, Steps
from esplanade.actors.locomotion.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.strides import wrapped

Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]

_SOON_S: Final = 0.3
"""Feet follow where a body will be then."""
_OFF_M: Final = 0.08
_TURNED_RAD: Final = 0.35
"""A body that stands lets its feet be so far from where they should be."""
_RAISED_RAD: Final = 0.03
"""A foot that is pitched by less lies flat."""
_SETTLED_M: Final = 0.004

_MOVED_M: Final = 0.06
_VEERED_RAD: Final = 0.26
_LATEST: Final = 0.75
"""A step is re-aimed when its end has moved by more, and not later than this share of it."""
_REST_S: Final = 0.15
"""It is left alone for so long before it may be re-aimed again."""
_LEAPT_M: Final = 0.15
_LAST: Final = 0.95
_QUICK_S: Final = 0.25
"""If feet would land so much elsewhere, later still; and the foot comes down within that time."""
_FEWEST_TICKS: Final = 2


class Intent(NamedTuple):
    """What the steps under way of N walkers were to reach, and their bodies."""

    body: Floats
    """(N, 2): where the body was to be at the end."""
    velocity: Floats
    """(N, 2): and how fast it was to go then."""
    heading: Floats
    """(N,): where it was to face."""
    whole_s: Floats
    """(N,): how long the step takes in all."""
    leg_m: Floats
    briskness: Floats


class Due(NamedTuple):
    """Those of N walkers whose step begins, or goes on otherwise, in this tick."""

    rows: Rows
    """(D,): which."""
    swapped: Flags
    """(D,): the foot that swung last stands now."""
    again: Flags
    """(D,): goes on from the step under way."""
    ticks: Rows
    """(D,): for so long from now."""
    whole_s: Floats
    """(D,): how long the step takes in all."""


def beginning(
    tick: int, tick_s: float, idle: Steps, intent: Intent, course: Course
) -> tuple[Due, Rows]:
    """Of those whose steps are over, who has to take another; and who better shifts where it is.

    A body that goes, or turns, or has its feet apart, steps; a foot lands where the body will be
    over both. Who stands on both feet beside them only shifts its weight.
    """
    rows = np.arange(len(idle.start))
    leg_m = intent.leg_m
    soon = np.full(len(rows), _SOON_S)
    there = course.at(soon)[:, :2]
    velocity = course.velocity(soon)
    wanted = wanted_headings(course, velocity)
    flat = idle.keys[:, -1, STANDING_PITCH] > -_RAISED_RAD
    flat &= idle.keys[:, -1, SWING_PITCH] < _RAISED_RAD
    side = np.where(idle.right, 1.0, -1.0)
    stood = _off(idle.standing, there, wanted, -side, leg_m)
    swung = _off(idle.landing, there, wanted, side, leg_m)
    off_m, off_rad = np.maximum(stood, swung)
    restless = (off_m > _OFF_M) | (off_rad > _TURNED_RAD) | ~flat

    # The foot goes first that is worse off; in a turn, the one on the inner side. Who walks
    # takes turns.
    turn = wrapped(wanted - idle.standing[:, 3])
    worse = stood[0] - swung[0] + 0.25 * (stood[1] - swung[1]) - 0.1 * side * turn
    walks_on = (np.hypot(velocity[:, 0], velocity[:, 1]) > WALKING_MPS) & (
        idle.start + idle.ticks == tick
    )
    swapped = (worse > -1e-6) | ~flat | walks_on
    standing = np.where(swapped[:, None], idle.landing, idle.standing)
    seconds = durations_s(course, standing, leg_m, intent.briskness)
    ticks = _ticks(seconds, tick_s)
    never = np.zeros(len(rows), dtype=np.bool_)
    due = Due(rows, swapped, never, ticks, np.asarray(ticks * tick_s))

    hips = idle.standing[:, :2] + idle.keys[:, -1, :2]
    here = course.ahead[:, 0, :2]
    still = np.hypot(*(there - here).T) < _SETTLED_M
    uneasy = np.hypot(*(here - hips).T) > _SETTLED_M
    return _some(due, restless), rows[~restless & still & uneasy]


def re_aiming(tick: int, tick_s: float, steps: Steps, intent: Intent, course: Course) -> Due:
    """Whose step under way has to end elsewhere: the body was seen to go another way.

    Of the steps the heads are enough.
    """
    share = steps.share(tick)
    rows = np.flatnonzero((share > 0.0) & (share < _LAST))
    course = course.take(rows)
    left_s = np.asarray((steps.start[rows] + steps.ticks[rows] - tick) * tick_s)
    velocity = course.velocity(left_s)
    moved = course.at(left_s)[:, :2] - intent.body[rows]
    # Feet land ahead of the body the further, the faster it is.
    leap = moved + _SOON_S * (velocity - intent.velocity[rows])
    leapt = np.hypot(leap[:, 0], leap[:, 1]) > _LEAPT_M
    veered = np.abs(wrapped(wanted_headings(course, velocity) - intent.heading[rows]))
    elsewhere = (np.hypot(moved[:, 0], moved[:, 1]) > _MOVED_M) | (veered > _VEERED_RAD)
    rested = (tick - steps.start[rows]) * tick_s >= _REST_S
    due = leapt | elsewhere & rested & (share[rows] < _LATEST)

    left_s = np.where(leapt, np.minimum(left_s, _QUICK_S), left_s)[due]
    rows, course = rows[due], course.take(np.flatnonzero(due))
    left_s = within_reach_s(course, steps.standing[rows], intent.leg_m[rows], left_s)
    never = np.zeros(len(rows), dtype=np.bool_)
    return Due(rows, never, ~never, _ticks(left_s, tick_s), intent.whole_s[rows])


def _ticks(seconds: Floats, tick_s: float) -> Rows:
    return np.maximum(np.rint(seconds / tick_s), _FEWEST_TICKS).astype(np.int64)


def _some(due: Due, which: Flags) -> Due:
    return Due._make(column[which] for column in due)


def _off(footprints: Floats, place: Floats, heading: Floats, side: Floats, leg_m: Floats) -> Floats:
    """How far feet (N, 4) are from beside a place, metres, and turned from a heading: (2, N)."""
    aside = side * TRACK_HALF_WIDTH * leg_m
    x = place[:, 0] - aside * np.sin(heading) - footprints[:, 0]
    y = place[:, 1] + aside * np.cos(heading) - footprints[:, 1]
    return np.stack([np.hypot(x, y), np.abs(wrapped(heading - footprints[:, 3]))])
