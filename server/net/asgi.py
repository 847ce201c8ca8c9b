"""Serves an ASGI application on the event loop of this process, and bounds what a client takes.

uvicorn speaks HTTP and WebSocket. It leaves three things to its caller, which stand here: signals
belong to the process, the number of connections is bounded, and a client that does not go on with
its request, or does not read its answer, is cut off.

hypercorn was tried too: one client that did not read kept it from ending for more than 15 s, and it
offers no place where connections can be counted.
"""

import asyncio
import socket
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from typing import Any, Final

import h11
import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from esplanade.server.assets import SECURITY_HEADERS
from esplanade.server.net.connections import SHUT_S
from esplanade.server.net.lingering import LingeringTransport
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.tls import Tls

MAX_CONNECTIONS: Final = 64
"""Further connections are cut off as they come."""

MAX_HEAD_BYTES: Final = 16 * 1024
"""A request whose line and headers are longer is refused with 400."""

MAX_BODY_BYTES: Final = 64 * 1024
"""A request whose body is longer is refused with 413; a WebSocket message ends the connection."""

PATIENCE_S: Final = 30.0
"""A client is cut off when a request, or a pause in reading the answer, lasts longer than this."""

SOCKET_BUFFER_BYTES: Final = 64 * 1024
"""What the kernel may keep for a WebSocket whose client does not read; Linux doubles it."""

_AT_ONCE: Final = 16
"""Connections that are accepted before any is looked at; the event loop takes them in a row."""

_WAITING_FOR_REQUEST: Final = (h11.IDLE, h11.SEND_BODY)

_UNREAD: Final = (h11.SEND_BODY, h11.ERROR)


@asynccontextmanager
async def serving(app: Any, host: str, port: int, tls: Tls | None = None) -> AsyncIterator[int]:
    """Serve an ASGI application and yield the port; afterwards nobody is connected any more.

    Raises
    ------
    OSError
        The address cannot be had.
    """
    sockets = await bound_sockets(host, port)
    for each in sockets:
        each.listen()
    config = uvicorn.Config(
        app,
        http=_BoundedConnection,
        ws=_BoundedSocket,
        ws_max_size=MAX_BODY_BYTES,
        ws_per_message_deflate=False,
        h11_max_incomplete_event_size=MAX_HEAD_BYTES,
        lifespan="off",
        log_config=None,
        log_level="error",  # warnings tell of every request that a port scanner breaks off
        access_log=False,
        proxy_headers=False,
        server_header=False,
        headers=list(SECURITY_HEADERS.items()),
        backlog=_AT_ONCE,
        ssl_context_factory=None if tls is None else lambda *_: tls.always_newest(),
        timeout_graceful_shutdown=round(2 * SHUT_S),
    )
    server = _Server(config)
    running = asyncio.create_task(server.serve(sockets))
    try:
        # The sockets listen already: a client that comes before the server runs has to wait.
        yield sockets[0].getsockname()[1]
    finally:
        server.should_exit = True
        with suppress(TimeoutError):
            async with asyncio.timeout(SHUT_S):
                await asyncio.shield(running)
        for connection in list(server.server_state.connections):
            connection.transport.abort()
        await running


class _Server(uvicorn.Server):
    """The library's server without its signal handlers: the process has its own."""

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


class _BoundedConnection(H11Protocol):
    """A connection that is cut off when there are too many, or when its client does not go on."""

    _deadline: asyncio.TimerHandle | None = None
    _is_web_socket = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        self._lingering = LingeringTransport(transport, self.loop, self._is_unread)
        super().connection_made(self._lingering)  # type: ignore[arg-type]
        if len(self.connections) > MAX_CONNECTIONS:
            transport.abort()
        else:
            self._watch()

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self._lingering.forget()
        self._forget()

    def data_received(self, data: bytes) -> None:
        if self._lingering.drops(data):
            return
        super().data_received(data)
        self._watch()

    def _is_unread(self) -> bool:
        return self.conn.their_state in _UNREAD

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        # The library stops reading here, before the end of the request that it has read.
        self._is_web_socket = True
        super().handle_websocket_upgrade(event)

    def pause_writing(self) -> None:
        super().pause_writing()
        self._watch()

    def resume_writing(self) -> None:
        super().resume_writing()
        self._watch()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        self._watch()

    def _watch(self) -> None:
        """Start the time limit when it is the client's turn, and end it when it is ours.

        A WebSocket connection is watched by `_BoundedSocket` instead.
        """
        waiting = self.flow.write_paused or self.conn.their_state in _WAITING_FOR_REQUEST
        if not waiting or self._is_web_socket:
            self._forget()
        elif self._deadline is None:
            self._deadline = self.loop.call_later(PATIENCE_S, self.transport.abort)

    def _forget(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None


class _BoundedSocket(WebSocketsSansIOProtocol):
    """A WebSocket that is cut off when its client does not read; the library's pings do the rest.

    The kernel's buffer is small, so that it soon shows whether a client reads.
    """

    _deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        sock = transport.get_extra_info("socket")
        if sock is not None:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SOCKET_BUFFER_BYTES)

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self._forget()

    def pause_writing(self) -> None:
        super().pause_writing()
        if self._deadline is None:
            self._deadline = self.loop.call_later(PATIENCE_S, self.transport.abort)

    def resume_writing(self) -> None:
        super().resume_writing()
        self._forget()

    def _forget(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None
