"""The private port tells whether the server is alive and ready, its metrics, and serves operators.

It has a thread and an event loop of its own, so that it tells the truth of a world that is busy or
stuck, and is not kept waiting by people's connections.
"""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from http import HTTPStatus
from typing import Protocol

from fastapi import FastAPI, Request, Response
from fastapi.responses import PlainTextResponse

from esplanade.server.assets import Assets
from esplanade.server.console.api import add_api
from esplanade.server.console.gate import Gate
from esplanade.server.console.pages import add_pages
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import PREFIX, answer_to
from esplanade.server.console.zone_paths import ZonePaths
from esplanade.server.live.live import beating
from esplanade.server.live.metrics import watch_live
from esplanade.server.metrics import Metrics
from esplanade.server.net.asgi import MAX_BODY_BYTES
from esplanade.server.net.health import UNCACHED, Figures, add_health, served_beside
from esplanade.server.net.tls import Tls
from esplanade.server.settings import ServerSettings
from esplanade.server.watching import watch_gate


class Ready(Protocol):
    """Whether people may come in."""

    def hindrance(self) -> str | None:
        """Why nobody should be sent here; None if people may come in."""


class ZonesElsewhere(Protocol):
    """The zones of a world that are in other processes, and how they are reached."""

    def add_to(self, app: FastAPI) -> None:
        """Have requests about zones answered there."""

    async def run(self) -> None:
        """Keep up the connection to them on the event loop of the port, until cancelled."""


@asynccontextmanager
async def private_port(
    settings: ServerSettings,
    metrics: Metrics,
    readiness: Ready,
    gate: Gate,
    assets: Assets,
    tls: Tls | None = None,
    elsewhere: ZonesElsewhere | None = None,
) -> AsyncIterator[int]:
    """Listen for operators, and yield the number of the port.

    The figures of the metrics are read on the event loop that calls this. What is `elsewhere` is
    not answered here.

    Raises
    ------
    OSError
        The address cannot be had.
    """
    watch_gate(metrics, gate)
    metrics.total(
        "origins_refused",
        "Requests of operators that were refused for their page or the name of the port",
        lambda: gate.callers.origins.refused,
    )
    watch_live(metrics, lambda: [each.live for each in gate.zones.values()])
    figures = Figures(metrics, asyncio.get_running_loop())
    app = operators_api(figures, readiness, gate, assets, elsewhere)
    host, port = settings.private_host, settings.private_port

    async def pulse() -> None:
        if elsewhere is not None:
            await elsewhere.run()
        await beating(lambda: [each.live for each in gate.zones.values()])

    async with served_beside(app, host, port, tls, pulse) as number:
        yield number


def operators_api(
    figures: Figures,
    readiness: Ready,
    gate: Gate,
    assets: Assets,
    elsewhere: ZonesElsewhere | None = None,
) -> FastAPI:
    """The application behind the private port: /healthz, /readyz, /metrics, /console, the API."""
    app = FastAPI(
        title="Esplanade",
        version="1",
        openapi_url="/openapi.json",
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        max_body_size=MAX_BODY_BYTES,
        exception_handlers={HTTPStatus.NOT_FOUND: _nothing_here},
    )
    if elsewhere is not None:
        elsewhere.add_to(app)
    app.add_middleware(ZonePaths)  # the last that is added is the first that a request meets
    add_health(app, figures, readiness.hindrance)
    add_pages(app, assets)
    add_api(app, gate)
    return app


async def _nothing_here(request: Request, __: Exception) -> Response:
    if request.url.path.startswith(f"{PREFIX}/"):
        return answer_to(RefusedError.of("unknown", "there is nothing at this path"))
    paths = f"/console, /healthz, /readyz, /metrics, /openapi.json, {PREFIX}/…\n"
    return PlainTextResponse(paths, HTTPStatus.NOT_FOUND, UNCACHED)
