"""The one port for people: the web client by GET, the world by WebSocket at /ws."""

import logging
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from http import HTTPStatus
from typing import Final, cast

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.http11 import Request, Response
from websockets.typing import Origin

from esplanade.protocol.codes import MAX_CLIENT_FRAME_BYTES
from esplanade.server.assets import Assets, path_of, respond
from esplanade.server.metrics import Metrics
from esplanade.server.net.connections import Connections
from esplanade.server.net.hub import Hub
from esplanade.server.net.session import CLOSE_S, Session
from esplanade.server.settings import ServerSettings

SOCKET_PATH: Final = "/ws"
ANSWER_TIMEOUT_S: Final = 30.0
"""The opening handshake, or a whole asset over a thin line, may take this long."""

MAX_FRAME_BYTES: Final = 8 * MAX_CLIENT_FRAME_BYTES
"""Frames above the protocol's limit get a named error; above this the library refuses to read."""

MAX_UNGREETED: Final = 256
"""New connections are turned away while this many have not said hello yet."""

MAX_VISITS: Final = 256
"""New connections are cut off while this many fetch a page or have not asked for anything yet."""


class Listener:
    """Accepts connections and runs a session for each."""

    def __init__(
        self, hub: Hub, assets: Assets, settings: ServerSettings, metrics: Metrics
    ) -> None:
        self._hub = hub
        self._assets = assets
        self._settings = settings
        self._metrics = metrics
        self._sessions = 0
        self._connections = Connections(settings.max_clients + MAX_UNGREETED + MAX_VISITS)
        metrics.gauge("connections", "Open WebSocket connections", lambda: self._sessions)
        metrics.gauge("sockets", "Open connections of any kind", lambda: len(self._connections))
        metrics.total(
            "sockets_refused",
            "Connections cut off because there were too many",
            lambda: self._connections.refused,
        )

    @asynccontextmanager
    async def listening(self) -> AsyncIterator[Server]:
        """Listen on the settings' host and port; afterwards nobody is connected any more.

        Raises
        ------
        OSError
            The address cannot be had.
        """
        origins = cast(Sequence[Origin] | None, self._settings.origins)
        server = await serve(
            self._serve,
            self._settings.host,
            self._settings.port,
            origins=None if origins is None else [*origins, None],
            compression=None,
            process_request=self._answer,
            server_header=None,
            open_timeout=ANSWER_TIMEOUT_S,
            close_timeout=CLOSE_S,
            max_size=MAX_FRAME_BYTES,
            logger=logging.getLogger("esplanade.server.websockets"),
            create_connection=self._connections.factory,
        )
        try:
            yield server
        finally:
            await self._connections.shut(server)

    async def _serve(self, connection: ServerConnection) -> None:
        self._sessions += 1
        try:
            await Session(connection, self._hub, self._settings, self._metrics).run()
        finally:
            self._sessions -= 1

    def _answer(self, _: ServerConnection, request: Request) -> Response | None:
        if request.method not in {"GET", "HEAD"}:
            return respond(
                HTTPStatus.METHOD_NOT_ALLOWED,
                b"only GET and HEAD are answered here\n",
                {"Allow": "GET, HEAD"},
            )
        if path_of(request) != SOCKET_PATH:
            return self._assets.answer(request)
        if self._sessions >= self._settings.max_clients + MAX_UNGREETED:
            return respond(HTTPStatus.SERVICE_UNAVAILABLE, b"too many connections\n")
        return None
