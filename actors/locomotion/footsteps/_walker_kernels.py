"""The steps that begin in a tick: of all walkers of a zone, in one call."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.footsteps._foothold_kernels import HeelTable, choose_foothold
from esplanade.actors.locomotion.footsteps._ground_kernels import (
    GroundArrays,
    new_covering,
)
from esplanade.actors.locomotion.footsteps._trigger_kernels import (
    GOES_ON,
    RE_AIMS,
    SHIFTS,
    StepGoals,
    Trigger,
    step_to_begin,
    step_to_re_aim,
)
from esplanade.actors.locomotion.motion._current_pose_kernels import (
    CurrentPose,
    current_pose,
    share_at,
)
from esplanade.actors.locomotion.motion._key_pose_kernels import KEYS, WIDTH
from esplanade.actors.locomotion.motion._leg_pose_kernels import Placement, let_legs_reach
from esplanade.actors.locomotion.motion._transition_kernels import (
    fill_shift_keys,
    fill_step_keys,
)
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.planted._step_kernels import GaitTables
from esplanade.actors.locomotion.planted.footprints import HEADING, StepFootprints
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from esplanade.planning.compiled.handle import Handle
from esplanade.planning.compiled.jit import kernel

SHIFT_S = 0.4
"""Duration of a shift of weight from foot to foot."""
_MOST_ELAPSED = 0.99
"""The rest above this share of a step is left, however often the step is re-aimed."""
_ROOM = 0.4
"""Hips may be this far from where footprints have them, leg lengths."""


class WalkerArrays(NamedTuple):
    """The feet of everyone, by slot, with the ground and the tables of their steps."""

    steps: Steps
    """The step of everyone that is under way or was the last, as it is drawn."""
    lifted: Floats
    """(C, 4): the footprint that the swing foot left."""
    elapsed: Floats
    """(C,): share of the whole step that was over when its present record began."""
    goals: StepGoals
    ground: GroundArrays
    gait: GaitTables
    heels: HeelTable


class _Triggered(NamedTuple):
    """The steps that begin in a tick: N of the walkers, those that shift their weight at last."""

    rows: Ints
    swapped: Bools
    re_aimed: Bools
    ticks: Ints
    whole_s: Floats
    shifts: int
    """The number of those that only shift their weight."""


@kernel
def _triggered(
    walkers: WalkerArrays, tick: int, tick_s: float, slots: Ints, headings: Floats, ahead: Floats
) -> _Triggered:
    """Find the walkers that begin a step, or the rest of one, or shift their weight."""
    steps, goals = walkers.steps, walkers.goals
    count = len(slots)
    rows, shifting = np.empty(count, np.int64), np.empty(count, np.int64)
    swapped, re_aimed = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
    ticks, whole_s = np.empty(count, np.int64), np.empty(count)
    begun, shifts = 0, 0
    for i in range(count):
        slot = slots[i]
        trigger = Trigger(GOES_ON, False, 0, 0.0)
        if tick >= steps.start[slot] + steps.ticks[slot]:
            trigger = step_to_begin(tick, tick_s, steps, goals, slot, headings[i], ahead[i])
        else:
            trigger = step_to_re_aim(tick, tick_s, steps, goals, slot, headings[i], ahead[i])
        if trigger.kind == SHIFTS:
            shifting[shifts] = i
            shifts += 1
        elif trigger.kind != GOES_ON:
            rows[begun] = i
            swapped[begun] = trigger.swapped
            re_aimed[begun] = trigger.kind == RE_AIMS
            ticks[begun], whole_s[begun] = trigger.ticks, trigger.whole_s
            begun += 1
    for k in range(shifts):
        rows[begun + k] = shifting[k]
        ticks[begun + k] = max(2, int(np.rint(SHIFT_S / tick_s)))
        whole_s[begun + k] = SHIFT_S
    all_of_them = begun + shifts
    return _Triggered(
        rows[:all_of_them],
        swapped[:all_of_them],
        re_aimed[:all_of_them],
        ticks[:all_of_them],
        whole_s[:all_of_them],
        shifts,
    )


@kernel
def _footprints(
    walkers: WalkerArrays,
    old: Steps,
    triggered: _Triggered,
    slots: Ints,
    headings: Floats,
    ahead: Floats,
    tick_s: float,
    hips: Floats,
) -> StepFootprints:
    """The footprints of the steps that begin; where hips go, and goals, are written."""
    goals, ground = walkers.goals, walkers.ground
    covering = new_covering(ground)
    count = len(triggered.rows)
    on_right, leg_m = np.empty(count, np.bool_), np.empty(count)
    lifted, standing, landing = np.empty((count, 4)), np.empty((count, 4)), np.empty((count, 4))
    for k in range(count):
        i = triggered.rows[k]
        slot = slots[i]
        swapped = triggered.swapped[k]
        on_right[k], leg_m[k] = old.on_right[k] != swapped, goals.leg_m[slot]
        standing[k] = old.landing[k] if swapped else old.standing[k]
        lifted[k] = old.standing[k] if swapped else old.landing[k]
        if triggered.re_aimed[k]:
            lifted[k] = walkers.lifted[slot]
        goals.whole_s[slot] = triggered.whole_s[k]
        if k >= count - triggered.shifts:
            landing[k] = old.landing[k]
            for d in range(2):
                hips[k, d] = goals.body[slot, d] = ahead[i, 0, d]
                goals.velocity[slot, d] = 0.0
            goals.heading[slot] = standing[k, HEADING]
        else:
            found = choose_foothold(
                ahead[i],
                headings[i],
                on_right[k],
                standing[k],
                leg_m[k],
                triggered.whole_s[k],
                triggered.ticks[k] * tick_s,
                walkers.heels,
                ground,
                covering,
                landing[k],
            )
            hips[k, 0], hips[k, 1] = found.hips_x, found.hips_y
            goals.body[slot, 0], goals.body[slot, 1] = found.body_x, found.body_y
            goals.velocity[slot, 0], goals.velocity[slot, 1] = found.x_mps, found.y_mps
            goals.heading[slot] = found.heading
    return StepFootprints(on_right, lifted, standing, landing, leg_m)


@kernel
def _elapsed(
    walkers: WalkerArrays, old: Steps, triggered: _Triggered, at: Ints, tick: int
) -> Floats:
    """Shares of the steps that are over already, which are kept: 0 but for those re-aimed."""
    out = np.zeros(len(at))
    for k in range(len(at)):
        if triggered.re_aimed[k]:
            share = min(share_at(old.start[k], old.ticks[k], tick), _MOST_ELAPSED)
            before = walkers.elapsed[at[k]]
            out[k] = min(before + (1.0 - before) * share, _MOST_ELAPSED)
        walkers.elapsed[at[k]] = out[k]
    return out


@kernel
def begin_steps(
    held: Handle[WalkerArrays],
    tick: int,
    tick_s: float,
    slots: Ints,
    headings: Floats,
    ahead: Floats,
) -> tuple[Ints, Steps]:
    """The steps that walkers in slots (N,) begin, or aim anew, in this tick, and whose they are.

    Their courses are headings (N,) and ahead (N, AHEAD, 3), as in `Course`. The result is the
    slots (D,) and D steps, which the caller keeps as everyone gets them; all else is kept here.
    """
    walkers = held.value
    steps = walkers.steps
    triggered = _triggered(walkers, tick, tick_s, slots, headings, ahead)
    at = slots[triggered.rows]
    count, begun = len(at), len(at) - triggered.shifts
    old = Steps(
        steps.on_right[at],
        steps.re_aimed[at],
        steps.start[at],
        steps.ticks[at],
        steps.standing[at],
        steps.landing[at],
        steps.lift[at],
        steps.flight[at],
        steps.keys[at],
    )
    hips = np.empty((count, 2))
    footprints = _footprints(walkers, old, triggered, slots, headings, ahead, tick_s, hips)
    now = current_pose(old, tick, footprints, triggered.swapped)
    elapsed = _elapsed(walkers, old, triggered, at, tick)
    keys = np.empty((count, KEYS, WIDTH))
    lift, flight = np.zeros(count), np.zeros(count)
    fill_step_keys(
        StepFootprints(
            footprints.on_right[:begun],
            footprints.lifted[:begun],
            footprints.standing[:begun],
            footprints.landing[:begun],
            footprints.leg_m[:begun],
        ),
        elapsed[:begun],
        CurrentPose(now.key[:begun], now.speed[:begun]),
        triggered.ticks[:begun],
        hips[:begun],
        _ROOM * footprints.leg_m[:begun],
        walkers.gait,
        keys[:begun],
        lift[:begun],
        flight[:begun],
    )
    for k in range(begun):
        if triggered.re_aimed[k]:
            # A foot that is in the air already does not come down again before it lands.
            share = min(share_at(old.start[k], old.ticks[k], tick), _MOST_ELAPSED)
            lift[k] = max(old.lift[k] - share, 0.0) / (1.0 - share)
    fill_shift_keys(
        CurrentPose(now.key[begun:], now.speed[begun:]),
        StepFootprints(
            footprints.on_right[begun:],
            footprints.lifted[begun:],
            footprints.standing[begun:],
            footprints.landing[begun:],
            footprints.leg_m[begun:],
        ),
        hips[begun:],
        keys[begun:],
    )
    placement = Placement(
        footprints.on_right,
        footprints.standing,
        footprints.landing,
        lift,
        flight,
        keys,
        footprints.leg_m,
    )
    let_legs_reach(placement, keys)
    walkers.lifted[at] = footprints.lifted
    start = np.full(count, tick)
    return at, Steps(
        footprints.on_right,
        triggered.re_aimed,
        start,
        triggered.ticks,
        footprints.standing,
        footprints.landing,
        lift,
        flight,
        keys,
    )


@kernel
def courses_are_finite(headings: Floats, ahead: Floats) -> bool:
    """Whether headings (N,) and courses (N, AHEAD, 3) hold finite numbers only."""
    for i in range(len(headings)):
        total = headings[i]
        for k in range(ahead.shape[1]):
            for d in range(ahead.shape[2]):
                total += ahead[i, k, d] * 0.0
        if not math.isfinite(total):
            return False
    return True


@kernel
def find_lost(steps: Steps, slots: Ints, ahead: Floats, jump_m: float) -> Ints:
    """Rows (L,) of those of N walkers whose body is so far from both its feet along any axis.

    While a body runs, the foot that it stands on is left far behind at the end of a step.
    """
    lost = np.empty(len(slots), np.int64)
    count = 0
    for i in range(len(slots)):
        for d in range(3):
            from_standing = abs(ahead[i, 0, d] - steps.standing[slots[i], d])
            from_landing = abs(ahead[i, 0, d] - steps.landing[slots[i], d])
            if min(from_standing, from_landing) > jump_m:
                lost[count] = i
                count += 1
                break
    return lost[:count]
