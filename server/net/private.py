"""The private port tells operators whether the server is alive and ready, and its metrics."""

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from http import HTTPStatus
from typing import Final

from fastapi import FastAPI, Request, Response
from fastapi.responses import PlainTextResponse

from esplanade.server.metrics import Metrics
from esplanade.server.net.asgi import MAX_BODY_BYTES, serving
from esplanade.server.settings import ServerSettings

METRICS_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"


@asynccontextmanager
async def private_port(
    settings: ServerSettings, metrics: Metrics, ready: Callable[[], bool]
) -> AsyncIterator[int]:
    """Listen for operators, and yield the number of the port.

    Raises
    ------
    OSError
        The address cannot be had.
    """
    app = operators_api(metrics, ready)
    async with serving(app, settings.private_host, settings.private_port) as port:
        yield port


def operators_api(metrics: Metrics, ready: Callable[[], bool]) -> FastAPI:
    """The application behind the private port; it answers /healthz, /readyz and /metrics."""
    app = FastAPI(
        openapi_url=None,
        redirect_slashes=False,
        max_body_size=MAX_BODY_BYTES,
        exception_handlers={HTTPStatus.NOT_FOUND: _nothing_here},
    )

    # Routes of Starlette answer HEAD as well as GET; those of FastAPI do not.
    async def alive(_: Request) -> Response:
        return PlainTextResponse("alive\n", headers=_UNCACHED)

    async def is_ready(_: Request) -> Response:
        if ready():
            return PlainTextResponse("ready\n", headers=_UNCACHED)
        return PlainTextResponse(
            "starting or stopping\n", HTTPStatus.SERVICE_UNAVAILABLE, _UNCACHED
        )

    async def exposition(_: Request) -> Response:
        return Response(metrics.exposition(), headers=_UNCACHED, media_type=METRICS_TYPE)

    app.add_route("/healthz", alive)
    app.add_route("/readyz", is_ready)
    app.add_route("/metrics", exposition)
    return app


_UNCACHED: Final = {"Cache-Control": "no-cache"}


async def _nothing_here(_: Request, __: Exception) -> Response:
    return PlainTextResponse("/healthz, /readyz, /metrics\n", HTTPStatus.NOT_FOUND, _UNCACHED)
