"""The private port tells whether the server is alive and ready, its metrics, and serves operators.

It has a thread and an event loop of its own, so that it tells the truth of a world that is busy or
stuck, and is not kept waiting by people's connections.
"""

import asyncio
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import asynccontextmanager
from functools import partial
from http import HTTPStatus
from typing import Final

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
from esplanade.server.net.asgi import MAX_BODY_BYTES, serving
from esplanade.server.net.readiness import Readiness
from esplanade.server.net.tls import Tls
from esplanade.server.settings import ServerSettings

METRICS_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"

SAMPLE_LIMIT_S: Final = 1.0
"""A world that does not give its figures within this time is shown with those it gave last."""


@asynccontextmanager
async def private_port(
    settings: ServerSettings,
    metrics: Metrics,
    readiness: Readiness,
    gate: Gate,
    assets: Assets,
    tls: Tls | None = None,
) -> AsyncIterator[int]:
    """Listen for operators, and yield the number of the port.

    The figures of the metrics are read on the event loop that calls this.

    Raises
    ------
    OSError
        The address cannot be had.
    """
    metrics.gauge(
        "requests_under_way",
        "Requests of operators that wait for the world",
        lambda: gate.under_way,
    )
    metrics.total(
        "commands_braked",
        "Operators' commands, or lists of them, that came too soon",
        lambda: gate.brakes.refused,
    )
    metrics.total(
        "origins_refused",
        "Requests of operators that were refused for their page or the name of the port",
        lambda: gate.callers.origins.refused,
    )
    loop = asyncio.get_running_loop()
    watch_live(metrics, lambda: [each.live for each in gate.zones.values()])
    app = operators_api(Figures(metrics, loop), readiness, gate, assets)
    opened: Future[tuple[int, Callable[[], object]]] = Future()
    serve = partial(_serve, app, gate, settings.private_host, settings.private_port, opened, tls)
    with ThreadPoolExecutor(1, thread_name_prefix="private") as thread:
        running = loop.run_in_executor(thread, lambda: asyncio.run(serve()))
        port, stop = await asyncio.wrap_future(opened)
        try:
            yield port
        finally:
            stop()
            await running


async def _serve(
    app: FastAPI,
    gate: Gate,
    host: str,
    port: int,
    opened: "Future[tuple[int, Callable[[], object]]]",
    tls: Tls | None,
) -> None:
    """Serve until stopped; `opened` is given the number of the port and what stops it."""
    stopping = asyncio.Event()
    try:
        async with serving(app, host, port, tls) as number:
            stop = partial(asyncio.get_running_loop().call_soon_threadsafe, stopping.set)
            opened.set_result((number, stop))
            pulse = asyncio.create_task(
                beating(lambda: [each.live for each in gate.zones.values()])
            )
            await stopping.wait()
            pulse.cancel()
    except OSError as error:
        if opened.done():
            raise
        opened.set_exception(error)


class Figures:
    """The metrics as text: their figures are read by the world's event loop, and told by another.

    A world that is busy is asked once and shown with the figures that it gave last.
    """

    def __init__(self, metrics: Metrics, world: asyncio.AbstractEventLoop) -> None:
        self._metrics = metrics
        self._world = world
        self._asked: Future[None] | None = None

    async def text(self) -> bytes:
        """All metrics in Prometheus' text format."""
        if self._asked is None or self._asked.done():
            self._asked = Future()
            self._world.call_soon_threadsafe(self._sample, self._asked)
        await asyncio.wait([asyncio.wrap_future(self._asked)], timeout=SAMPLE_LIMIT_S)
        if self._asked.done():
            self._asked.result()
        return self._metrics.render()

    def _sample(self, asked: "Future[None]") -> None:
        try:
            self._metrics.sample()
        except Exception as error:  # noqa: BLE001 (it is raised where the figures were asked for)
            asked.set_exception(error)
        else:
            asked.set_result(None)


def operators_api(figures: Figures, readiness: Readiness, gate: Gate, assets: Assets) -> FastAPI:
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

    # Routes of Starlette answer HEAD as well as GET; those of FastAPI do not.
    async def alive(_: Request) -> Response:
        return PlainTextResponse("alive\n", headers=_UNCACHED)

    async def is_ready(_: Request) -> Response:
        hindrance = readiness.hindrance()
        if hindrance is None:
            return PlainTextResponse("ready\n", headers=_UNCACHED)
        return PlainTextResponse(f"{hindrance}\n", HTTPStatus.SERVICE_UNAVAILABLE, _UNCACHED)

    async def exposition(_: Request) -> Response:
        return Response(await figures.text(), headers=_UNCACHED, media_type=METRICS_TYPE)

    app.add_middleware(ZonePaths)
    app.add_route("/healthz", alive)
    app.add_route("/readyz", is_ready)
    app.add_route("/metrics", exposition)
    add_pages(app, assets)
    add_api(app, gate)
    return app


_UNCACHED: Final = {"Cache-Control": "no-cache"}


async def _nothing_here(request: Request, __: Exception) -> Response:
    if request.url.path.startswith(f"{PREFIX}/"):
        return answer_to(RefusedError.of("unknown", "there is nothing at this path"))
    paths = f"/console, /healthz, /readyz, /metrics, /openapi.json, {PREFIX}/…\n"
    return PlainTextResponse(paths, HTTPStatus.NOT_FOUND, _UNCACHED)
