"""Operators in the zone of a host: a thread and an event loop of their own, as of a private port.

There is no port. Requests come over the broker from gateways, which know who asks; none of them
holds up a tick, since blocks of maps and answers are made in that thread.
"""

import asyncio
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import asynccontextmanager, suppress
from functools import partial
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request, Response

from esplanade.server.console.api import OF_ZONE, add_api
from esplanade.server.console.brakes import Brakes
from esplanade.server.console.gate import Gate, Operated
from esplanade.server.console.introduced import IntroducedCallers
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import answer_to
from esplanade.server.host.calls_in import CallsIn
from esplanade.server.kept import Kept
from esplanade.server.link.broker import Connecting
from esplanade.server.link.subjects import Subjects
from esplanade.server.live.live import beating
from esplanade.server.live.metrics import watch_live
from esplanade.server.metrics import Metrics
from esplanade.server.net.asgi import MAX_BODY_BYTES
from esplanade.server.settings import ServerSettings
from esplanade.server.watching import watch_gate


class HostOperators:
    """Lets requests of operators into the zone that this process runs, on the zone's loop."""

    def __init__(self, gate: Gate, calls: CallsIn, loop: asyncio.AbstractEventLoop) -> None:
        self._gate = gate
        self._calls = calls
        self._loop = loop

    async def open(self, zone: str, epoch: int, operated: Operated) -> None:
        """Let them in from now on, for the owner of that epoch."""
        self._gate.zones = {zone: operated}
        await self._there(self._calls.listen(zone, epoch))

    async def close(self) -> None:
        """Let nobody in any more; whoever waits for an answer is told that none comes."""
        self._gate.zones = {}
        await self._there(self._calls.rest())

    async def _there(self, work: Any) -> None:
        await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, self._loop))


@asynccontextmanager
async def host_operators(
    settings: ServerSettings,
    kept: Kept,
    metrics: Metrics,
    subjects: Subjects,
    broker_of: Callable[[], Connecting],
) -> AsyncIterator[HostOperators]:
    """Begin the thread of operators; `broker_of` connects it to the broker.

    Raises
    ------
    BrokerError
        No broker answers.
    """
    callers = IntroducedCallers(kept.tokens, kept.sessions, kept.directory.again)
    brakes = Brakes(settings.operator_commands)
    gate = Gate(callers, kept, asyncio.get_running_loop(), brakes=brakes)
    watch_gate(metrics, gate)
    watch_live(metrics, lambda: [each.live for each in gate.zones.values()])
    opened: Future[tuple[CallsIn, asyncio.AbstractEventLoop, Callable[[], object]]] = Future()
    serve = partial(_serve, gate, subjects, broker_of, opened)
    with ThreadPoolExecutor(1, thread_name_prefix="operators") as thread:
        running = asyncio.get_running_loop().run_in_executor(thread, lambda: asyncio.run(serve()))
        calls, loop, stop = await asyncio.wrap_future(opened)
        try:
            yield HostOperators(gate, calls, loop)
        finally:
            gate.zones = {}
            stop()
            await running


async def _serve(
    gate: Gate,
    subjects: Subjects,
    broker_of: Callable[[], Connecting],
    opened: "Future[tuple[CallsIn, asyncio.AbstractEventLoop, Callable[[], object]]]",
) -> None:
    """Serve until stopped; `opened` is given what lets requests in, and what stops it."""
    stopping, loop = asyncio.Event(), asyncio.get_running_loop()
    try:
        async with broker_of() as broker:
            calls = CallsIn(_application(gate), subjects, broker)
            opened.set_result((calls, loop, partial(loop.call_soon_threadsafe, stopping.set)))
            beats = asyncio.create_task(
                beating(lambda: [each.live for each in gate.zones.values()])
            )
            await stopping.wait()
            await calls.rest()
            beats.cancel()
            with suppress(asyncio.CancelledError):
                await beats
    except Exception as error:
        if opened.done():
            raise
        opened.set_exception(error)


def _application(gate: Gate) -> FastAPI:
    """The application behind requests about the zone."""
    app = FastAPI(
        title="Esplanade",
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        max_body_size=MAX_BODY_BYTES,
        exception_handlers={HTTPStatus.NOT_FOUND: _nothing_here},
    )
    add_api(app, gate, OF_ZONE)
    return app


async def _nothing_here(_: Request, __: Exception) -> Response:
    return answer_to(RefusedError.of("unknown", "there is nothing at this path"))
