"""One call receives what has come at many sockets, and reads the movements in it."""

import select
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.protocol import ClientCode
from esplanade.protocol.messages import Move
from esplanade.server.net.compiled._socket_kernels import (
    Chunks,
    Fields,
    Purses,
    Tally,
    receive_all,
)
from esplanade.server.net.sockets.system import ENTRY_AT, ENTRY_BYTES

MOST: Final = 256
"""Sockets that are read in one call."""
CHUNK_BYTES: Final = 1024
"""A chunk that is longer is nobody's movements, and comes in pieces of this size."""

_FIELDS: Final = Fields(
    int(ClientCode.MOVE),
    *(np.frombuffer(name.encode(), np.uint8).copy() for name in Move.model_fields),
)


class Receiving:
    """The sockets of an epoll, what has come at them in the latest call, and what waits of it."""

    def __init__(self, epoll: select.epoll) -> None:
        self._epoll = epoll
        self.purses = _purses(1024)
        self._chunks = Chunks(
            np.empty(MOST * ENTRY_BYTES, dtype=np.uint8),
            np.empty((MOST, CHUNK_BYTES), dtype=np.uint8),
            np.empty(MOST, dtype=np.int64),
            np.empty(MOST, dtype=np.int64),
        )

    def pay(self, descriptor: int, frames: int) -> None:
        """Set how many frames of a descriptor are paid for."""
        while descriptor >= len(self.purses.frames):
            more = _purses(len(self.purses.frames))
            self.purses = _joined(self.purses, more)
        self.purses.frames[descriptor] = frames

    def waiting(self) -> NDArray[np.int64]:
        """The descriptors of which a movement waits, int (N,)."""
        return np.flatnonzero(self.purses.waits)

    def receive(self) -> Tally:
        """Receive a chunk from every socket at which any has come, from so many at most."""
        descriptor = self._epoll.fileno()
        return receive_all(descriptor, ENTRY_BYTES, ENTRY_AT, self.purses, _FIELDS, self._chunks)

    def others(self, number: int) -> list[tuple[int, bytes]]:
        """The descriptors and chunks of the latest call that are for others to read: so many."""
        chunks = self._chunks
        return [
            (int(chunks.descriptors[k]), chunks.room[k, : chunks.sizes[k]].tobytes())
            for k in range(number)
        ]


def _purses(number: int) -> Purses:
    """Empty purses of so many descriptors."""
    return Purses(
        np.zeros(number, dtype=np.int64),
        np.zeros(number, dtype=np.uint8),
        np.zeros(number, dtype=np.int64),
        np.zeros(number),
        np.zeros(number),
    )


def _joined(purses: Purses, more: Purses) -> Purses:
    """Purses, and more of them behind."""
    return Purses(
        np.concatenate([purses.frames, more.frames]),
        np.concatenate([purses.waits, more.waits]),
        np.concatenate([purses.numbers, more.numbers]),
        np.concatenate([purses.directions_rad, more.directions_rad]),
        np.concatenate([purses.speeds_mps, more.speeds_mps]),
    )
