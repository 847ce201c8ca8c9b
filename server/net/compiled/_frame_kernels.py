"""Snapshots and steps of all viewers as WebSocket frames, in one array."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.server.world.compiled._snapshot_kernels import copy

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]

FINAL_BINARY = 0x82
LONG_PAYLOAD = 126
"""From this many bytes on, the length of a payload takes two bytes behind this mark."""


@inlined
def framed_size(payload: int) -> int:
    """Bytes of a frame with a payload of less than 65536 bytes."""
    return payload + (2 if payload < LONG_PAYLOAD else 4)


@inlined
def put_head(out: Bytes, at: int, payload: int, head: Bytes) -> int:
    """Write the head of a frame, and of the message in it; returns where they end."""
    out[at] = FINAL_BINARY
    if payload < LONG_PAYLOAD:
        out[at + 1] = payload
        at += 2
    else:
        out[at + 1] = LONG_PAYLOAD
        out[at + 2], out[at + 3] = payload >> 8, payload & 0xFF
        at += 4
    for k in range(len(head)):
        out[at + k] = head[k]
    return at + len(head)


@inlined
def put_number(out: Bytes, at: int, value: int, size: int) -> None:
    """Write a big-endian number of so many bytes."""
    for k in range(size):
        out[at + k] = (value >> (8 * (size - 1 - k))) & 0xFF


@kernel
def measure(
    record_ends: Ints,
    step_ends: Ints,
    record_bytes: int,
    step_bytes: int,
    snapshot_head: int,
    steps_head: int,
    ends: Ints,
) -> None:
    """Write where the frames of each viewer end, (V,): of its steps, if any, and its snapshot."""
    at = 0
    for i in range(len(ends)):
        records = record_ends[i] - (record_ends[i - 1] if i else 0)
        steps = step_ends[i] - (step_ends[i - 1] if i else 0)
        if steps:
            at += framed_size(steps_head + steps * step_bytes)
        at += framed_size(snapshot_head + records * record_bytes)
        ends[i] = at


@kernel
def pack(
    record_ends: Ints,
    step_ends: Ints,
    records: Bytes,
    steps: Bytes,
    record_bytes: int,
    step_bytes: int,
    acks: Ints,
    snapshot_head: Bytes,
    steps_head: Bytes,
    ack_at: int,
    out: Bytes,
) -> None:
    """Write the frames of all viewers, one after the other.

    `snapshot_head` and `steps_head` are the heads of the messages of this tick up to and including
    the length of the block, their last two bytes; `ack_at` is where the ack stands, four bytes.
    """
    at, first_record, first_step = 0, 0, 0
    for i in range(len(acks)):
        if step_ends[i] > first_step:
            size = (step_ends[i] - first_step) * step_bytes
            at = put_head(out, at, len(steps_head) + size, steps_head)
            put_number(out, at - 2, size, 2)
            begin = first_step * step_bytes
            copy(steps[begin : begin + size], out[at : at + size])
            at += size
        size = (record_ends[i] - first_record) * record_bytes
        at = put_head(out, at, len(snapshot_head) + size, snapshot_head)
        put_number(out, at - len(snapshot_head) + ack_at, acks[i], 4)
        put_number(out, at - 2, size, 2)
        begin = first_record * record_bytes
        copy(records[begin : begin + size], out[at : at + size])
        at += size
        first_record, first_step = record_ends[i], step_ends[i]
