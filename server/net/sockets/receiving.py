"""One call receives what has come at many sockets, and reads the movements in it."""

import select
from typing import Final

import numpy as np

from esplanade.protocol import ClientCode
from esplanade.protocol.messages import Move
from esplanade.server.net.compiled._socket_kernels import Chunks, Fields, receive_all
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
    """The sockets of an epoll, and what has come at them in the latest call."""

    def __init__(self, epoll: select.epoll) -> None:
        self._epoll = epoll
        self.purses = np.zeros(1024, dtype=np.int64)
        """For each descriptor, the frames that are paid for."""
        whole, real = np.empty((4, MOST), dtype=np.int64), np.empty((2, MOST))
        self.chunks = Chunks(
            np.empty(MOST * ENTRY_BYTES, dtype=np.uint8),
            np.empty((MOST, CHUNK_BYTES), dtype=np.uint8),
            *whole,
            *real,
        )

    def pay(self, descriptor: int, frames: int) -> None:
        """Set how many frames of a descriptor are paid for."""
        while descriptor >= len(self.purses):
            self.purses = np.concatenate([self.purses, np.zeros_like(self.purses)])
        self.purses[descriptor] = frames

    def receive(self) -> int:
        """Receive a chunk from every socket at which any has come; returns from how many."""
        descriptor = self._epoll.fileno()
        found = receive_all(descriptor, ENTRY_BYTES, ENTRY_AT, self.purses, _FIELDS, self.chunks)
        return max(found, 0)

    def chunk(self, place: int) -> bytes:
        """The chunk at a place of the latest call."""
        return self.chunks.room[place, : self.chunks.sizes[place]].tobytes()
