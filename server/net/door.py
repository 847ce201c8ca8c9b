"""The door accepts connections: each is counted before anything is spent on it.

A server of the event loop makes a transport and a protocol for every connection before anybody
can ask where it comes from, and knows nothing of those whose TLS handshake is not done. Here an
address is known as soon as the kernel hands the connection over. One that is refused costs two
system calls, and one round of the event loop takes in a few only, however many wait.
"""

import asyncio
import socket
from collections.abc import Callable
from contextlib import suppress
from typing import Final

import structlog

from esplanade.server.net.connections import Connections, Place
from esplanade.server.net.tls import HANDSHAKE_S, Tls

log = structlog.get_logger(__name__)

BACKLOG: Final = 1024
"""Connections that wait in the kernel to be accepted."""

MOST_AT_ONCE: Final = 16
"""Connections that are accepted in one round of the event loop."""

EXHAUSTED_PAUSE_S: Final = 0.2
"""The door rests for this long when the process has no descriptor left."""


class Door:
    """Accepts at bound sockets; it has what the library asks of an `asyncio.Server`.

    `make` makes the protocol of a connection that has been given a place.

    Raises
    ------
    OSError
        Somebody else listens there since the sockets were bound.
    """

    def __init__(
        self,
        sockets: list[socket.socket],
        connections: Connections,
        make: Callable[[Place], asyncio.Protocol],
        tls: Tls | None = None,
    ) -> None:
        self._loop = asyncio.get_running_loop()
        self.sockets = tuple(sockets)
        self._connections = connections
        self._make = make
        self._tls = tls
        for each in sockets:
            each.listen(BACKLOG)
        self._opening: set[asyncio.Task[None]] = set()
        self._accepting = [self._loop.create_task(self._accept(each)) for each in sockets]

    def is_serving(self) -> bool:
        """Whether connections are accepted."""
        return bool(self._accepting)

    def get_loop(self) -> asyncio.AbstractEventLoop:
        return self._loop

    def close(self) -> None:
        """Accept nothing more; whoever is still in a TLS handshake is cut off."""
        for task in (*self._accepting, *self._opening):
            task.cancel()
        self._accepting = []

    async def wait_closed(self) -> None:
        """Wait until all connections are gone."""
        await self._connections.all_gone()
        for each in self.sockets:
            each.close()

    async def _accept(self, listening: socket.socket) -> None:
        while True:
            try:
                taken, peer = await self._loop.sock_accept(listening)
                self._take(taken, peer)
                for _ in range(MOST_AT_ONCE - 1):
                    taken, peer = listening.accept()
                    self._take(taken, peer)
            except (BlockingIOError, ConnectionAbortedError):
                pass
            except OSError:
                self._connections.no_descriptor()
                await asyncio.sleep(EXHAUSTED_PAUSE_S)
            except Exception:
                # Whatever is wrong with one connection, others are still accepted.
                log.exception("accepting failed")

    def _take(self, taken: socket.socket, peer: tuple[str, int]) -> None:
        place = None
        try:
            place = self._connections.enter(peer[0])
        finally:
            if place is None:
                taken.close()
        if place is None:
            return
        taken.setblocking(False)
        task = self._loop.create_task(self._open(taken, place))
        self._opening.add(task)
        task.add_done_callback(self._opening.discard)
        place.cut = task.cancel

    async def _open(self, taken: socket.socket, place: Place) -> None:
        try:
            await self._loop.connect_accepted_socket(
                lambda: self._make(place),
                taken,
                ssl=self._tls.context if self._tls else None,
                ssl_handshake_timeout=HANDSHAKE_S if self._tls else None,
            )
        except (OSError, asyncio.CancelledError):
            # The connection has been made in vain, or its TLS handshake has failed.
            with suppress(OSError):
                taken.close()
            place.leave()
