"""The live socket of operators, and the stream of events for those without one."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from contextlib import suppress
from typing import Any, Final

from fastapi import APIRouter, Request, WebSocket
from fastapi.responses import StreamingResponse
from starlette.websockets import WebSocketDisconnect

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.console import callers
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, caller, gate_of, may
from esplanade.server.live.live import MOST_SUBSCRIBERS, Live
from esplanade.server.live.subscriber import Subscriber
from esplanade.server.live.subscriptions import WishError, read_wish
from esplanade.server.store.store import StoreError

IDENTITY_ENDED: Final = 4001
TOO_SLOW: Final = 4008
STREAMED: Final = ("series", "events", "changes", "contacts")
"""Channels that a stream may have; a map is none."""
_ALIVE_S: Final = 15.0
"""A stream says after this time that it is alive."""

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)


@router.websocket("/live")
async def live_socket(socket: WebSocket) -> None:
    """Tell a console what it subscribes to, for as long as it may watch and reads."""
    try:
        gate = gate_of(socket)
        live = gate.live
        standing = await gate.callers.at_socket(socket)
    except (RefusedError, StoreError):
        await socket.close()  # before it is accepted this answers 403
        return
    if live is None or Right.WATCH not in standing.identity.rights or _full(live):
        await socket.close()
        return
    await socket.accept()
    subscriber = Subscriber(names=live.sees_names(standing.identity))
    live.hello(subscriber)
    tasks = {
        asyncio.create_task(_read(socket, subscriber)),
        asyncio.create_task(_write(socket, live, subscriber)),
        asyncio.create_task(_look_up(standing.renew, live, subscriber)),
        asyncio.create_task(_wait_for_slowness(subscriber)),
    }
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        code = next((task.result() for task in done if task.exception() is None), None)
    finally:
        live.goodbye(subscriber)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    if code is not None:
        with suppress(RuntimeError, OSError, WebSocketDisconnect):
            await socket.close(code)


@router.get("/live.sse")
async def live_stream(request: Request, channels: str = "series,events") -> StreamingResponse:
    """Tell what is new as server-sent events, for `curl` and the like."""
    may(request, Right.WATCH)
    gate, live = gate_of(request), gate_of(request).live
    if live is None or _full(live):
        raise RefusedError.of("busy", "the world is not ready, or too many consoles look")
    subscriber = Subscriber(names=live.sees_names(caller(request)))
    for channel in channels.split(","):
        if channel not in STREAMED:
            text = f"a stream has {', '.join(STREAMED)}, not {channel!r}"
            raise RefusedError.of("unknown_channel", text, "query", "channels")
        subscriber.take(read_wish(f'{{"subscribe": "{channel}"}}'))
    headers = {"Cache-Control": "no-cache"}
    standing = callers.Standing(gate.callers, gate.callers.credential(request), caller(request))
    stream = _stream(_look_up(standing.renew, live, subscriber), live, subscriber)
    return StreamingResponse(stream, media_type="text/event-stream", headers=headers)


def _full(live: Live) -> bool:
    return len(live.subscribers) >= MOST_SUBSCRIBERS


async def _read(socket: WebSocket, subscriber: Subscriber) -> int | None:
    """Take in what the client wants, until it is gone."""
    while True:
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            return None
        try:
            subscriber.take(read_wish(message.get("text") or ""))
        except WishError as error:
            subscriber.tell(error.told)


async def _write(socket: WebSocket, live: Live, subscriber: Subscriber) -> int | None:
    """Write what waits, message by message; a client that does not read holds up only this."""
    while True:
        for each in await subscriber.next(live.map):
            if isinstance(each, str):
                await socket.send_text(each)
            else:
                await socket.send_bytes(each)


async def _look_up(
    renew: Callable[[], Awaitable[Identity]], live: Live, subscriber: Subscriber
) -> int | None:
    """Look an identity up again and again, until it may not watch any more."""
    while True:
        await asyncio.sleep(callers.RENEWED_S)
        try:
            identity = await renew()
        except RefusedError:
            return IDENTITY_ENDED
        except StoreError:
            continue  # it is looked up again soon
        if Right.WATCH not in identity.rights:
            return IDENTITY_ENDED
        subscriber.names = live.sees_names(identity)


async def _wait_for_slowness(subscriber: Subscriber) -> int | None:
    await subscriber.too_slow.wait()
    return TOO_SLOW


async def _stream(
    look: Coroutine[Any, Any, int | None], live: Live, subscriber: Subscriber
) -> AsyncIterator[bytes]:
    """Messages as server-sent events, until the client may not watch or does not read."""
    live.hello(subscriber)
    looking = asyncio.create_task(look)
    waiting: asyncio.Task[Any] | None = None
    try:
        while not looking.done() and not subscriber.too_slow.is_set():
            waiting = waiting or asyncio.create_task(subscriber.next(live.map))
            await asyncio.wait({waiting, looking}, timeout=_ALIVE_S, return_when="FIRST_COMPLETED")
            if not waiting.done():
                yield b": alive\n\n"
                continue
            for each in waiting.result():
                yield b"data: " + each.encode() + b"\n\n"
            waiting = None
    finally:
        live.goodbye(subscriber)
        looking.cancel()
        if waiting is not None:
            waiting.cancel()
