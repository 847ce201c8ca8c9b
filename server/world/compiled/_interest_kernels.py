"""The view of each viewer is a row of a table; kernels bring it up to date."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.server.world.compiled._bucket_kernels import ORDER_BITS, Buckets, find_nearest

Ints = NDArray[np.int64]
Ticks = NDArray[np.int32]

NOT_NEAR = -1
"""In place of a tick: the steps of this avatar are not sent."""
NEVER = 0
"""In place of a tick: nothing was sent yet."""
RECORD_UNDER_WAY = 1
STEP_UNDER_WAY = 2


class Views(NamedTuple):
    """Rows by viewer, V of them; C columns are the avatars in view, the nearest first.

    Columns from `seen[v]` on are unused.
    """

    avatar: Ints
    """(V,): the row of the avatar through whose eyes the viewer looks; 0 where there is none."""
    seen: Ticks
    """(V,): the number of avatars in view."""
    encoded: Ticks
    """(V,): the tick for which the viewer's snapshot was encoded last."""
    written: Ticks
    """(V,): the tick of the snapshot that the viewer was sent last."""
    ack: Ints
    """(V,): the latest movement that the viewer's avatar has begun."""
    rows: Ticks
    """(V, C): the avatars in view."""
    record_sent: Ticks
    """(V, C): the tick of the record of this avatar that was sent last."""
    step_sent: Ticks
    """(V, C): the tick of the step of this avatar that was sent last, or `NOT_NEAR`."""
    under_way: NDArray[np.uint8]
    """(V, C): the record, the step of this avatar are in the snapshot encoded last."""
    credit: Ticks
    """(V,): bytes that the viewer may be sent now; see `esplanade.server.world.byte_budget`."""
    reach: Ticks
    """(V,): steps are sent of avatars up to this rank, as the budget allows."""
    most: Ticks
    """(V,): the highest rank that `reach` may become; 0 for a viewer who wants no steps."""
    calm: Ticks
    """(V,): ticks since something that was due had to wait for the budget."""
    turn: Ticks
    """(V,): the column at which records of far avatars go on, as they take turns."""


class Limits(NamedTuple):
    """Distances in cm, and ranks: 1 is the viewer itself."""

    enter: float
    leave: float
    enter_rank: int
    step_enter: float
    step_leave: float


@inlined
def settle(views: Views, v: int) -> None:
    """Take down as sent what was in the last snapshot, if that was written."""
    if views.encoded[v] == views.written[v]:
        for c in range(views.seen[v]):
            if views.under_way[v, c] & RECORD_UNDER_WAY:
                views.record_sent[v, c] = views.encoded[v]
            if views.under_way[v, c] & STEP_UNDER_WAY:
                views.step_sent[v, c] = views.encoded[v]
    for c in range(views.seen[v]):
        views.under_way[v, c] = 0


@kernel
def settle_all(views: Views) -> None:
    """Take down as sent, for every viewer, what was in a snapshot that was written."""
    for v in range(len(views.avatar)):
        if views.avatar[v]:
            settle(views, v)


@kernel
def drop_gone(views: Views, gone: NDArray[np.bool_], left: Ints) -> int:
    """Take the avatars that are `gone`, (R,), out of every view.

    `left` int64 (E, 2) takes the pairs of viewer and row that were; returns their number.
    """
    events = 0
    for v in range(len(views.avatar)):
        if not views.avatar[v]:
            continue
        kept = 0
        for c in range(views.seen[v]):
            row = views.rows[v, c]
            if gone[row]:
                left[events, 0], left[events, 1] = v, row
                events += 1
                continue
            views.rows[v, kept] = row
            views.record_sent[v, kept] = views.record_sent[v, c]
            views.step_sent[v, kept] = views.step_sent[v, c]
            views.under_way[v, kept] = views.under_way[v, c]
            kept += 1
        views.seen[v] = kept
    return events


@kernel
def look(
    views: Views,
    due: Ints,
    buckets: Buckets,
    limits: Limits,
    entered: Ints,
    left: Ints,
    ends: Ints,
) -> None:
    """Look anew for the viewers `due`, int64 (D,).

    For the i-th of them, `entered` and `left`, int64 (D, C), take in row i the rows of avatars
    that came into view and went out of it, and `ends`, int64 (D, 2), how many.
    """
    columns = views.rows.shape[1]
    keys = np.empty(len(buckets.in_order), np.int64)
    # By avatar's row, the column in which it was until now, and 1 more; 0 for none.
    was = np.zeros(len(buckets.places), np.int32)
    rows = np.empty(columns, np.int32)
    record_sent, step_sent = np.empty(columns, np.int32), np.empty(columns, np.int32)
    for i in range(len(due)):
        v = due[i]
        me = views.avatar[v]
        found = find_nearest(buckets, me, columns, limits.leave, keys)
        for c in range(views.seen[v]):
            was[views.rows[v, c]] = c + 1
        met_myself = False
        kept, came, went = 0, 0, 0
        for k in range(found):
            row = buckets.in_order[keys[k] & ((1 << ORDER_BITS) - 1)]
            apart2 = keys[k] >> ORDER_BITS
            met_myself |= row == me
            if k == columns - 1 and not met_myself:
                # Many avatars stand on one spot, and the viewer is not among its own nearest.
                row, apart2 = me, 0
            in_view = apart2 <= limits.enter * limits.enter and k < limits.enter_rank
            before = was[row]
            if not (before or in_view or row == me):
                continue
            rows[kept] = row
            record_sent[kept], step_sent[kept] = NEVER, NOT_NEAR
            if before:
                record_sent[kept] = views.record_sent[v, before - 1]
                step_sent[kept] = views.step_sent[v, before - 1]
                was[row] = 0
            else:
                entered[i, came] = row
                came += 1
            reach = views.reach[v]
            was_near = step_sent[kept] != NOT_NEAR
            near = is_near(apart2, kept + 1, was_near, reach, limits)
            if near or (row == me and reach > 0):
                step_sent[kept] = max(step_sent[kept], NEVER)
            else:
                step_sent[kept] = NOT_NEAR
            kept += 1
        for c in range(views.seen[v]):
            row = views.rows[v, c]
            if was[row]:
                was[row] = 0
                left[i, went] = row
                went += 1
        views.rows[v, :kept] = rows[:kept]
        views.record_sent[v, :kept] = record_sent[:kept]
        views.step_sent[v, :kept] = step_sent[:kept]
        views.seen[v] = kept
        ends[i, 0], ends[i, 1] = came, went


@inlined
def is_near(apart2: int, rank: int, was_near: bool, reach: int, limits: Limits) -> bool:
    """Whether the steps of an avatar at this squared distance, cm2, are sent.

    Ranks beyond `reach` would cost more than the viewer's budget; the last eighth is for those who
    are near already.
    """
    if was_near:
        apart, last = limits.step_leave, reach
    else:
        apart, last = limits.step_enter, reach - reach // 8
    return apart2 <= apart * apart and rank <= last
