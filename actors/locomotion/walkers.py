"""Feet that follow bodies: the walkers of a zone, and the steps they take."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.aims import Course, aim
from esplanade.actors.locomotion.builds import Physique
from esplanade.actors.locomotion.decisions import Due, Intent, beginning, re_aiming
from esplanade.actors.locomotion.footfalls import Footfalls
from esplanade.actors.locomotion.ground import Ground
from esplanade.actors.locomotion.motion import Floats, Steps, no_steps
from esplanade.actors.locomotion.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.stance import Build
from esplanade.actors.locomotion.strides import drawn, shifted, standing_keys, strides

Slots = NDArray[np.int64]
Carry = Callable[[Steps, Slots], Steps]
"""Takes steps that begin to whoever draws them; returns what these get, quantised."""

JUMP_M: Final = 1.5
"""Who is so far from its feet stands anew there."""
_MOST_GONE: Final = 0.99
"""Of a step that is aimed anew again and again some rest is always left."""
SHIFT_S: Final = 0.4
"""Weight is shifted from foot to foot in that time."""
_ROOM: Final = 0.4
"""Hips may be so far from where footprints have them, in legs."""


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
        self._lifted = np.zeros((capacity, 4))
        self._gone = np.zeros(capacity)
        """How much of the whole step had gone when its present record began."""
        self._intent = Intent(
            np.zeros((capacity, 2)),
            np.zeros((capacity, 2)),
            np.zeros(capacity),
            np.zeros(capacity),
            self._build.leg_m,
            np.ones(capacity),
        )

    def join(self, tick: int, slots: Slots, physiques: Sequence[Physique], course: Course) -> None:
        """Somebody new stands in each of N slots, at the beginning of a course."""
        self._build.leg_m[slots] = [each.leg_m for each in physiques]
        self._build.stature_m[slots] = [each.stature_m for each in physiques]
        self._intent.briskness[slots] = [each.briskness for each in physiques]
        self._stand(tick, slots, course)

    def update(self, tick: int, slots: Slots, course: Course) -> None:
        """Begin and re-aim the steps of a tick, of everyone (N,) in turn with their courses.

        Raises
        ------
        ValueError
            A course holds something that is not a finite number. Nothing is changed then.
        """
        if not (np.isfinite(course.ahead).all() and np.isfinite(course.headings).all()):
            raise ValueError("courses must be finite")
        self._stand_where_lost(tick, slots, course)
        intent = Intent._make(column[slots] for column in self._intent)
        heads = self.steps.heads(slots)
        goes_on = re_aiming(tick, self._tick_s, heads, intent, course)
        idle = np.flatnonzero(tick >= heads.start + heads.ticks)
        begins, uneasy = beginning(
            tick,
            self._tick_s,
            self.steps.take(slots[idle]),
            Intent._make(column[idle] for column in intent),
            course.take(idle),
        )
        begins, uneasy = begins._replace(rows=idle[begins.rows]), idle[uneasy]
        due = Due._make(np.concatenate(pair) for pair in zip(begins, goes_on, strict=True))
        if len(due.rows):
            self._step(tick, slots[due.rows], course.take(due.rows), due)
        if len(uneasy):
            self._shift(tick, slots[uneasy], course.ahead[uneasy, 0, :2])

    def _stand_where_lost(self, tick: int, slots: Slots, course: Course) -> None:
        away = course.ahead[:, 0] - self.steps.standing[slots, :3]
        lost = np.flatnonzero((np.abs(away) > JUMP_M).any(axis=1))
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
        falls = Footfalls(np.ones(len(slots), np.bool_), feet[0], feet[1], feet[0], leg_m)
        self._rest(slots, falls, tick, 0, standing_keys(falls))
        self._intent.body[slots] = places[:, :2]

    def _shift(self, tick: int, slots: Slots, places: Floats) -> None:
        """Bodies that stand shift their weight to where they are, feet as they are."""
        last = self.steps.take(slots)
        build = self._build.take(slots)
        falls = Footfalls(last.right, last.landing, last.standing, last.landing, build.leg_m)
        now = drawn(last, tick, falls, np.zeros(len(slots), np.bool_), build)
        ticks = max(2, round(SHIFT_S / self._tick_s))
        self._rest(slots, falls, tick, ticks, shifted(now, falls, places))
        self._intent.body[slots] = places

    def _step(self, tick: int, slots: Slots, course: Course, due: Due) -> None:
        last, build = self.steps.take(slots), self._build.take(slots)
        right = last.right ^ due.swapped
        standing = np.where(due.swapped[:, None], last.landing, last.standing)
        lifted = np.where(due.swapped[:, None], last.standing, last.landing)
        lifted = np.where(due.again[:, None], self._lifted[slots], lifted)
        share = np.minimum(last.share(tick), _MOST_GONE)
        gone = self._gone[slots] + (1.0 - self._gone[slots]) * share
        gone = np.where(due.again, np.minimum(gone, _MOST_GONE), 0.0)
        left_s = np.asarray(due.ticks * self._tick_s)
        aims = aim(course, right, standing, build.leg_m, due.whole_s, left_s, self._ground)
        falls = Footfalls(right, lifted, standing, aims.landing, build.leg_m)
        now = drawn(last, tick, falls, due.swapped, build)
        keys, lift = strides(falls, gone, now, due.ticks, aims.place, _ROOM * build.leg_m)
        # A foot that is in the air already does not come down again before it lands.
        lift = np.where(due.again, np.maximum(last.lift - share, 0.0) / (1.0 - share), lift)
        self._go(slots, falls, tick, due.ticks, keys, lift, due.again)
        self._gone[slots] = gone
        self._intent.body[slots], self._intent.velocity[slots] = aims.body, aims.velocity
        self._intent.heading[slots], self._intent.whole_s[slots] = aims.heading, due.whole_s

    def _rest(self, slots: Slots, falls: Footfalls, tick: int, ticks: int, keys: Floats) -> None:
        """Go over to standing on two footprints."""
        count = len(slots)
        takes = np.full(count, ticks)
        self._go(slots, falls, tick, takes, keys, np.zeros(count), np.zeros(count, np.bool_))
        self._gone[slots] = 0.0
        self._intent.velocity[slots] = 0.0
        self._intent.heading[slots] = falls.standing[:, 3]
        self._intent.whole_s[slots] = SHIFT_S

    def _go(
        self,
        slots: Slots,
        falls: Footfalls,
        tick: int,
        ticks: Slots,
        keys: Floats,
        lift: Floats,
        again: NDArray[np.bool_],
    ) -> None:
        start = np.full(len(slots), tick)
        steps = Steps(falls.right, again, start, ticks, falls.standing, falls.landing, lift, keys)
        self.steps.put(slots, self._carry(steps, slots))
        self._lifted[slots] = falls.lifted
