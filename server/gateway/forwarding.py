"""Hands requests of operators about a zone on to the host that owns it, and the answers back.

Who asks is found out here. What is about the whole world, such as accounts and the audit, is
answered here too.
"""

import asyncio
from collections.abc import Awaitable, Callable, Collection
from contextlib import suppress
from typing import Any, Final

from starlette.requests import HTTPConnection, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from esplanade.server.accounts.identity import Identity
from esplanade.server.console import callers
from esplanade.server.console.callers import HEADER, Standing
from esplanade.server.console.gate import Gate
from esplanade.server.console.live_socket import IDENTITY_ENDED
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import answer_to
from esplanade.server.console.zone_paths import zone_of
from esplanade.server.gateway.calls_out import CallLostError, CallsOut, NoHostError, OpenCall
from esplanade.server.link.calls import Begun, Call, Caller, Closed, Part
from esplanade.server.store.store import StoreError

PASSED_ON: Final = (b"accept", b"content-type", HEADER.lower().encode(), b"if-none-match")
"""The headers of a request that a host is told. None of them says who asks."""
HOST_LOST: Final = 1012
"""The close code of a socket whose zone has another host now: come again."""
MOST_CALLS: Final = 64
"""Requests that hosts answer at once; more are refused."""

Zones = Callable[[], Awaitable[Collection[str]]]


class ForwardedToHosts:
    """An application whose requests about zones are answered by hosts."""

    def __init__(
        self,
        app: ASGIApp,
        *,
        gate: Gate,
        calls: CallsOut,
        zones: Zones,
        start: str,
        is_forwarded: Callable[[str], bool],
    ) -> None:
        """`zones` tells the names of all zones, and `start` is the one that newcomers enter.
        `is_forwarded` tells whether a path, without the name of a zone, is about one."""
        self._app = app
        self._gate = gate
        self._calls = calls
        self._zones = zones
        self._start = start
        self._is_forwarded = is_forwarded

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or have it answered."""
        if scope["type"] not in {"http", "websocket"} or not self._is_forwarded(scope["path"]):
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            await self._http(scope, receive, send)
        else:
            await self._socket(scope, receive, send)

    async def _http(self, scope: Scope, receive: Receive, send: Send) -> None:
        request = Request(scope, receive)
        begun = False

        async def sending(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            identity = await self._gate.callers.identity(request)
            body = await request.body()  # the application bounds it
            zone = await self._zone(scope)
            call = self._call(request, identity, body)
            async with self._calls.begun(zone, call) as opened:
                await self._relay(opened, receive, sending)
        except RefusedError as error:
            await answer_to(error)(scope, receive, send)
        except StoreError as error:
            await answer_to(RefusedError.of("busy", f"the store cannot be used: {error}"))(
                scope, receive, send
            )
        except NoHostError as error:
            text = f"no host has the zone {error} just now; try again in a moment"
            await answer_to(RefusedError.of("busy", text))(scope, receive, send)
        except CallLostError as error:
            if not begun:
                text = f"{error}; it may still do what was asked"
                await answer_to(RefusedError.of("not_known", text))(scope, receive, send)

    async def _relay(self, opened: OpenCall, receive: Receive, send: Send) -> None:
        """Write an answer as it comes, for as long as its client is there."""
        leaving = asyncio.create_task(_left(receive))
        writing = asyncio.create_task(_written(opened, send))
        try:
            await asyncio.wait({leaving, writing}, return_when=asyncio.FIRST_COMPLETED)
            if writing.done():
                writing.result()
        finally:
            for task in (leaving, writing):
                task.cancel()
            await asyncio.gather(leaving, writing, return_exceptions=True)

    async def _socket(self, scope: Scope, receive: Receive, send: Send) -> None:
        socket = WebSocket(scope, receive, send)
        try:
            standing = await self._gate.callers.at_socket(socket)
            zone = await self._zone(scope)
            call = self._call(socket, standing.identity, b"")
            async with self._calls.begun(zone, call) as opened:
                code = await self._converse(opened, socket, standing)
        except (RefusedError, StoreError, NoHostError):
            code = None
        except CallLostError:
            code = HOST_LOST
        with suppress(RuntimeError, OSError, WebSocketDisconnect):
            await socket.close(code or 1000)

    async def _converse(
        self, opened: OpenCall, socket: WebSocket, standing: Standing
    ) -> int | None:
        """Carry what both ends say; returns the code with which the socket is to be closed."""
        begun = await opened.next()
        if not isinstance(begun, Begun):
            return None  # before it is accepted this answers 403
        await socket.accept()
        await opened.written()
        tasks = {
            asyncio.create_task(_heard(opened, socket)),
            asyncio.create_task(_spoken(opened, socket)),
            asyncio.create_task(_look_up(standing)),
        }
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            return next((task.result() for task in done), None)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _zone(self, scope: Scope) -> str:
        """The zone that a request is about.

        Raises
        ------
        RefusedError
            There is no such zone, or too many requests are under way.
        """
        if self._calls.under_way >= MOST_CALLS:
            raise RefusedError.of("busy", f"{MOST_CALLS} requests wait already")
        zone = zone_of(scope)
        if zone is None:
            return self._start
        known = await self._zones()
        if zone not in known:
            text = f"there is no zone {zone}; there are: {', '.join(known)}"
            raise RefusedError.of("no_such_zone", text, zone=zone)
        return zone

    def _call(self, asked: HTTPConnection, identity: Identity, body: bytes) -> Call:
        scope = asked.scope
        return Call(
            name=self._calls.new_name(),
            gateway=self._calls.gateway,
            caller=caller_of(identity),
            kind=scope["type"],
            method=scope.get("method", "GET"),
            path=scope["path"],
            query=scope["query_string"],
            headers=[(name, value) for name, value in scope["headers"] if name in PASSED_ON],
            body=body,
        )


def caller_of(identity: Identity) -> Caller:
    """An operator as a host is told of them."""
    return Caller(
        identity.account,
        identity.role,
        tuple(sorted(right.value for right in identity.rights)),
        identity.via,
        identity.address,
    )


async def _left(receive: Receive) -> None:
    """Wait until the client is gone."""
    while (await receive())["type"] != "http.disconnect":
        pass


async def _written(opened: OpenCall, send: Send) -> None:
    while True:
        match await opened.next():
            case Begun(status, headers):
                await send({"type": "http.response.start", "status": status, "headers": headers})
            case Part(bytes() as data, more):
                if not more:
                    opened.ended()
                await send({"type": "http.response.body", "body": data, "more_body": more})
                if not more:
                    return
            case _:
                raise CallLostError("the zone has another host now")
        await opened.written()


async def _heard(opened: OpenCall, socket: WebSocket) -> int | None:
    """Write to a socket what its zone says, until it is closed there."""
    parts: list[Any] = []
    while True:
        match await opened.next():
            case Part(data, more):
                parts.append(data)
                if not more:
                    whole, parts = parts[0][:0].join(parts), []
                    if isinstance(whole, str):
                        await socket.send_text(whole)
                    else:
                        await socket.send_bytes(whole)
            case Closed(code):
                return code or HOST_LOST
            case _:
                raise CallLostError("the answer is none of a socket")
        await opened.written()


async def _spoken(opened: OpenCall, socket: WebSocket) -> None:
    """Pass on what the client of a socket says, until it is gone."""
    while True:
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            return
        await opened.say(message.get("text") or "")


async def _look_up(standing: Standing) -> int:
    """Look an identity up again and again, until it opens nothing any more."""
    while True:
        await asyncio.sleep(callers.RENEWED_S)
        try:
            await standing.renew()
        except RefusedError:
            return IDENTITY_ENDED
        except StoreError:
            continue  # it is looked up again soon
