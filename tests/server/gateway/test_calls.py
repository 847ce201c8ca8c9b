"""Requests of operators go to the host of a zone and come back, in order, bounded and in time."""

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from esplanade.server.console.introduced import INTRODUCED
from esplanade.server.console.zone_paths import zone_of
from esplanade.server.gateway import calls_out
from esplanade.server.gateway.calls_out import CallLostError, CallsOut, NoHostError, OpenCall
from esplanade.server.host import calls_in
from esplanade.server.host.calls_in import CallsIn
from esplanade.server.link import calls
from esplanade.server.link.broker import connected
from esplanade.server.link.calls import PARTS_UNDER_WAY, Begun, Call, Caller, Closed, Part
from esplanade.server.link.subjects import Subjects
from tests.patience import PATIENCE_S
from tests.server.brokers import NatsServer, nats_server

SUBJECTS = Subjects("town")
EPOCH = 7
OLGA = Caller("olga", "tuner", ("parameters", "watch"), "session", "192.0.2.7")


@pytest.fixture(scope="module")
def broker() -> Iterator[NatsServer]:
    with nats_server() as server:
        yield server


class Application:
    """An application that answers as each path says, and keeps what it was asked."""

    def __init__(self) -> None:
        self.scopes: list[dict[str, Any]] = []
        self.sent = 0
        self.gone = asyncio.Event()

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        self.scopes.append(scope)
        if scope["type"] == "websocket":
            await self._talk(receive, send)
            return
        body = (await receive())["body"]
        match scope["path"]:
            case "/echo":
                await send(
                    {"type": "http.response.start", "status": 201, "headers": [(b"a", b"b")]}
                )
                await send({"type": "http.response.body", "body": body * 3})
            case "/endless":
                await send({"type": "http.response.start", "status": 200})
                try:
                    while True:
                        await send({"type": "http.response.body", "body": b"x", "more_body": True})
                        self.sent += 1
                except OSError:
                    self.gone.set()
            case "/slow":
                try:
                    await receive()
                finally:
                    self.gone.set()
            case _:
                raise RuntimeError("this path fails")

    async def _talk(self, receive: Any, send: Any) -> None:
        assert (await receive())["type"] == "websocket.connect"
        await send({"type": "websocket.accept"})
        while (message := await receive())["type"] == "websocket.receive":
            await send({"type": "websocket.send", "text": message["text"] * 100_000})
            await send({"type": "websocket.send", "bytes": b"\0" * 600_000})
        self.gone.set()


def call(out: CallsOut, path: str, kind: Any = "http", body: bytes = b"") -> Call:
    return Call(out.new_name(), out.gateway, OLGA, kind, "POST", path, b"q=1", [], body)


@asynccontextmanager
async def both(broker: NatsServer, app: Application) -> AsyncIterator[tuple[CallsIn, CallsOut]]:
    """A host that answers by an application, and a gateway that knows of the host."""

    async def owner(zone: str, _: bool) -> int | None:
        return {"yard": EPOCH, "hall": EPOCH + 1}.get(zone)

    async with (
        connected([broker.address], "host") as ours,
        connected([broker.address], "gateway") as theirs,
    ):
        inward, out = CallsIn(app, SUBJECTS, ours), CallsOut("east", SUBJECTS, owner)
        await inward.listen("yard", EPOCH)
        async with out.over(theirs):
            yield inward, out
        await inward.rest()


async def whole(opened: OpenCall) -> tuple[int, bytes]:
    begun, body = await opened.next(), b""
    assert isinstance(begun, Begun)
    while True:
        part = await opened.next()
        assert isinstance(part, Part)
        assert isinstance(part.data, bytes)
        body += part.data
        await opened.written()
        if not part.more:
            opened.ended()
            return begun.status, body


async def test_a_request_is_answered_as_by_a_server_and_says_who_asks(broker: NatsServer) -> None:
    app, body = Application(), bytes(range(256)) * 3000
    async with both(broker, app) as (_, out):
        async with out.begun("yard", call(out, "/echo", body=body)) as opened:
            assert await whole(opened) == (201, body * 3)
        (scope,) = app.scopes
        assert (scope["path"], scope["query_string"], zone_of(scope)) == ("/echo", b"q=1", "yard")
        assert scope[INTRODUCED] == OLGA
        assert out.under_way == 0


async def test_a_socket_carries_texts_and_bytes_of_any_length(broker: NatsServer) -> None:
    app = Application()
    async with both(broker, app) as (_, out):
        async with out.begun("yard", call(out, "/talk", "websocket")) as opened:
            assert isinstance(await opened.next(), Begun)
            for text in ("ä", "b"):
                await opened.say(text)
                parts: list[Any] = []
                while len(b"".join(part for part in parts if isinstance(part, bytes))) < 600_000:
                    part = await opened.next()
                    assert isinstance(part, Part)
                    parts.append(part.data)
                    await opened.written()
                assert "".join(part for part in parts if isinstance(part, str)) == text * 100_000
        await asyncio.wait_for(app.gone.wait(), PATIENCE_S)


async def test_no_more_is_under_way_than_is_read_and_who_leaves_ends_it(
    broker: NatsServer,
) -> None:
    app = Application()
    async with both(broker, app) as (_, out):
        async with out.begun("yard", call(out, "/endless")) as opened:
            while app.sent < PARTS_UNDER_WAY - 1:  # noqa: ASYNC110 - nothing tells of it
                await asyncio.sleep(0.01)
            await asyncio.sleep(0.3)
            assert app.sent < PARTS_UNDER_WAY  # the begin of the answer is one of them
            for _ in range(3):
                await opened.next()
            await opened.written()
            while app.sent < PARTS_UNDER_WAY + 2:  # noqa: ASYNC110
                await asyncio.sleep(0.01)
        await asyncio.wait_for(app.gone.wait(), PATIENCE_S)


async def test_a_zone_without_a_host_is_told_at_once(broker: NatsServer) -> None:
    async with both(broker, Application()) as (_, out):
        for zone in ("hall", "attic"):
            with pytest.raises(NoHostError):
                async with asyncio.timeout(calls.SILENT_S / 2), out.begun(zone, call(out, "/echo")):
                    raise AssertionError("nobody answers")
        assert out.under_way == 0


async def test_a_request_that_fails_or_is_broken_off_is_told(broker: NatsServer) -> None:
    app = Application()
    async with both(broker, app) as (inward, out):
        async with out.begun("yard", call(out, "/fails")) as opened:
            assert await opened.next() == Closed(0)
        async with out.begun("yard", call(out, "/slow")) as opened:
            await inward.rest()
            assert await opened.next() == Closed(0)
        await asyncio.wait_for(app.gone.wait(), PATIENCE_S)


async def test_a_gateway_that_is_silent_is_gone(
    broker: NatsServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calls_out, "ALIVE_S", 3600.0)
    monkeypatch.setattr(calls_in, "ALIVE_S", 0.05)
    monkeypatch.setattr(calls_in, "SILENT_S", 0.5)
    app = Application()
    async with both(broker, app) as (_, out), out.begun("yard", call(out, "/slow")):
        await asyncio.wait_for(app.gone.wait(), PATIENCE_S)


async def test_a_host_that_is_silent_is_lost(
    broker: NatsServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calls_in, "ALIVE_S", 3600.0)
    async with (
        both(broker, Application()) as (_, out),
        out.begun("yard", call(out, "/slow")) as opened,
    ):
        monkeypatch.setattr(calls_out, "SILENT_S", 0.3)
        with pytest.raises(CallLostError, match="does not answer"):
            await opened.next()
