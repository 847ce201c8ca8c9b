"""Who begins which step when: feet that follow bodies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from actors.locomotion.aims import (
    WALKING_MPS,
    Course,
    aim,
    durations_s,
    wanted_headings,
    within_reach_s,
)
from actors.locomotion.builds import Manner
from actors.locomotion.ground import Ground
from actors.locomotion.motion import (
    ANKLE,
    ROOT,
    STANDING_PITCH,
    SWING_PITCH,
    Floats,
    Steps,
    no_steps,
    smooth,
)
from actors.locomotion.planted import Footfalls
from actors.locomotion.skeleton import FOOT, TRACK_HALF_WIDTH
from actors.locomotion.stance import Build
from actors.locomotion.strides import drawn, standing_keys, strides, wrapped

Slots = NDArray[np.int64]
Flags = NDArray[np.bool_]
Carry = Callable[[Steps, Slots], Steps]
"""Takes steps that begin to whoever draws them; returns what these get, quantised."""

JUMP_M: Final = 1.5
"""Who is so far from its feet stands anew there."""

_OFF_M: Final = 0.08
_TURNED_RAD: Final = 0.35
"""A body that stands lets its feet be so far from where they should be."""
_SOON_S: Final = 0.3
_RAISED_RAD: Final = 0.03
_SETTLED_M: Final = 0.004
_SETTLE_S: Final = 0.4
_ROOM: Final = 0.4
"""Hips may be so far from where footprints have them, in legs."""

_MOVED_M: Final = 0.06
_VEERED_RAD: Final = 0.26
_LATEST: Final = 0.75
"""A step is re-aimed when its end has moved by more, and not later than this share of it."""
_LEAPT_M: Final = 0.15
_LAST: Final = 0.95
_QUICK_S: Final = 0.25
"""If it has moved so far, later still; and the foot comes down within that time."""
_REST_S: Final = 0.15
"""It is left alone for so long before it may be re-aimed again."""


class Walkers:
    """The feet of everyone, by slot."""

    def __init__(self, capacity: int, ground: Ground, tick_s: float, carry: Carry) -> None:
        self._ground = ground
        self._tick_s = tick_s
        self._carry = carry
        self.steps = no_steps(capacity)
        """The step of everyone that is under way or was the last, as it is drawn."""
        self.lost = 0
        """How often somebody was too far from its feet and stood anew."""
        self._build = Build(np.ones(capacity), np.ones(capacity))
        self._briskness = np.ones(capacity)
        self._lifted = np.zeros((capacity, 4))
        self._step_s = np.zeros(capacity)
        self._gone = np.zeros(capacity)
        """How much of the whole step had gone when its present record began."""
        self._aimed = np.zeros((capacity, 2))
        self._speed = np.zeros((capacity, 2))
        self._wanted = np.zeros(capacity)

    def join(self, tick: int, slots: Slots, manners: Sequence[Manner], course: Course) -> None:
        """Somebody new stands in each of N slots, at the beginning of a course."""
        self._build.leg_m[slots] = [manner.leg_m for manner in manners]
        self._build.stature_m[slots] = [manner.stature_m for manner in manners]
        self._briskness[slots] = [manner.briskness for manner in manners]
        self._stand(tick, slots, course)

    def update(self, tick: int, slots: Slots, course: Course) -> None:
        """Begin and re-aim the steps of a tick, of everyone (N,) in turn with their courses."""
        steps = self.steps
        self._stand_where_lost(tick, slots, course)
        ends = steps.start[slots] + steps.ticks[slots]
        at_end = tick >= ends
        idle = np.flatnonzero(at_end)
        if len(idle):
            self._begin(tick, slots[idle], course.take(idle), ends[idle] == tick)
        share = steps.share(tick)[slots]
        under_way = np.flatnonzero(~at_end & (share < _LAST) & (share > 0.0))
        if len(under_way):
            self._re_aim(tick, slots[under_way], course.take(under_way))

    # --- standing -----------------------------------------------------------------------------

    def _stand_where_lost(self, tick: int, slots: Slots, course: Course) -> None:
        here = course.ahead[:, 0]
        root = self.steps.standing[slots, :2]
        away = np.hypot(*(here[:, :2] - root).T)
        up = np.abs(here[:, 2] - self.steps.standing[slots, 2])
        lost = np.flatnonzero((away > JUMP_M) | (up > JUMP_M))
        if len(lost):
            self._stand(tick, slots[lost], course.take(lost))
            self.lost += len(lost)

    def _stand(self, tick: int, slots: Slots, course: Course) -> None:
        places, headings = course.ahead[:, 0], course.headings
        leg_m = self._build.leg_m[slots]
        aside = (TRACK_HALF_WIDTH * leg_m)[:, None] * np.stack(
            [-np.sin(headings), np.cos(headings)], axis=1
        )
        feet = np.empty((2, len(slots), 4))
        for foot, sign in zip(feet, (1.0, -1.0), strict=True):
            foot[:, :2] = places[:, :2] + sign * aside
            foot[:, 2], foot[:, 3] = places[:, 2], headings
            foot[:], _ = self._ground.settle(foot, FOOT * leg_m)
        right = np.ones(len(slots), dtype=np.bool_)
        falls = Footfalls(right, feet[0], feet[1], feet[0], leg_m)
        self._go(
            slots,
            falls,
            tick,
            np.zeros(len(slots), dtype=np.int64),
            (standing_keys(falls), np.zeros(len(slots))),
        )
        self._aimed[slots], self._speed[slots] = places[:, :2], 0.0

    # --- steps that begin ---------------------------------------------------------------------

    def _begin(self, tick: int, slots: Slots, course: Course, just_ended: Flags) -> None:
        last = self.steps
        here = course.ahead[:, 0]
        soon = np.full(len(slots), _SOON_S)
        velocity = course.velocity(soon)
        wanted = wanted_headings(course, velocity)
        walking = np.hypot(velocity[:, 0], velocity[:, 1]) > WALKING_MPS
        flat = last.keys[slots, -1, STANDING_PITCH] > -_RAISED_RAD
        flat &= last.keys[slots, -1, SWING_PITCH] < _RAISED_RAD

        leg_m, right = self._build.leg_m[slots], last.right[slots]
        there = course.at(soon)[:, :2]
        side = np.where(right, 1.0, -1.0)
        stood = _off(last.standing[slots], there, wanted, -side, leg_m)
        swung = _off(last.landing[slots], there, wanted, side, leg_m)
        off_m, off_rad = np.maximum(stood, swung)
        restless = (off_m > _OFF_M) | (off_rad > _TURNED_RAD) | ~flat
        begins = np.flatnonzero(restless)
        if len(begins):
            # The foot goes first that is worse off; in a turn, the one on the inner side.
            turn = wrapped(wanted - last.standing[slots, 3])
            worse = stood[0] - swung[0] + 0.25 * (stood[1] - swung[1]) - 0.1 * side * turn
            swapped = (worse > -1e-6) | ~flat | (walking & just_ended)
            self._step(tick, slots[begins], course.take(begins), swapped[begins])
        root = last.standing[slots, :2] + last.keys[slots, -1, :2]
        still = np.hypot(*(there - here[:, :2]).T) < _SETTLED_M
        away = np.hypot(*(here[:, :2] - root).T)
        settles = np.flatnonzero(~restless & still & (away > _SETTLED_M))
        if len(settles):
            self._settle(tick, slots[settles], here[settles, :2])

    def _step(self, tick: int, slots: Slots, course: Course, swapped: Flags) -> None:
        last = self.steps.take(slots)
        leg_m = self._build.leg_m[slots]
        right = last.right ^ swapped
        standing = np.where(swapped[:, None], last.landing, last.standing)
        lifted = np.where(swapped[:, None], last.standing, last.landing)
        seconds = durations_s(course, standing, leg_m, self._briskness[slots])
        ticks = np.maximum(np.rint(seconds / self._tick_s), 2.0).astype(np.int64)
        seconds = np.asarray(ticks * self._tick_s)
        aims = aim(course, right, standing, leg_m, seconds, seconds, self._ground)
        falls = Footfalls(right, lifted, standing, aims.landing, leg_m)
        now = drawn(last, tick, falls, swapped, self._build.take(slots))
        gone = np.zeros(len(slots))
        keys = strides(falls, gone, now, ticks, aims.place, _ROOM * leg_m)
        self._go(slots, falls, tick, ticks, keys)
        self._step_s[slots] = seconds
        self._aimed[slots], self._speed[slots] = aims.body, aims.velocity
        self._wanted[slots] = aims.heading

    def _settle(self, tick: int, slots: Slots, places: Floats) -> None:
        """Bodies that stand shift their weight to where they are, feet as they are."""
        last = self.steps.take(slots)
        falls = Footfalls(
            last.right, last.landing, last.standing, last.landing, self._build.leg_m[slots]
        )
        now = drawn(
            last, tick, falls, np.zeros(len(slots), dtype=np.bool_), self._build.take(slots)
        )
        keys = np.repeat(now.key[:, None], last.keys.shape[1], axis=1)
        share = smooth(np.linspace(0.0, 1.0, last.keys.shape[1]))
        shift = places - falls.standing[:, :2] - now.key[:, ROOT][:, :2]
        keys[..., :2] += share[None, :, None] * shift[:, None]
        keys[..., ANKLE] = 0.0
        ticks = np.full(len(slots), max(2, round(_SETTLE_S / self._tick_s)))
        self._go(slots, falls, tick, ticks, (keys, np.zeros(len(slots))))
        self._step_s[slots] = ticks * self._tick_s
        self._aimed[slots], self._speed[slots] = places, 0.0

    # --- steps under way ----------------------------------------------------------------------

    def _re_aim(self, tick: int, slots: Slots, course: Course) -> None:
        steps = self.steps
        left_s = np.asarray((steps.start[slots] + steps.ticks[slots] - tick) * self._tick_s)
        velocity = course.velocity(left_s)
        # Feet land ahead of the body the further, the faster it is.
        moved = course.at(left_s)[:, :2] - self._aimed[slots]
        moved += _SOON_S * (velocity - self._speed[slots])
        moved_m = np.hypot(moved[:, 0], moved[:, 1])
        veered = np.abs(wrapped(wanted_headings(course, velocity) - self._wanted[slots]))
        leapt = moved_m > _LEAPT_M
        rested = (tick - steps.start[slots]) * self._tick_s >= _REST_S
        may = rested & (steps.share(tick)[slots] < _LATEST)
        rows = np.flatnonzero(leapt | may & ((moved_m > _MOVED_M) | (veered > _VEERED_RAD)))
        if not len(rows):
            return
        slots, course, left_s = slots[rows], course.take(rows), left_s[rows]
        last = steps.take(slots)
        leg_m = self._build.leg_m[slots]
        left_s = np.where(leapt[rows], np.minimum(left_s, _QUICK_S), left_s)
        left_s = within_reach_s(course, last.standing, leg_m, left_s)
        ticks = np.maximum(np.rint(left_s / self._tick_s), 2.0).astype(np.int64)
        left_s = np.asarray(ticks * self._tick_s)
        aims = aim(
            course, last.right, last.standing, leg_m, self._step_s[slots], left_s, self._ground
        )
        falls = Footfalls(last.right, self._lifted[slots], last.standing, aims.landing, leg_m)
        now = drawn(
            last, tick, falls, np.zeros(len(slots), dtype=np.bool_), self._build.take(slots)
        )
        gone = self._gone[slots] + (1.0 - self._gone[slots]) * last.share(tick)
        keys = strides(falls, gone, now, ticks, aims.place, _ROOM * leg_m)
        self._go(slots, falls, tick, ticks, keys, gone)
        self._aimed[slots], self._speed[slots] = aims.body, aims.velocity
        self._wanted[slots] = aims.heading

    def _go(
        self,
        slots: Slots,
        falls: Footfalls,
        tick: int,
        ticks: NDArray[np.int64],
        keys: tuple[Floats, Floats],
        gone: Floats | None = None,
    ) -> None:
        again = np.full(len(slots), gone is not None)
        start = np.full(len(slots), tick)
        steps = Steps(
            falls.right, again, start, ticks, falls.standing, falls.landing, keys[1], keys[0]
        )
        self.steps.put(slots, self._carry(steps, slots))
        self._lifted[slots] = falls.lifted
        self._gone[slots] = 0.0 if gone is None else gone


def _off(footprints: Floats, place: Floats, heading: Floats, side: Floats, leg_m: Floats) -> Floats:
    """How far feet (N, 4) are from beside a place, metres, and turned from a heading: (2, N)."""
    aside = side * TRACK_HALF_WIDTH * leg_m
    x = place[:, 0] - aside * np.sin(heading) - footprints[:, 0]
    y = place[:, 1] + aside * np.cos(heading) - footprints[:, 1]
    return np.stack([np.hypot(x, y), np.abs(wrapped(heading - footprints[:, 3]))])
