"""A thousand bots of this machine and a classroom behind one address come in by the defaults."""

import asyncio
import gc
import json
import struct
from pathlib import Path

import pytest

from esplanade.protocol import VERSION, ServerCode, encode
from esplanade.protocol.messages import Hello
from esplanade.server.net.connection import Connection
from tests.patience import PATIENCE_S
from tests.server.client import connected
from tests.server.conftest import Serving
from tests.server.net.test_session import HELLO

REQUEST = (
    b"GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n"
)
FIELD = {
    "name": "field",
    "bounds": [0, 0, 200, 200],
    "spawns": [{"position": [20 + 40 * k, 20 + 40 * n]} for k in range(5) for n in range(5)],
}


class Newcomer(asyncio.Protocol):
    """Comes in and looks at the first frame only: a thousand of them share a core with the server.

    `first` is the code of that frame, or None if the connection ended before.
    """

    def __init__(self) -> None:
        self.first: asyncio.Future[int | None] = asyncio.get_running_loop().create_future()
        self._begun = b""
        self._opened = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport
        transport.write(REQUEST)

    def data_received(self, data: bytes) -> None:
        if self.first.done():
            return
        self._begun += data
        if not self._opened and b"\r\n\r\n" in self._begun:
            head, _, self._begun = self._begun.partition(b"\r\n\r\n")
            if b" 101 " not in head:
                self.first.set_result(None)
                return
            self._opened = True
            self.transport.write(_masked(encode(Hello(name="Ann", version=VERSION))))
        if self._opened and len(self._begun) > 12:
            payload = self._begun[{126: 4, 127: 10}.get(self._begun[1], 2) :]
            # An array, and in it first the code, which takes one byte.
            self.first.set_result(payload[1])

    def connection_lost(self, exc: Exception | None) -> None:
        if not self.first.done():
            self.first.set_result(None)

    def leave(self) -> None:
        self.transport.write(_masked(struct.pack(">H", 1000), 0x88))
        self.transport.close()


async def newcomers(
    count: int, port: int, host: str, source: str, at_once: int = 200
) -> list[Newcomer]:
    """A number of people of one address, some at once, each in a connection of its own."""
    loop, came = asyncio.get_running_loop(), list[Newcomer]()
    for begin in range(0, count, at_once):
        made = await asyncio.gather(
            *(
                loop.create_connection(Newcomer, host, port, local_addr=(source, 0))
                for _ in range(begin, min(begin + at_once, count))
            )
        )
        group = [protocol for _, protocol in made]
        async with asyncio.timeout(PATIENCE_S):
            await asyncio.gather(*(each.first for each in group))
        came += group
    return came


async def test_the_defaults_admit_a_thousand_of_this_machine_and_a_classroom(
    serving: Serving, tmp_path: Path
) -> None:
    field = _field_file(tmp_path)
    try:
        (await asyncio.start_server(lambda *_: None, "::1", 0)).close()
    except OSError:
        pytest.skip("this machine has no ::1")
    async with serving(host="", scene=field) as server:
        classroom = await newcomers(60, server.port, "127.0.0.1", "127.0.0.2", at_once=60)
        assert [each.first.result() for each in classroom] == [ServerCode.WELCOME] * 60
        for each in classroom:
            each.leave()
        async with connected(server.port) as client:  # the classroom has gone when this one is in
            await client.send(Hello(name="Ann", version=VERSION))
            await client.wait_for(lambda: len(client.entities) == 1)
        for host in ("127.0.0.1", "::1"):
            came = await newcomers(500, server.port, host, host)
            assert [each.first.result() for each in came] == [ServerCode.WELCOME] * 500
        metrics = server.metrics.exposition()
        for refused in (b"sockets_refused", b"answers_refused", b"floods"):
            assert b"esplanade_%s_total{" % refused not in metrics


async def test_a_client_that_is_in_keeps_no_headers_and_no_hello(serving: Serving) -> None:
    gc.collect()
    before = {id(each) for each in gc.get_objects()}  # other tests may keep a hello
    async with serving() as server, connected(server.port) as client:
        await client.connection.send(HELLO)
        await client.ticks(2)
        gc.collect()
        made = [each for each in gc.get_objects() if id(each) not in before]
        assert not [each for each in made if type(each) is Hello]
        (kept,) = [each for each in made if type(each) is Connection]
        assert kept.request is not None
        assert len(kept.request.headers) == 0
        assert kept.response is None


def _field_file(folder: Path) -> Path:
    path = folder / "field.json"
    path.write_text(json.dumps(FIELD))
    return path


def _masked(payload: bytes, head: int = 0x82) -> bytes:
    """A client's short frame with a mask of zeros."""
    return struct.pack(">BB", head, 0x80 | len(payload)) + bytes(4) + payload
