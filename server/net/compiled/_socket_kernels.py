"""Calls of the system for many sockets in a row, on 64-bit Linux: no interpreter between them.

Every socket is one that does not block. No call here opens or closes anything, so that a
descriptor that was open before a kernel is the same one until its end.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel
from esplanade.server.net.compiled._movement_kernels import movements

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]
Floats = NDArray[np.float64]

QUIETLY = 0x4040
"""MSG_DONTWAIT and MSG_NOSIGNAL."""
READABLE = 0x1
"""EPOLLIN."""
MESSAGE_WORDS = 11
"""Words of a `struct msghdr` and of the two pieces that it points to."""

Call = Callable[..., int]
_int, _word, _size = types.intc, types.uintp, types.intp
send: Call = types.ExternalFunction("send", _size(_int, _word, _word, _int))
sendmsg: Call = types.ExternalFunction("sendmsg", _size(_int, _word, _int))
recv: Call = types.ExternalFunction("recv", _size(_int, _word, _word, _int))
epoll_wait: Call = types.ExternalFunction("epoll_wait", _int(_int, _word, _int, _int))


class Fields(NamedTuple):
    """The code of a movement, and the names of its fields."""

    code: int
    seq: Bytes
    direction: Bytes
    speed: Bytes


class Purses(NamedTuple):
    """For each descriptor, the frames that are paid for and the latest movement, if one waits."""

    frames: Ints
    waits: Bytes
    numbers: Ints
    directions_rad: Floats
    speeds_mps: Floats


class Chunks(NamedTuple):
    """Chunks of one call that are for others to read, of M sockets at most."""

    entries: Bytes
    """As the system tells which sockets have any."""
    room: Bytes
    """(M, B)"""
    descriptors: Ints
    sizes: Ints
    """Bytes of each chunk in `room`."""


class Tally(NamedTuple):
    """The figures of one call."""

    found: int
    """Sockets at which anything had come."""
    others: int
    """Chunks that are for others to read."""
    movements: int
    movement_bytes: int
    """Bytes of the frames of these movements."""
    superseded: int
    """Movements that later ones have replaced."""


@kernel
def send_all(
    descriptors: Ints,
    block: Bytes,
    begins: Ints,
    ends: Ints,
    first: Bytes,
    first_begins: Ints,
    first_ends: Ints,
    sent: Ints,
) -> None:
    """Send to each descriptor (N,) its part of `first` and then its part of the block.

    `sent` gets the number of bytes that the system took; less than 0 for a fault.
    """
    message = np.zeros(MESSAGE_WORDS, dtype=np.int64)
    message[2], message[3] = message.ctypes.data + 56, 2
    for i in range(len(descriptors)):
        head, body = first_ends[i] - first_begins[i], ends[i] - begins[i]
        start = block.ctypes.data + begins[i]
        if head == 0:
            sent[i] = send(
                np.int32(descriptors[i]), np.uintp(start), np.uintp(body), np.int32(QUIETLY)
            )
        else:
            message[7], message[8] = first.ctypes.data + first_begins[i], head
            message[9], message[10] = start, body
            sent[i] = sendmsg(
                np.int32(descriptors[i]), np.uintp(message.ctypes.data), np.int32(QUIETLY)
            )


@kernel
def receive_all(
    poll: int, entry_bytes: int, entry_at: int, purses: Purses, fields: Fields, chunks: Chunks
) -> Tally:
    """Receive what has come at the sockets of an epoll, a chunk of each at most.

    Entries of the epoll take so many bytes each, with the descriptor at `entry_at`. A chunk that is
    nothing but movements is taken, if the purse of its descriptor has so many frames. Any other
    one is left in `chunks`; it is empty where the connection has ended or failed.
    """
    most, chunk_bytes = chunks.room.shape
    found = int(
        epoll_wait(
            np.int32(poll), np.uintp(chunks.entries.ctypes.data), np.int32(most), np.int32(0)
        )
    )
    others = total = total_bytes = superseded = 0
    for i in range(found):
        at = i * entry_bytes
        happened = np.int64(chunks.entries[at]) | np.int64(chunks.entries[at + 1]) << 8
        descriptor = np.int64(0)
        for k in range(4):
            descriptor |= np.int64(chunks.entries[at + entry_at + k]) << (8 * k)
        chunk = chunks.room[others]
        size = 0
        if happened == READABLE:
            size = recv(
                np.int32(descriptor),
                np.uintp(chunk.ctypes.data),
                np.uintp(chunk_bytes),
                np.int32(QUIETLY),
            )
        if 0 < size < chunk_bytes:
            count, number, direction_rad, speed_mps = movements(
                chunk[:size], fields.code, fields.seq, fields.direction, fields.speed
            )
            if 0 < count <= purses.frames[descriptor]:
                purses.frames[descriptor] -= count
                total += count
                total_bytes += size
                superseded += count - 1 + purses.waits[descriptor]
                purses.waits[descriptor] = 1
                purses.numbers[descriptor] = number
                purses.directions_rad[descriptor] = direction_rad
                purses.speeds_mps[descriptor] = speed_mps
                continue
        chunks.descriptors[others], chunks.sizes[others] = descriptor, max(size, 0)
        others += 1
    return Tally(max(found, 0), others, total, total_bytes, superseded)
