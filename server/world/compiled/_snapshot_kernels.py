"""Kernels choose the records and steps that each viewer is due, and gather their bytes."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.server.world.compiled._interest_kernels import (
    NEVER,
    NOT_NEAR,
    RECORD_UNDER_WAY,
    STEP_UNDER_WAY,
    Views,
)

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]
Ticks = NDArray[np.int32]


class Changes(NamedTuple):
    """The ticks of what is newest of everyone, int32 (R,) by the avatar's row; 0 for none."""

    changed: Ticks
    """The latest record."""
    urgent: Ticks
    """The latest record that is to be told at once: a start, a halt, another storey or reason."""
    begun: Ticks
    """The latest step."""
    over: Ticks
    """The end of the latest step."""


class Budget(NamedTuple):
    """Bytes that a viewer may be sent, and the ticks between records of one avatar."""

    refill: int
    """Bytes that are added in each tick."""
    most: int
    """Bytes of credit at most."""
    record: int
    """Bytes of a record."""
    step: int
    """Bytes of a step."""
    snapshot_head: int
    """Bytes of a snapshot without records."""
    steps_head: int
    """Bytes of a message of steps without any."""
    near: int
    """Records of avatars up to this rank are sent in every tick."""
    far_ticks: int
    """Ticks between records of the others."""
    stepping_ticks: int
    """Ticks between records of an avatar whose steps say where it is."""
    calm_ticks: int
    """Ticks without shortage after which steps of more avatars are tried."""
    settling_ticks: int
    """Ticks until the steps of fewer avatars are sent for certain."""


@inlined
def record_due(changes: Changes, budget: Budget, tick: int, views: Views, v: int, c: int) -> bool:
    """Whether the record of the avatar in column `c` of a view is to be sent in this tick."""
    row = views.rows[v, c]
    sent = views.record_sent[v, c]
    if changes.changed[row] <= sent:
        return False
    if sent == NEVER or changes.urgent[row] > sent:
        return True
    begun = changes.begun[row]
    walks_by_steps = views.step_sent[v, c] >= begun > NEVER and tick <= changes.over[row]
    if c < budget.near and not walks_by_steps:
        return True
    period = budget.stepping_ticks if walks_by_steps else budget.far_ticks
    return bool(tick - sent >= period)


@inlined
def step_due(begun: int, sent: int) -> bool:
    """Whether the latest step of an avatar in view is to be sent."""
    return sent != NOT_NEAR and begun > sent


@kernel
def choose(
    views: Views, viewers: Ints, changes: Changes, budget: Budget, tick: int, counts: Ints
) -> None:
    """Mark what each of `viewers`, int64 (N,), is to be sent in this tick.

    Its own record and step always are; then, as far as its credit goes, steps of the nearest
    first, records of the near, and records of the others in turn. All that waits stays due.
    `counts`, int64 (N, 2), takes the numbers of records and of steps.
    """
    for i in range(len(viewers)):
        v = viewers[i]
        seen = views.seen[v]
        credit = min(views.credit[v] + budget.refill, budget.most)
        full = credit == budget.most
        credit -= budget.snapshot_head
        records, steps, short = 0, 0, False
        for c in range(seen):
            row = views.rows[v, c]
            own = row == views.avatar[v]
            views.under_way[v, c] = RECORD_UNDER_WAY if own else 0
            if own:
                records += 1
                credit -= budget.record
            if step_due(changes.begun[row], views.step_sent[v, c]):
                cost = budget.step if steps else budget.step + budget.steps_head
                if own or credit >= cost:
                    views.under_way[v, c] |= STEP_UNDER_WAY
                    steps += 1
                    credit -= cost
                else:
                    short = True
        near = min(budget.near, seen)
        turn = views.turn[v]
        if turn < near or turn >= seen:
            turn = near
        next_turn = near
        for k in range(seen):
            c = k if k < near else k - near + turn
            if c >= seen:
                c -= seen - near
            if views.under_way[v, c] & RECORD_UNDER_WAY:
                continue
            if record_due(changes, budget, tick, views, v, c):
                if credit < budget.record:
                    short = True
                    next_turn = max(c, near)
                    break
                views.under_way[v, c] |= RECORD_UNDER_WAY
                records += 1
                credit -= budget.record
        views.turn[v] = next_turn
        views.credit[v] = credit
        views.encoded[v] = tick
        adapt(views, v, short, full, budget)
        counts[i, 0], counts[i, 1] = records, steps


@inlined
def adapt(views: Views, v: int, short: bool, full: bool, budget: Budget) -> None:
    """Let steps reach less far when the budget is short, and further after a time of calm."""
    calm = views.calm[v] + 1
    if short and calm >= budget.settling_ticks:
        least = min(1, views.most[v])
        views.reach[v] = max(views.reach[v] - max(1, views.reach[v] // 8), least)
        calm = 0
    elif not short and full and calm >= budget.calm_ticks:
        views.reach[v] = min(views.reach[v] + max(1, views.reach[v] // 8), views.most[v])
        calm = 0
    views.calm[v] = calm


@inlined
def copy(source: Bytes, target: Bytes) -> None:
    """Copy bytes. So simple a loop becomes a block copy, ten times as fast as an assignment."""
    for k in range(len(target)):
        target[k] = source[k]


@kernel
def gather(
    views: Views,
    viewers: Ints,
    records: Bytes,
    steps: Bytes,
    record_block: Bytes,
    step_block: Bytes,
) -> None:
    """Copy what was chosen, viewer by viewer, into two blocks of rows.

    `records` and `steps` are uint8 (R, bytes of one), the blocks (sum of counts, bytes of one).
    """
    r, s = 0, 0
    for i in range(len(viewers)):
        v = viewers[i]
        for c in range(views.seen[v]):
            row, marks = views.rows[v, c], views.under_way[v, c]
            if marks & RECORD_UNDER_WAY:
                copy(records[row], record_block[r])
                r += 1
            if marks & STEP_UNDER_WAY:
                copy(steps[row], step_block[s])
                s += 1
