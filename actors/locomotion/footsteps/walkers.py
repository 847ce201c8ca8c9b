"""Walkers: the feet of everyone in a zone, which follow the bodies with real steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, Final

import numpy as np

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.body.traits import WalkerTraits
from esplanade.actors.locomotion.footsteps import _walker_kernels as kernels
from esplanade.actors.locomotion.footsteps._foothold_kernels import HeelTable
from esplanade.actors.locomotion.footsteps._trigger_kernels import StepGoals
from esplanade.actors.locomotion.footsteps._walker_kernels import WalkerArrays
from esplanade.actors.locomotion.footsteps.course import Course
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.locomotion.gait.step_length import (
    RV_LONGEST,
    planted_length,
    straight_double_support,
)
from esplanade.actors.locomotion.motion.key_poses import Steps, no_steps
from esplanade.actors.locomotion.motion.transitions import standing_keys
from esplanade.actors.locomotion.planted.footprints import HEADING, ON_MAP, StepFootprints, Z
from esplanade.actors.locomotion.planted.step import gait_tables
from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.compiled.handle import make_handle

Publish = Callable[[Steps, Ints], Steps]
"""Sends the steps that begin in these slots to everyone; returns them as they were quantised."""

JUMP_M: Final = 1.5
"""A body this far from its feet, along any axis, stands anew where it is."""


class Walkers:
    """The feet of everyone, by slot.

    A tick is one call of compiled code for all of them, which holds no interpreter lock; any thread
    may make it, one at a time.
    """

    def __init__(self, capacity: int, ground: Ground, tick_s: float, publish: Publish) -> None:
        self._ground = ground
        self._tick_s = tick_s
        self._publish = publish
        self.steps = no_steps(capacity)
        """The step of everyone that is under way or was the last, as it is drawn."""
        self.lost = 0
        """Number of times that a body was too far from its feet and stood anew."""
        self._arrays = WalkerArrays(
            self.steps,
            np.zeros((capacity, 4)),
            np.zeros(capacity),
            StepGoals(
                np.zeros((capacity, 2)),
                np.zeros((capacity, 2)),
                np.zeros(capacity),
                np.zeros(capacity),
                np.ones(capacity),
                np.ones(capacity),
            ),
            ground.arrays,
            gait_tables(),
            heel_table(),
        )
        self._held = make_handle(self._arrays)

    def join(self, tick: int, slots: Ints, traits: Sequence[WalkerTraits], course: Course) -> None:
        """Let a new walker stand in each of slots (N,), at the beginning of its course."""
        goals = self._arrays.goals
        goals.leg_m[slots] = [each.leg_m for each in traits]
        goals.cadence_factor[slots] = [each.cadence_factor for each in traits]
        self._stand(tick, slots, course)

    def set_cadences(self, slots: Ints, factors: Floats) -> None:
        """Let walkers in slots (N,) take so many times as many steps, (N,), as most people do."""
        self._arrays.goals.cadence_factor[slots] = factors

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
        headings, ahead = course
        if not kernels.courses_are_finite(headings, ahead):
            raise ValueError("courses must be finite")
        lost = kernels.find_lost(self.steps, slots, ahead, JUMP_M)
        if len(lost):
            self._stand(tick, slots[lost], course.take(lost))
            self.lost += len(lost)
        begun, steps = kernels.begin_steps(self._held, tick, self._tick_s, slots, headings, ahead)
        if not np.isfinite(steps.keys).all():
            raise ValueError("a key of a step is not a finite number")
        if len(begun):
            self.steps.put(begun, self._publish(steps, begun))

    def save(self, slots: Ints) -> dict[str, Any]:
        """The feet of the walkers in slots (N,), as copies of arrays of N rows, by their names.

        Their steps are not among them: those were published.
        """
        return {name: column[slots] for name, column in self._own_columns().items()}

    def load(self, slots: Ints, saved: Mapping[str, Any], steps: Steps) -> None:
        """Give the walkers in slots (N,) the feet that were saved, and their steps.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or has another shape, or is not finite.
        """
        columns = {**self.steps._asdict(), **self._own_columns()}
        given = {**saved, **steps._asdict()}
        for name, column in columns.items():
            rows = np.asarray(given[name], dtype=column.dtype)
            if rows.shape != (len(slots), *column.shape[1:]) or not np.isfinite(rows).all():
                raise ValueError(f"feet of {len(slots)} walkers cannot have such {name}")
            column[slots] = rows

    def _own_columns(self) -> dict[str, np.ndarray[Any, Any]]:
        """All that belongs to one walker each but its step, by names."""
        arrays, goals = self._arrays, self._arrays.goals._asdict()
        return {
            "lifted": arrays.lifted,
            "elapsed": arrays.elapsed,
            **{f"goal_{name}": column for name, column in goals.items()},
        }

    def _stand(self, tick: int, slots: Ints, course: Course) -> None:
        """Let bodies stand where their courses begin, on two new footprints."""
        arrays, count = self._arrays, len(slots)
        places, headings = course.ahead[:, 0], course.headings
        leg_m = arrays.goals.leg_m[slots]
        aside = (TRACK_HALF_WIDTH * leg_m)[:, None] * np.stack(
            [-np.sin(headings), np.cos(headings)], axis=1
        )
        feet = np.empty((2, count, 4))
        for foot, sign in zip(feet, (1.0, -1.0), strict=True):
            foot[:, ON_MAP] = places[:, :2] + sign * aside
            foot[:, Z], foot[:, HEADING] = places[:, 2], headings
            foot[:], _ = self._ground.settle(foot, FOOT * leg_m)
        left, right = feet
        footprints = StepFootprints(np.ones(count, np.bool_), left, right, left, leg_m)
        steps = Steps(
            footprints.on_right,
            np.zeros(count, np.bool_),
            np.full(count, tick),
            np.zeros(count, np.int64),
            right,
            left,
            np.zeros(count),
            np.zeros(count),
            standing_keys(footprints),
        )
        self.steps.put(slots, self._publish(steps, slots))
        arrays.lifted[slots], arrays.elapsed[slots] = left, 0.0
        arrays.goals.body[slots], arrays.goals.velocity[slots] = places[:, :2], 0.0
        arrays.goals.heading[slots], arrays.goals.whole_s[slots] = headings, kernels.SHIFT_S


@cache
def heel_table() -> HeelTable:
    """The table of the places of heels ahead of the hips, of straight steps."""
    poses = straight_double_support(np.linspace(0.0, RV_LONGEST, 65))
    return HeelTable(planted_length(poses), np.ascontiguousarray(poses.front_forward))
