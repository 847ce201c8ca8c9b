"""Which records and steps each viewer is due, and their bytes one after the other."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.server.world.compiled._interest_kernels import (
    NOT_NEAR,
    RECORD_UNDER_WAY,
    STEP_UNDER_WAY,
    Views,
)

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]
Ticks = NDArray[np.int32]


@inlined
def record_due(changed: int, sent: int) -> bool:
    """Whether the record of an avatar in view is to be in this tick's snapshot.

    `changed` is the tick of the record, `sent` that of the one that the viewer has.
    """
    return changed > sent


@inlined
def step_due(begun: int, sent: int) -> bool:
    """Whether the latest step of an avatar in view is to be sent in this tick."""
    return sent != NOT_NEAR and begun > sent


@kernel
def choose(
    views: Views, viewers: Ints, changed: Ticks, begun: Ticks, tick: int, counts: Ints
) -> None:
    """Mark what each of `viewers`, int64 (N,), is to be sent; its own record always is.

    `changed` and `begun` (R,) are the ticks of everyone's latest record and step. `counts`, int64
    (N, 2), takes the numbers of records and of steps.
    """
    for i in range(len(viewers)):
        v = viewers[i]
        records, steps = 0, 0
        for c in range(views.seen[v]):
            row = views.rows[v, c]
            marks = 0
            if row == views.avatar[v] or record_due(changed[row], views.record_sent[v, c]):
                marks |= RECORD_UNDER_WAY
                records += 1
            if step_due(begun[row], views.step_sent[v, c]):
                marks |= STEP_UNDER_WAY
                steps += 1
            views.under_way[v, c] = marks
        views.encoded[v] = tick
        counts[i, 0], counts[i, 1] = records, steps


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
