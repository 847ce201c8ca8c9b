"""The live interface for operators: the socket, and questions about what was just seen."""

import asyncio
from contextlib import suppress
from typing import Any, Final

from fastapi import APIRouter, Request, WebSocket
from starlette.websockets import WebSocketDisconnect

from esplanade.server.accounts.rights import Right
from esplanade.server.console.gate import Gate
from esplanade.server.console.guarding import REFUSALS, Guarded, gate_of, may_watch
from esplanade.server.console.refusals import RefusedError
from esplanade.server.live.live import MOST_SUBSCRIBERS, Live
from esplanade.server.live.subscriber import Subscriber
from esplanade.server.live.subscriptions import WishError, read_wish
from esplanade.server.store.store import StoreError

IDENTITY_ENDED: Final = 4001
TOO_SLOW: Final = 4008
FULL: Final = 4009
LOOKED_UP_EVERY_S: Final = 30.0
"""Whoever has lost the right to watch sees nothing any more after this time."""

router = APIRouter(prefix="/api/v1", route_class=Guarded, responses=REFUSALS)


@router.get("/map")
async def ground(request: Request) -> dict[str, Any]:
    """The plan of the scene, storey by storey, with the doors as they are."""
    may_watch(request)
    live, gate = live_of(request), gate_of(request)

    async def doors(console: Any) -> dict[str, bool]:
        states: dict[str, bool] = console.zone.doors.states()
        return states

    states = await gate.call(doors)
    plan = live.plan()
    return {**plan, "doors": [{**door, "open": states[door["name"]]} for door in plan["doors"]]}


@router.websocket("/live")
async def live_socket(socket: WebSocket) -> None:
    """Tell a console what it subscribes to, for as long as it may watch and reads."""
    gate: Gate = socket.app.state.gate
    live = gate.live
    try:
        gate.check_origin(socket)
        identity = await gate.identity(socket)
    except (RefusedError, StoreError):
        await socket.close(IDENTITY_ENDED)  # before it is accepted: 403
        return
    if (
        live is None
        or Right.WATCH not in identity.rights
        or len(live.subscribers) >= MOST_SUBSCRIBERS
    ):
        await socket.close(FULL)
        return
    await socket.accept()
    subscriber = Subscriber(names=live.sees_names(identity))
    live.hello(subscriber)
    tasks = {
        asyncio.create_task(_read(socket, live, subscriber)),
        asyncio.create_task(_write(socket, live, subscriber)),
        asyncio.create_task(_look_up(socket, gate, live, subscriber)),
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


async def _read(socket: WebSocket, live: Live, subscriber: Subscriber) -> int | None:
    """Take in what the client wants, until it is gone."""
    while True:
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            return None
        try:
            subscriber.take(read_wish(message.get("text") or ""), live.beats)
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


async def _look_up(socket: WebSocket, gate: Gate, live: Live, subscriber: Subscriber) -> int | None:
    """Look its identity up again and again, until it may not watch any more."""
    while True:
        await asyncio.sleep(LOOKED_UP_EVERY_S)
        try:
            identity = await gate.identity(socket)
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


def live_of(request: Request) -> Live:
    """The live views of the world.

    Raises
    ------
    RefusedError
        There is no world yet.
    """
    live = gate_of(request).live
    if live is None:
        raise RefusedError.of("busy", "the world is not ready")
    return live
