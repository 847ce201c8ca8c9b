"""Walkers, whole arrays at a time: first those lost, then steps, then shifts of weight."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.body.traits import WalkerTraits
from esplanade.actors.locomotion.motion.key_poses import Steps, no_steps
from esplanade.actors.locomotion.planted.footprints import (
    HEADING,
    ON_MAP,
    PLACE,
    StepFootprints,
    Z,
)
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from tests.naive.footsteps.course import Course
from tests.naive.footsteps.footholds import choose_footholds
from tests.naive.footsteps.ground import Ground
from tests.naive.footsteps.transitions import (
    current_pose,
    standing_keys,
    step_keys,
    weight_shift_keys,
)
from tests.naive.footsteps.triggers import (
    StepGoals,
    TriggeredSteps,
    steps_to_begin,
    steps_to_re_aim,
)
from tests.naive.steps import let_legs_reach

Publish = Callable[[Steps, Ints], Steps]
"""Sends the steps that begin in these slots to everyone; returns them as they were quantised."""

JUMP_M: Final = 1.5
"""A body this far from its feet, along any axis, stands anew where it is."""
SHIFT_S: Final = 0.4
"""Duration of a shift of weight from foot to foot."""
_MOST_ELAPSED: Final = 0.99
"""However often a step is re-aimed, the rest above this share of it is left."""
_ROOM: Final = 0.4
"""Hips may be this far from where footprints have them, leg lengths."""


class Walkers:
    """The feet of everyone, by slot."""

    def __init__(self, capacity: int, ground: Ground, tick_s: float, publish: Publish) -> None:
        self._ground = ground
        self._tick_s = tick_s
        self._publish = publish
        self.steps = no_steps(capacity)
        """The step of everyone that is under way or was the last, as it is drawn."""
        self.lost = 0
        """Number of times that a body was too far from its feet and stood anew."""
        self._sizes = BodySizes(np.ones(capacity), np.ones(capacity))
        self._lifted = np.zeros((capacity, 4))
        self._elapsed = np.zeros(capacity)
        """Share of the whole step that was over when its present record began."""
        self._goals = StepGoals(
            np.zeros((capacity, 2)),
            np.zeros((capacity, 2)),
            np.zeros(capacity),
            np.zeros(capacity),
            self._sizes.leg_m,
            np.ones(capacity),
        )

    def join(self, tick: int, slots: Ints, traits: Sequence[WalkerTraits], course: Course) -> None:
        """Let a new walker stand in each of slots (N,), at the beginning of its course."""
        course = Course(*course)
        self._sizes.leg_m[slots] = [each.leg_m for each in traits]
        self._sizes.stature_m[slots] = [each.stature_m for each in traits]
        self._goals.cadence_factor[slots] = [each.cadence_factor for each in traits]
        self._stand(tick, slots, course)

    def update(self, tick: int, slots: Ints, course: Course) -> None:
        """Begin and re-aim the steps of one tick.

        Parameters
        ----------
        tick : the present one
        slots : int64 (N,), everyone's
        course : of those in these slots, in this order

        Raises
        ------
        ValueError
            A course holds something that is not a finite number. Nothing is changed then.
        """
        course = Course(*course)
        if not (np.isfinite(course.ahead).all() and np.isfinite(course.headings).all()):
            raise ValueError("courses must be finite")
        self._stand_where_lost(tick, slots, course)
        goals = StepGoals._make(column[slots] for column in self._goals)
        steps = self.steps.take(slots)
        re_aimed = steps_to_re_aim(tick, self._tick_s, steps, goals, course)
        idle = np.flatnonzero(tick >= steps.start + steps.ticks)
        begun, shifting = steps_to_begin(
            tick,
            self._tick_s,
            self.steps.take(slots[idle]),
            StepGoals._make(column[idle] for column in goals),
            course.take(idle),
        )
        begun, shifting = begun._replace(rows=idle[begun.rows]), idle[shifting]
        pairs = zip(begun, re_aimed, strict=True)
        triggered = TriggeredSteps._make(np.concatenate(pair) for pair in pairs)
        if len(triggered.rows):
            rows = triggered.rows
            self._step(tick, slots[rows], course.take(rows), triggered)
        if len(shifting):
            self._shift(tick, slots[shifting], course.ahead[shifting, 0, :2])

    def _stand_where_lost(self, tick: int, slots: Ints, course: Course) -> None:
        standing, landing = (
            np.abs(course.ahead[:, 0] - feet[slots, PLACE])
            for feet in (self.steps.standing, self.steps.landing)
        )
        lost = np.flatnonzero((np.minimum(standing, landing) > JUMP_M).any(axis=1))
        if len(lost):
            self._stand(tick, slots[lost], course.take(lost))
            self.lost += len(lost)

    def _stand(self, tick: int, slots: Ints, course: Course) -> None:
        places, headings = course.ahead[:, 0], course.headings
        leg_m = self._sizes.leg_m[slots]
        aside = (TRACK_HALF_WIDTH * leg_m)[:, None] * np.stack(
            [-np.sin(headings), np.cos(headings)], axis=1
        )
        feet = np.empty((2, len(slots), 4))
        for foot, sign in zip(feet, (1.0, -1.0), strict=True):
            foot[:, ON_MAP] = places[:, :2] + sign * aside
            foot[:, Z], foot[:, HEADING] = places[:, 2], headings
            foot[:], _ = self._ground.settle(foot, FOOT * leg_m)
        footprints = StepFootprints(np.ones(len(slots), np.bool_), feet[0], feet[1], feet[0], leg_m)
        self._rest(slots, footprints, tick, 0, standing_keys(footprints))
        self._goals.body[slots] = places[:, :2]

    def _shift(self, tick: int, slots: Ints, places: Floats) -> None:
        """Let bodies that stand shift their weight to places (N, 2), their feet as they are."""
        last = self.steps.take(slots)
        sizes = self._sizes.take(slots)
        footprints = StepFootprints(
            last.on_right, last.landing, last.standing, last.landing, sizes.leg_m
        )
        now = current_pose(last, tick, footprints, np.zeros(len(slots), np.bool_), sizes)
        ticks = max(2, round(SHIFT_S / self._tick_s))
        keys = weight_shift_keys(now, footprints, places)
        self._rest(slots, footprints, tick, ticks, keys)
        self._goals.body[slots] = places

    def _step(self, tick: int, slots: Ints, course: Course, triggered: TriggeredSteps) -> None:
        last, sizes = self.steps.take(slots), self._sizes.take(slots)
        on_right = last.on_right ^ triggered.swapped
        standing = np.where(triggered.swapped[:, None], last.landing, last.standing)
        lifted = np.where(triggered.swapped[:, None], last.standing, last.landing)
        lifted = np.where(triggered.re_aimed[:, None], self._lifted[slots], lifted)
        share = np.minimum(last.share(tick), _MOST_ELAPSED)
        elapsed = self._elapsed[slots] + (1.0 - self._elapsed[slots]) * share
        elapsed = np.where(triggered.re_aimed, np.minimum(elapsed, _MOST_ELAPSED), 0.0)
        left_s = np.asarray(triggered.ticks * self._tick_s)
        chosen = choose_footholds(
            course, on_right, standing, sizes.leg_m, triggered.whole_s, left_s, self._ground
        )
        footprints = StepFootprints(on_right, lifted, standing, chosen.landing, sizes.leg_m)
        now = current_pose(last, tick, footprints, triggered.swapped, sizes)
        keys, lift, flight = step_keys(
            footprints, elapsed, now, triggered.ticks, chosen.hips, _ROOM * sizes.leg_m
        )
        # A foot that is in the air already does not come down again before it lands.
        left = np.maximum(last.lift - share, 0.0) / (1.0 - share)
        lift = np.where(triggered.re_aimed, left, lift)
        self._go(slots, footprints, tick, triggered.ticks, keys, lift, flight, triggered.re_aimed)
        self._elapsed[slots] = elapsed
        self._goals.body[slots], self._goals.velocity[slots] = chosen.body, chosen.velocity
        self._goals.heading[slots], self._goals.whole_s[slots] = chosen.heading, triggered.whole_s

    def _rest(
        self, slots: Ints, footprints: StepFootprints, tick: int, ticks: int, keys: Floats
    ) -> None:
        """Go over to standing on two footprints."""
        count = len(slots)
        takes = np.full(count, ticks)
        none, never = np.zeros(count), np.zeros(count, np.bool_)
        self._go(slots, footprints, tick, takes, keys, none, none, never)
        self._elapsed[slots] = 0.0
        self._goals.velocity[slots] = 0.0
        self._goals.heading[slots] = footprints.standing[:, HEADING]
        self._goals.whole_s[slots] = SHIFT_S

    def _go(
        self,
        slots: Ints,
        footprints: StepFootprints,
        tick: int,
        ticks: Ints,
        keys: Floats,
        lift: Floats,
        flight: Floats,
        re_aimed: Bools,
    ) -> None:
        """Begin steps: they are published, and kept as everyone gets them."""
        steps = Steps(
            footprints.on_right,
            re_aimed,
            np.full(len(slots), tick),
            ticks,
            footprints.standing,
            footprints.landing,
            lift,
            flight,
            keys,
        )
        if ticks.all():
            let_legs_reach(steps, self._sizes.take(slots))
        self.steps.put(slots, self._publish(steps, slots))
        self._lifted[slots] = footprints.lifted
