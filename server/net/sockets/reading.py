"""Receives for all clients at once, and reads their movements in a kernel.

A connection comes here when a movement of it was taken that nothing else waited before. From then
on its transport pauses, and its socket stands in an epoll of ours. A chunk that is nothing but
whole movements is taken here. Any other chunk sends the connection back to its transport, and is
given to it just as the transport itself would have done: so all limits, faults and orders are those
of the usual path. Ends and errors are not even read here.

Frames are charged before they are read: a connection pays for some in advance, and whoever cannot
goes back too. A connection that was cut off goes out of the epoll with its descriptor, which
nobody reads between a look at the epoll and the bytes that are received of it.

The event loop looks at the epoll. After something came it rests for a moment and then takes at once
what came meanwhile, as network cards do. Every tick begins with a look.
"""

import asyncio
import select
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Final, Protocol

import numpy as np
import structlog
from numpy.typing import NDArray

from esplanade.server.metrics import Traffic
from esplanade.server.net.compiled._movement_kernels import HEAD_BYTES, LONGEST
from esplanade.server.net.sockets.receiving import MOST, Receiving
from esplanade.server.net.sockets.system import AVAILABLE, NONE

log = structlog.get_logger(__name__)

REST_EACH_S: Final = 20e-6
MOST_REST_S: Final = 0.01
"""After something came, nobody looks for so long for each connection, and for no longer."""
PAID: Final = 8
"""Frames that a connection pays for in advance. They come on top of what it may send at once."""
LOW: Final = 3
"""It pays for more when it has fewer left."""
FRAME_BYTES: Final = HEAD_BYTES + LONGEST
"""The most bytes of a frame that is paid for here."""


class Source(Protocol):
    """A connection whose socket can be read here."""

    heard: bool
    descriptor: int
    transport: asyncio.Transport

    def prepay(self, frames: int, now: float) -> bool:
        """Charge frames of `FRAME_BYTES` that are to come; whether there was credit for them."""

    def pay_back(self, frames: int, now: float) -> None:
        """Give the credit back for frames that have not come."""

    def data_received(self, data: bytes) -> None:
        """Take what came at the socket."""


Take = Callable[[Sequence[int], Sequence[int], Sequence[float], Sequence[float]], None]
"""Takes ids of avatars, numbers of movements, directions and speeds."""


class Reading:
    """The sockets that are read at once, by their descriptors."""

    def __init__(self, take: Take, traffic: Traffic) -> None:
        self._take = take
        self._traffic = traffic
        self._loop = asyncio.get_running_loop()
        self._epoll = select.epoll()
        self._receiving = Receiving(self._epoll)
        self._sources: dict[int, Source] = {}
        self._avatars: dict[int, int] = {}
        self._rest: asyncio.TimerHandle | None = None
        self._loop.add_reader(self._epoll.fileno(), self._wake)

    def __contains__(self, source: Source) -> bool:
        return self._sources.get(source.descriptor) is source

    def __len__(self) -> int:
        return len(self._sources)

    def close(self) -> None:
        """Let every connection go back to its transport."""
        for source in list(self._sources.values()):
            self.leave(source)
        if self._rest is None:
            self._loop.remove_reader(self._epoll.fileno())
        else:
            self._rest.cancel()
        self._epoll.close()

    def enter(self, source: Source, avatar_id: int) -> None:
        """Read a connection's socket from now on, if it can be and pays; the avatar is its own.

        The last of what came must have ended where a frame ends, and nothing of it may wait.
        """
        descriptor = source.descriptor
        if descriptor == NONE or self._epoll.closed or source in self:
            return
        if not source.prepay(PAID, self._loop.time()):
            return
        source.transport.pause_reading()
        try:
            self._epoll.register(descriptor, select.EPOLLIN | select.EPOLLRDHUP)
        except OSError:
            log.exception("a socket cannot be polled")
            source.pay_back(PAID, self._loop.time())
            source.transport.resume_reading()
            return
        self._sources[descriptor], self._avatars[descriptor] = source, avatar_id
        self._receiving.pay(descriptor, PAID)

    def leave(self, source: Source) -> None:
        """Let a connection go back to its transport, if it is here."""
        if source not in self:
            return
        descriptor = source.descriptor
        del self._sources[descriptor]
        source.pay_back(int(self._receiving.purses[descriptor]), self._loop.time())
        self._receiving.pay(descriptor, 0)
        if not source.transport.is_closing():
            self._epoll.unregister(descriptor)
            source.transport.resume_reading()

    def poll(self) -> int:
        """Take everything that has come; returns from how many connections."""
        total = 0
        for _ in range(len(self._sources) // MOST + 1):
            found = self._receiving.receive()
            total += found
            if found:
                self._deliver(found)
            if found < MOST:
                break
        return total

    def _deliver(self, found: int) -> None:
        chunks = self._receiving.chunks
        counts = chunks.counts[:found]
        moved, others = np.flatnonzero(counts), np.flatnonzero(counts == 0)
        # Unusual chunks may end connections, or give descriptors away.
        descriptors = chunks.descriptors[others].tolist()
        unusual = [self._receiving.chunk(place) for place in others.tolist()]
        if len(moved):
            self._take_movements(moved)
        for descriptor, chunk in zip(descriptors, unusual, strict=True):
            self._hand_over(descriptor, chunk)

    def _take_movements(self, places: NDArray[np.int64]) -> None:
        chunks, traffic = self._receiving.chunks, self._traffic
        number = int(chunks.counts[places].sum())
        traffic.messages_in += number
        traffic.bytes_in += int(chunks.sizes[places].sum()) - HEAD_BYTES * number
        traffic.movements_superseded += number - len(places)
        moved = chunks.descriptors[places]
        descriptors = moved.tolist()
        for descriptor in descriptors:
            self._sources[descriptor].heard = True
        try:
            self._take(
                [self._avatars[descriptor] for descriptor in descriptors],
                chunks.numbers[places].tolist(),
                chunks.directions_rad[places].tolist(),
                chunks.speeds_mps[places].tolist(),
            )
        except Exception:
            # A tick begins with this: the world goes on without these movements.
            log.exception("movements failed", number=number)
        now, purses = self._loop.time(), self._receiving.purses
        for descriptor in moved[purses[moved] < LOW].tolist():
            source = self._sources[descriptor]
            if source.prepay(PAID - int(purses[descriptor]), now):
                self._receiving.pay(descriptor, PAID)
            else:
                self.leave(source)

    def _hand_over(self, descriptor: int, chunk: bytes) -> None:
        """Let a connection go, and take a chunk in its own way."""
        source = self._sources.get(descriptor)
        if source is None:
            # Its transport is closing, and has not closed its socket yet.
            with suppress(OSError):
                self._epoll.unregister(descriptor)
            return
        self.leave(source)
        if not chunk or source.transport.is_closing():
            return
        try:
            source.data_received(chunk)
        except Exception:
            # As a transport does: one connection ends, and the others go on.
            log.exception("connection failed")
            source.transport.abort()

    def _wake(self) -> None:
        """Something came after a while in which nothing did."""
        self._loop.remove_reader(self._epoll.fileno())
        self._go_on()

    def _go_on(self) -> None:
        if self.poll():
            rest_s = min(MOST_REST_S, REST_EACH_S * len(self._sources))
            self._rest = self._loop.call_later(rest_s, self._go_on)
        else:
            self._rest = None
            self._loop.add_reader(self._epoll.fileno(), self._wake)


@contextmanager
def reading(take: Take, traffic: Traffic) -> Iterator[Reading | None]:
    """Sockets that are read at once, where the system lets us."""
    if not AVAILABLE:
        yield None
        return
    made = Reading(take, traffic)
    try:
        yield made
    finally:
        made.close()
