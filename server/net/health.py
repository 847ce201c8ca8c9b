"""Health of a process and its metrics by HTTP, from a thread and an event loop of their own.

So they tell the truth of a world that is busy or stuck, and are not kept waiting by people's
connections.
"""

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import asynccontextmanager
from functools import partial
from http import HTTPStatus
from typing import Any, Final

from fastapi import FastAPI, Request, Response
from fastapi.responses import PlainTextResponse

from esplanade.server.metrics import Metrics
from esplanade.server.net.asgi import serving
from esplanade.server.net.tls import Tls

METRICS_TYPE: Final = "text/plain; version=0.0.4; charset=utf-8"

SAMPLE_LIMIT_S: Final = 1.0
"""A world that does not give its figures within this time is shown with those it gave last."""

Beside = Callable[[], Coroutine[Any, Any, None]]
"""Work on the event loop of the port for as long as it listens."""


@asynccontextmanager
async def served_beside(
    app: FastAPI, host: str, port: int, tls: Tls | None = None, beside: Beside | None = None
) -> AsyncIterator[int]:
    """Serve an application in a thread of its own, and yield the number of the port.

    Raises
    ------
    OSError
        The address cannot be had.
    """
    loop = asyncio.get_running_loop()
    opened: Future[tuple[int, Callable[[], object]]] = Future()
    serve = partial(_serve, app, host, port, opened, tls, beside)
    with ThreadPoolExecutor(1, thread_name_prefix="private") as thread:
        running = loop.run_in_executor(thread, lambda: asyncio.run(serve()))
        number, stop = await asyncio.wrap_future(opened)
        try:
            yield number
        finally:
            stop()
            await running


async def _serve(
    app: FastAPI,
    host: str,
    port: int,
    opened: "Future[tuple[int, Callable[[], object]]]",
    tls: Tls | None,
    beside: Beside | None,
) -> None:
    """Serve until stopped; `opened` is given the number of the port and what stops it."""
    stopping = asyncio.Event()
    try:
        async with serving(app, host, port, tls) as number:
            stop = partial(asyncio.get_running_loop().call_soon_threadsafe, stopping.set)
            opened.set_result((number, stop))
            working = None if beside is None else asyncio.create_task(beside())
            await stopping.wait()
            if working is not None:
                working.cancel()
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


def add_health(app: FastAPI, figures: Figures, hindrance: Callable[[], str | None]) -> None:
    """Add /healthz, /readyz and /metrics; `hindrance` says why nobody should be sent here."""

    # Routes of Starlette answer HEAD as well as GET; those of FastAPI do not.
    async def alive(_: Request) -> Response:
        return PlainTextResponse("alive\n", headers=UNCACHED)

    async def is_ready(_: Request) -> Response:
        why = hindrance()
        if why is None:
            return PlainTextResponse("ready\n", headers=UNCACHED)
        return PlainTextResponse(f"{why}\n", HTTPStatus.SERVICE_UNAVAILABLE, UNCACHED)

    async def exposition(_: Request) -> Response:
        return Response(await figures.text(), headers=UNCACHED, media_type=METRICS_TYPE)

    app.add_route("/healthz", alive)
    app.add_route("/readyz", is_ready)
    app.add_route("/metrics", exposition)


UNCACHED: Final = {"Cache-Control": "no-cache"}


@asynccontextmanager
async def health_port(
    host: str, port: int, metrics: Metrics, hindrance: Callable[[], str | None]
) -> AsyncIterator[int]:
    """Serve health and metrics alone, and yield the number of the port.

    Raises
    ------
    OSError
        The address cannot be had.
    """
    app = FastAPI(title="Esplanade", openapi_url=None, docs_url=None, redoc_url=None)
    add_health(app, Figures(metrics, asyncio.get_running_loop()), hindrance)
    async with served_beside(app, host, port) as number:
        yield number
