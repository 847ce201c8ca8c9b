"""Requests of operators that come to a zone of this host by way of gateways, and their answers.

Each is handed to an application as a server of HTTP would hand it, with the identity that the
gateway tells. All of it belongs to one event loop, which is not that of the ticks.
"""

import asyncio
from collections.abc import MutableMapping
from contextlib import suppress
from functools import partial
from http import HTTPStatus
from typing import Any, Final

import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg
from nats.aio.subscription import Subscription
from nats.errors import Error as NatsError
from starlette.types import ASGIApp

from esplanade.server.console.introduced import INTRODUCED
from esplanade.server.console.zone_paths import about_zone
from esplanade.server.link.calls import (
    ALIVE_S,
    PART_BYTES,
    PARTS_UNDER_WAY,
    SILENT_S,
    Added,
    Alive,
    Answered,
    Begun,
    Call,
    CallError,
    Closed,
    Gone,
    Part,
    Said,
    Written,
    decode_added,
    decode_call,
    encode_answered,
)
from esplanade.server.link.subjects import Subjects

MOST_CALLS: Final = 256
"""Requests that are under way at once; more are refused."""
MOST_WAITING: Final = 64
"""Messages of a socket's client that wait; with one more the socket is closed."""
TOO_MUCH: Final = 1008

log = structlog.get_logger(__name__)


class CallsIn:
    """Answers the requests about the zone that it listens for."""

    def __init__(self, app: ASGIApp, subjects: Subjects, broker: Client) -> None:
        self._app = app
        self._subjects = subjects
        self._broker = broker
        self._zone = ""
        self._subscriptions: list[Subscription] = []
        self._calls: dict[str, tuple[_Conversation, asyncio.Task[None]]] = {}
        self.refused = 0
        """Requests that could not be read, or that came when too many were under way."""

    async def listen(self, zone: str, epoch: int) -> None:
        """Take requests about a zone that this host owns since that epoch."""
        self._zone = zone
        subject = self._subjects.calls(zone, epoch)
        for name, take in ((subject, self._begin), (f"{subject}.*", self._add)):
            self._subscriptions.append(await self._broker.subscribe(name, cb=take))
        await self._broker.flush()

    async def rest(self) -> None:
        """Take no more requests, and break off those that are under way."""
        subscriptions, self._subscriptions = self._subscriptions, []
        for subscription in subscriptions:
            if not self._broker.is_closed:
                with suppress(NatsError):
                    await subscription.unsubscribe()
        tasks = [task for _, task in self._calls.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _begin(self, message: Msg) -> None:
        try:
            call = decode_call(message.data)
            subject = f"{self._subjects.called(call.gateway)}.{call.name}"
        except ValueError as error:
            self.refused += 1
            log.warning("bad request of an operator", error=str(error))
            return
        conversation = _Conversation(call, self._broker, subject)
        if len(self._calls) >= MOST_CALLS or call.name in self._calls:
            self.refused += 1
            await conversation.refuse()
            return
        task = asyncio.create_task(conversation.run(self._app, self._zone))
        self._calls[call.name] = conversation, task
        task.add_done_callback(partial(self._ended, call.name))

    async def _add(self, message: Msg) -> None:
        found = self._calls.get(message.subject.rpartition(".")[2])
        if found is None:
            return
        try:
            found[0].take(decode_added(message.data))
        except CallError as error:
            log.warning("bad part of a request of an operator", error=str(error))

    def _ended(self, name: str, task: "asyncio.Task[None]") -> None:
        del self._calls[name]
        if not task.cancelled() and (error := task.exception()) is not None:
            log.error("a request of an operator failed", exc_info=error)


class _Conversation:
    """One request, as an application of ASGI sees it."""

    def __init__(self, call: Call, broker: Client, subject: str) -> None:
        self._call = call
        self._broker = broker
        self._subject = subject
        self._number = self._written = 0
        self._room = asyncio.Event()
        self._room.set()
        self._heard_s = asyncio.get_running_loop().time()
        self._gone = asyncio.Event()
        self._said: asyncio.Queue[str] = asyncio.Queue(MOST_WAITING)
        self._ended = False

    async def run(self, app: ASGIApp, zone: str) -> None:
        """Have the request answered, unless its gateway or its client goes."""
        answering = asyncio.create_task(self._answer(app, zone))
        watching = asyncio.create_task(self._watch())
        try:
            await asyncio.wait({answering, watching}, return_when=asyncio.FIRST_COMPLETED)
            if not answering.done():
                # The application has a moment to take leave of who is gone.
                await asyncio.wait({answering}, timeout=ALIVE_S)
        finally:
            for task in (answering, watching):
                task.cancel()
            failed, _ = await asyncio.gather(answering, watching, return_exceptions=True)
            if isinstance(failed, Exception) and not isinstance(failed, OSError):
                log.error("a request of an operator failed", exc_info=failed)
            if not self._ended and not self._gone.is_set():
                await self.refuse()

    async def refuse(self) -> None:
        """Tell the gateway that no answer comes, or no more of it."""
        with suppress(NatsError):
            await self._publish(Closed(0))

    def take(self, added: Added) -> None:
        """Take in what the gateway says."""
        self._heard_s = asyncio.get_running_loop().time()
        match added:
            case Written(number):
                self._written = max(self._written, number)
                self._room.set()
            case Said(text):
                try:
                    self._said.put_nowait(text)
                except asyncio.QueueFull:
                    self._gone.set()
            case Gone():
                self._gone.set()
            case Alive():
                pass

    async def _answer(self, app: ASGIApp, zone: str) -> None:
        call, path = self._call, self._call.path
        scope: dict[str, Any] = {
            "type": call.kind,
            "asgi": {"version": "3.0", "spec_version": "2.3"},
            "http_version": "1.1",
            "scheme": "http" if call.kind == "http" else "ws",
            "path": path,
            "raw_path": path.encode(),
            "query_string": call.query,
            "root_path": "",
            "headers": call.headers,
            "client": (call.caller.address or "", 0),
            "server": None,
            "subprotocols": [],
            "state": {},
            INTRODUCED: call.caller,
        }
        if call.kind == "http":
            scope["method"] = call.method
        asked = iter([True])

        async def receive() -> dict[str, Any]:
            if next(asked, False):
                if call.kind == "websocket":
                    return {"type": "websocket.connect"}
                return {"type": "http.request", "body": call.body, "more_body": False}
            return await self._next()

        await app(about_zone(scope, zone), receive, self._send)

    async def _next(self) -> dict[str, Any]:
        """The next event of the client, once the request has been taken."""
        if self._call.kind == "http":
            await self._gone.wait()
            return {"type": "http.disconnect"}
        saying = asyncio.ensure_future(self._said.get())
        going = asyncio.ensure_future(self._gone.wait())
        try:
            await asyncio.wait({saying, going}, return_when=asyncio.FIRST_COMPLETED)
            if saying.done():
                return {"type": "websocket.receive", "text": saying.result()}
            return {"type": "websocket.disconnect", "code": TOO_MUCH}
        finally:
            saying.cancel()
            going.cancel()

    async def _send(self, event: MutableMapping[str, Any]) -> None:
        match event["type"]:
            case "http.response.start":
                await self._put(Begun(event["status"], list(event.get("headers", ()))))
            case "http.response.body":
                more = bool(event.get("more_body", False))
                await self._put_parts(bytes(event.get("body", b"")), more=more)
                self._ended = not more
            case "websocket.accept":
                await self._put(Begun(HTTPStatus.SWITCHING_PROTOCOLS, []))
            case "websocket.send":
                text = event.get("text")
                await self._put_parts(event["bytes"] if text is None else text, more=False)
            case "websocket.close":
                self._ended = True
                await self._put(Closed(int(event.get("code", 1000))))

    async def _put_parts(self, data: bytes | str, *, more: bool) -> None:
        """Send a message, or a part of an answer, in parts that a broker carries."""
        length = PART_BYTES if isinstance(data, bytes) else PART_BYTES // 4
        begins = range(0, max(1, len(data)), length)
        for begin in begins:
            is_last = begin == begins[-1]
            await self._put(Part(data[begin : begin + length], more or not is_last))

    async def _put(self, answered: Answered) -> None:
        """Send a part, once the gateway has written enough of those before."""
        while self._number - self._written >= PARTS_UNDER_WAY and not self._gone.is_set():
            self._room.clear()
            await self._room.wait()
        if self._gone.is_set():
            raise OSError("the client is gone")
        await self._publish(answered)

    async def _publish(self, answered: Answered) -> None:
        if not isinstance(answered, Alive):
            self._number += 1
        try:
            await self._broker.publish(self._subject, encode_answered(self._number, answered))
        except NatsError as error:
            raise OSError(f"the broker takes nothing: {error}") from None

    async def _watch(self) -> None:
        """Say that this end is there, until the other is not."""
        loop = asyncio.get_running_loop()
        while not self._gone.is_set():
            with suppress(OSError):
                await self._publish(Alive())
            with suppress(TimeoutError):
                async with asyncio.timeout(ALIVE_S):
                    await self._gone.wait()
            if loop.time() - self._heard_s > SILENT_S:
                self._gone.set()
        self._room.set()
