"""The private port: is the server alive, is it ready, what does it count."""

import logging
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from http import HTTPStatus
from typing import Final

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.http11 import Request, Response

from esplanade.server.assets import path_of, respond
from esplanade.server.metrics import Metrics
from esplanade.server.net.connections import Connections
from esplanade.server.settings import ServerSettings

METRICS_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"


MAX_CONNECTIONS: Final = 64


@asynccontextmanager
async def private_port(
    settings: ServerSettings, metrics: Metrics, ready: Callable[[], bool]
) -> AsyncIterator[Server]:
    """Listen for operators. Answers GET /healthz, /readyz and /metrics; upgrades nothing.

    Raises
    ------
    OSError
        The address cannot be had.
    """

    def answer(_: ServerConnection, request: Request) -> Response:
        if request.method != "GET":
            return respond(HTTPStatus.METHOD_NOT_ALLOWED, b"only GET\n", {"Allow": "GET"})
        match path_of(request):
            case "/healthz":
                return respond(HTTPStatus.OK, b"alive\n")
            case "/readyz" if ready():
                return respond(HTTPStatus.OK, b"ready\n")
            case "/readyz":
                return respond(HTTPStatus.SERVICE_UNAVAILABLE, b"starting or stopping\n")
            case "/metrics":
                return respond(HTTPStatus.OK, metrics.exposition(), {"Content-Type": METRICS_TYPE})
        return respond(HTTPStatus.NOT_FOUND, b"/healthz, /readyz, /metrics\n")

    connections = Connections(MAX_CONNECTIONS)
    server = await serve(
        _never,
        settings.private_host,
        settings.private_port,
        process_request=answer,
        server_header=None,
        logger=logging.getLogger("esplanade.server.websockets"),
        create_connection=connections.factory,
    )
    try:
        yield server
    finally:
        await connections.shut(server)


async def _never(connection: ServerConnection) -> None:
    """No request gets this far: every one is answered above."""
    await connection.close()
