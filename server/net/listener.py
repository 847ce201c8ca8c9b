"""The one port for people: the web client by GET, the world by WebSocket at /ws."""

import asyncio
import logging
import socket
from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from contextlib import asynccontextmanager
from functools import partial
from http import HTTPStatus
from typing import Any, Final, Protocol, cast

import structlog
from websockets.asyncio.server import Server, ServerConnection
from websockets.http11 import Request, Response
from websockets.protocol import State
from websockets.typing import Origin

from esplanade.server.assets import Assets, path_of, respond
from esplanade.server.metrics import Metrics
from esplanade.server.net.address_limits import AddressBounds, AddressLimits
from esplanade.server.net.addresses import TrustedProxies
from esplanade.server.net.answers import Answers, busy
from esplanade.server.net.checked_identities import CheckedIdentities
from esplanade.server.net.connection import Connection, WatchedProtocol
from esplanade.server.net.connections import Connections, Place
from esplanade.server.net.door import Door
from esplanade.server.net.metering import MAX_FRAME_BYTES, Meter
from esplanade.server.net.refusals import Refusals
from esplanade.server.net.root_path import RootPath
from esplanade.server.net.session import Reception, Session
from esplanade.server.net.sockets.reading import Reading, reading
from esplanade.server.net.tls import Tls
from esplanade.server.net.wished_zone import wished_zone
from esplanade.server.settings import ServerSettings

log = structlog.get_logger(__name__)

SOCKET_PATH: Final = "/ws"
REQUEST_TIMEOUT_S: Final = 30.0
"""A request, and the opening handshake of a WebSocket, must be whole within this time."""

MAX_UNGREETED: Final = 256
"""New connections are turned away while this many have not said hello yet."""

MAX_VISITS: Final = 256
"""New connections are cut off while this many fetch a page or have not asked for anything yet."""


def connections_wanted(settings: ServerSettings) -> int:
    """The number of connections that the port is to have room for."""
    return settings.max_clients + MAX_UNGREETED + MAX_VISITS


class Doorkeeper(Reception, Protocol):
    """The reception behind the port; it also takes movements of many people at once."""

    def moved(
        self,
        avatar_ids: Sequence[int],
        numbers: Sequence[int],
        directions_rad: Sequence[float],
        speeds_mps: Sequence[float],
    ) -> None:
        """Keep movements of many people for the next ticks."""

    def read_by(self, reading: Reading | None) -> None:
        """Let what people send be looked for there too."""


class Listener:
    """Accepts connections, answers requests for pages, and runs a session for each person."""

    def __init__(
        self,
        front_door: Doorkeeper,
        assets: Assets,
        settings: ServerSettings,
        metrics: Metrics,
        places: int,
    ) -> None:
        """`places` connections may be open, no more than there are descriptors for them."""
        self._front_door = front_door
        self._reading: Reading | None = None
        self._assets = assets
        self._settings = settings
        self._metrics = metrics
        self._sessions = 0
        self._refusals = Refusals(metrics)
        self._limits = AddressLimits(AddressBounds.of(settings))
        self._answers = Answers(settings.address_bytes, settings.answer_bytes, self._refusals)
        self._root = RootPath(settings.root_path)
        proxies = TrustedProxies(settings.trusted_proxies)
        self._identities = CheckedIdentities(settings.identity_header, proxies)
        self._connections = Connections(
            places,
            self._limits,
            proxies,
            self._refusals,
        )
        # Nothing is kept of what the library logs of each connection: port scanners break off many.
        self._logger = logging.getLogger("esplanade.server.websockets")
        metrics.gauge("connections", "Open WebSocket connections", lambda: self._sessions)
        metrics.gauge("sockets", "Open connections of any kind", lambda: len(self._connections))
        metrics.gauge("addresses", "Addresses with open connections", lambda: len(self._limits))
        metrics.gauge(
            "answer_bytes_unsent",
            "Bytes of pages and data that clients have not taken yet",
            lambda: self._answers.unsent_bytes,
        )

    @asynccontextmanager
    async def listening(
        self, sockets: list[socket.socket], tls: Tls | None = None
    ) -> AsyncIterator[Server]:
        """Listen at bound sockets; afterwards nobody is connected any more.

        Raises
        ------
        OSError
            The address cannot be had.
        """
        # The library hands over the connections that `_connect` makes.
        handler = cast(Callable[[ServerConnection], Coroutine[Any, Any, None]], self._handle)
        server = Server(lambda: self._open(server, sockets, tls), handler, self._logger)
        with reading(self._front_door.moved, self._metrics.traffic) as self._reading:
            self._front_door.read_by(self._reading)
            await server
            try:
                yield server
            finally:
                await self._connections.shut(server)
        self._reading = None
        self._front_door.read_by(None)

    async def _open(
        self, server: Server, sockets: list[socket.socket], tls: Tls | None
    ) -> asyncio.Server:
        door = Door(sockets, self._connections, partial(self._connect, server), tls)
        # The door has what the library asks of a server: it is no server of the event loop.
        return cast(asyncio.Server, door)

    def _connect(self, server: Server, place: Place) -> Connection:
        origins = cast(Sequence[Origin] | None, self._settings.origins)
        protocol = WatchedProtocol(
            origins=None if origins is None else [*origins, None],
            max_size=MAX_FRAME_BYTES,
            logger=self._logger,
        )
        now = asyncio.get_running_loop().time()
        meter = Meter(self._settings.message_rate, now)
        return Connection(
            protocol, server, place, meter, self._metrics, self._refusals, self._reading
        )

    async def _handle(self, connection: Connection) -> None:
        """Run a connection from its first byte to its end."""
        try:
            answer = await self._greet(connection)
            if answer is not None:
                await self._answers.send(connection, answer)
            elif connection.state is State.OPEN:
                connection.forget_request()
                await self._serve(connection)
        except (TimeoutError, ConnectionError):
            pass  # the client is gone, or too slow
        except Exception:
            log.exception("connection failed", address=connection.client_address)
        finally:
            connection.transport.abort()
            connection.server.handler_tasks.discard(asyncio.current_task())

    async def _greet(self, connection: Connection) -> Response | None:
        """Wait for the request: the answer to it, or None where a WebSocket has been opened."""
        async with asyncio.timeout(REQUEST_TIMEOUT_S):
            answer = self._answer(connection, await connection.asked())
            if answer is None:
                await connection.handshake(server_header=None)
            return answer

    async def _serve(self, connection: Connection) -> None:
        connection.server.all_connections.add(connection)
        self._sessions += 1
        try:
            async with connection:
                session = Session(
                    connection, self._front_door, self._settings, self._metrics, self._refusals
                )
                await session.run()
        finally:
            self._sessions -= 1
            connection.server.all_connections.discard(connection)

    def _answer(self, connection: Connection, request: Request) -> Response | None:
        """The answer to a request, or None where a WebSocket may be opened."""
        if request.method not in {"GET", "HEAD"}:
            return respond(
                HTTPStatus.METHOD_NOT_ALLOWED,
                b"only GET and HEAD are answered here\n",
                {"Allow": "GET, HEAD"},
            )
        if connection.place.attribute(request.headers.get_all("X-Forwarded-For")) is not None:
            return busy("too many connections from your address\n")
        connection.identity = self._identities.of(connection.place.peer, request)
        within = self._root.enter(request)
        if isinstance(within, Response):
            return within
        if path_of(within) != SOCKET_PATH:
            return self._assets.answer(within)
        connection.wished_zone = wished_zone(within)
        return self._refusal(connection.client_address)

    def _refusal(self, address: str) -> Response | None:
        """The answer to a client that may not open a WebSocket now, or None if it may."""
        too_many = self._sessions >= self._settings.max_clients + MAX_UNGREETED
        if too_many and not self._connections.make_room(address):
            self._refusals.answer("port_full", address)
            return busy("too many connections\n")
        why = self._limits.join(address, asyncio.get_running_loop().time())
        if why is not None:
            self._refusals.answer(why, address)
            return busy("too many people are coming in from your address\n")
        return None
