"""Receives for all clients at once, and reads their movements in a kernel.

A connection comes here when a movement of it was taken that nothing else waited before. From then
on its transport pauses, and its socket stands in an epoll of ours. A chunk that is nothing but
whole movements is taken here; the latest of each connection waits until the next tick asks for it.
Any other chunk sends the connection back to its transport, behind the movement that waits, and is
given to it just as the transport itself would have done: so all limits, faults and orders are those
of the usual path. Ends and errors are not even read here.

Frames are charged before they are read: a connection pays for some in advance, and whoever cannot
goes back too. A connection that was cut off goes out of the epoll with its descriptor, which
nobody reads between a look at the epoll and the bytes that are received of it.

The event loop looks at the epoll. After something came it rests for a moment and then takes at once
what came meanwhile, as network cards do. Every tick begins with a look. The epoll tells of a socket
once for all that has come: whatever is not read of it sends the connection back.
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
_EVENTS: Final = select.EPOLLIN | select.EPOLLRDHUP | select.EPOLLET
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
        self._heard: set[int] = set()
        """Descriptors of those of whom movements were taken since this was last told to them."""
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
            self._epoll.register(descriptor, _EVENTS)
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
        if self._receiving.purses.waits[descriptor]:
            self._take_movements(np.array([descriptor]))
        if descriptor in self._heard:
            self._heard.remove(descriptor)
            source.heard = True
        del self._sources[descriptor]
        source.pay_back(int(self._receiving.purses.frames[descriptor]), self._loop.time())
        self._receiving.pay(descriptor, 0)
        if not source.transport.is_closing():
            self._epoll.unregister(descriptor)
            source.transport.resume_reading()

    def poll(self) -> int:
        """Take everything that has come; returns from how many connections. Movements wait."""
        total = 0
        for _ in range(len(self._sources) // MOST + 1):
            tally = self._receiving.receive()
            total += tally.found
            if tally.movements:
                self._traffic.messages_in += tally.movements
                self._traffic.bytes_in += tally.movement_bytes - HEAD_BYTES * tally.movements
                self._traffic.movements_superseded += tally.superseded
            # These may end connections, or give descriptors away.
            for descriptor, chunk in self._receiving.others(tally.others):
                self._hand_over(descriptor, chunk)
            if tally.found < MOST:
                break
        return total

    def deliver(self) -> None:
        """Take everything that has come, and hand on the movements that wait."""
        self.poll()
        moved = self._receiving.waiting()
        if not len(moved):
            return
        self._take_movements(moved)
        now, frames = self._loop.time(), self._receiving.purses.frames
        for descriptor in moved[frames[moved] < LOW].tolist():
            source = self._sources[descriptor]
            if source.prepay(PAID - int(frames[descriptor]), now):
                self._receiving.pay(descriptor, PAID)
            else:
                self.leave(source)

    def tell_heard(self) -> None:
        """Let the connections know of which anything was taken here since the last call."""
        for descriptor in self._heard:
            self._sources[descriptor].heard = True
        self._heard.clear()

    def waiting(self) -> list[int]:
        """The avatars of which a movement waits."""
        return [self._avatars[descriptor] for descriptor in self._receiving.waiting().tolist()]

    def _take_movements(self, moved: NDArray[np.int64]) -> None:
        """Hand on the movements that wait of these descriptors."""
        descriptors = moved.tolist()
        self._heard.update(descriptors)
        purses = self._receiving.purses
        purses.waits[moved] = False
        try:
            self._take(
                [self._avatars[descriptor] for descriptor in descriptors],
                purses.numbers[moved].tolist(),
                purses.directions_rad[moved].tolist(),
                purses.speeds_mps[moved].tolist(),
            )
        except Exception:
            # A tick begins with this: the world goes on without these movements.
            log.exception("movements failed", number=len(descriptors))

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
