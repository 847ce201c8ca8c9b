"""A client that floods is closed by name, and nobody else is the worse for it."""

import asyncio
import struct
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from itertools import cycle
from typing import Final

import pytest
import structlog

from esplanade.protocol import VERSION, CloseCode, ErrorCode, encode
from esplanade.protocol.messages import Hello, Ping, Pong
from esplanade.server.app import Running
from esplanade.server.net import connection
from esplanade.server.net.metering import MAX_HEAD_BYTES
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving

MASK: Final = bytes(4)
PING: Final = b"\x89\x80" + MASK
PONG: Final = b"\x8a\x80" + MASK
EMPTY_FRAGMENT: Final = b"\x00\x80" + MASK
FIRST_FRAGMENT: Final = b"\x02\x80" + MASK
TEXT: Final = b"\x81\x82" + MASK + b"hi"
MESSAGE: Final = b"\x82" + bytes([0x80 | len(encode(Ping(nonce=1)))]) + MASK + encode(Ping(nonce=1))


@pytest.mark.parametrize(
    "frames",
    [
        PING * 1000,
        PONG * 1000,
        FIRST_FRAGMENT + EMPTY_FRAGMENT * 1000,
        TEXT * 1000,
        MESSAGE * 1000,
        b"\x88\x80" + MASK + PING * 1000,
    ],
    ids=["pings", "pongs", "empty fragments", "text", "messages", "behind a close"],
)
async def test_a_flood_is_closed_by_name_before_it_is_parsed(
    serving: Serving, frames: bytes
) -> None:
    async with serving() as server, joined(server.port) as other:
        with structlog.testing.capture_logs() as lines:
            async with joined(server.port, "Ben") as client:
                client.connection.transport.write(frames)
                assert await client.refusal() == (ErrorCode.FLOODING.value, CloseCode.FLOODING)
        # Nothing of the chunk was parsed: no pong and no answer came back.
        assert server.metrics.traffic.messages_in == 2  # the two hellos
        await other.ticks(5)
        await other.wait_for(lambda: len(other.entities) == 1)
        metrics = server.metrics.exposition()
    assert b'esplanade_floods_total{what="frames"} 1.0' in metrics
    assert b'esplanade_closes_total{reason="flooding"} 1.0' in metrics
    assert b'esplanade_errors_total{code="flooding"} 1.0' in metrics
    (line,) = [line for line in lines if line["event"] == "client closed, it floods"]
    assert (line["address"], line["why"], line["log_level"]) == ("127.0.0.1", "frames", "warning")


@pytest.mark.parametrize(
    ("frame", "size"), [(PING, 6), (PING, 3), (PING, 1), (MESSAGE, 1)], ids=str
)
async def test_a_flood_of_small_writes_is_closed_by_name(
    serving: Serving, frame: bytes, size: int
) -> None:
    """Half a head, or a single byte, at a time: each costs the server as much as a frame."""
    async with serving(message_rate=5.0) as server, joined(server.port) as other:
        async with joined(server.port, "Ben") as client:
            end = asyncio.create_task(client.refusal())
            pieces = cycle(frame[begin : begin + size] for begin in range(0, len(frame), size))
            while not end.done():
                # The client's library learns of the end some moments after its transport.
                if not client.connection.transport.is_closing():
                    client.connection.transport.write(next(pieces))
                await asyncio.sleep(0.001)
            assert await end == (ErrorCode.FLOODING.value, CloseCode.FLOODING)
        await other.ticks(3)


async def test_a_frame_that_never_ends_is_closed_by_name(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "FRAME_S", 0.2)
    async with serving() as server, joined(server.port) as other:
        async with joined(server.port, "Ben") as client:
            client.connection.transport.write(b"\x82")
            assert await client.refusal() == (ErrorCode.MALFORMED.value, CloseCode.MALFORMED)
        # One that is whole in time is a frame like any other.
        other.connection.transport.write(MESSAGE[:3])
        await other.ticks(1)
        other.connection.transport.write(MESSAGE[3:] + MESSAGE)
        await other.ticks(10)
    assert b'esplanade_floods_total{what="slow_frame"} 1.0' in server.metrics.exposition()


async def test_a_large_frame_in_chunks_is_charged_by_its_bytes(serving: Serving) -> None:
    async with serving(message_rate=1.0) as server, joined(server.port) as client:
        fragment = struct.pack(">BBH", 0x02, 0x80 | 126, 2000) + MASK + bytes(2000)
        more = b"\x00" + fragment[1:]
        for frame in [fragment, *[more] * 50]:
            client.connection.transport.write(frame)
        error, code = await client.refusal()
        assert (error, code) == (ErrorCode.FLOODING.value, CloseCode.FLOODING)


async def test_whoever_floods_does_not_wait_to_come_back(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port) as other,
        joined(server.port, "Ben") as client,
    ):
        await other.wait_for(lambda: client.id in other.positions)
        client.connection.transport.write(PING * 1000)
        await client.refusal()
        await other.wait_for(lambda: client.id not in other.positions)


async def test_a_client_that_goes_on_flooding_is_not_read(serving: Serving) -> None:
    """It writes megabytes and never reads; the connection ends, and nobody is held up."""
    async with serving() as server, joined(server.port) as other:
        async with handshaken(server) as (_, writer):
            writer.write(_frame(encode(Hello(name="Ben", version=VERSION))))
            with pytest.raises(ConnectionError):
                await _write_for_ever(writer, PING * 10_000)
        await other.ticks(3)
        assert server.metrics.traffic.bytes_in < 1000


async def test_pings_before_the_handshake_are_charged(serving: Serving) -> None:
    async with serving() as server:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        writer.write(b"GET /ws HTTP/1.1\r\nHost: localhost\r\n\r\n" + PING * 1000)
        assert await _read_all(reader) == b""
        writer.close()
        assert b'esplanade_floods_total{what="frames"} 1.0' in server.metrics.exposition()


async def test_a_request_that_is_too_long_is_cut_off(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as other:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        writer.write(b"GET / HTTP/1.1\r\n" + b"X-Filling: 123456789\r\n" * (MAX_HEAD_BYTES // 20))
        assert await _read_all(reader) == b""
        writer.close()
        await other.ticks(1)
        assert b'esplanade_floods_total{what="request"} 1.0' in server.metrics.exposition()


async def test_what_is_within_the_rate_goes_on(serving: Serving) -> None:
    """Messages, pings and pongs at the rate that is documented, for longer than a burst lasts."""
    async with serving(message_rate=20.0) as server, joined(server.port) as client:
        for _ in range(4):
            for _ in range(20):
                await client.send(Ping(nonce=1))
            for _ in range(4):
                client.connection.transport.write(PONG)
            await client.ticks(22)
        await client.ticks(2)
        assert b"esplanade_floods_total{" not in server.metrics.exposition()


async def test_clients_of_one_address_wait_for_each_other(serving: Serving) -> None:
    """One sends more at once than its address may; the other is not read until that is paid."""
    hello, clock = _frame(encode(Hello(name="Ben", version=VERSION))), time.monotonic
    async with (
        serving(address_frames=20) as server,
        joined(server.port) as other,
        handshaken(server, "127.0.0.2") as (busy_reader, busy),
        handshaken(server, "127.0.0.2") as (quiet_reader, quiet),
    ):
        for writer in (busy, quiet):
            writer.write(hello)
        began_s = clock()
        busy.write(b"".join(_frame(encode(Ping(nonce=nonce))) for nonce in range(60)))
        await _read_pong(busy_reader, 59)
        quiet.write(_frame(encode(Ping(nonce=1))))
        await _read_pong(quiet_reader, 1)
        assert clock() - began_s > 60 / 20 - 0.5  # a quarter of a second may be saved up
        await other.ticks(3)
        assert server.metrics.traffic.messages_in == 3 + 60 + 1
        assert b"esplanade_floods_total{" not in server.metrics.exposition()


async def test_the_server_ends_a_connection_that_the_library_has_failed(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A client that breaks the protocol and then stays is cut off soon."""
    monkeypatch.setattr(connection, "CLOSE_S", 0.2)
    async with serving() as server, handshaken(server) as (reader, writer):
        writer.write(b"\xff\xff")  # no frame at all
        assert b"\x88" in await _read_all(reader)
        # This client never closes: a read that ends shows that the server has only half closed.
        with pytest.raises(ConnectionError):
            await _write_for_ever(writer, b"x")


@asynccontextmanager
async def handshaken(
    server: Running, address: str = "127.0.0.1"
) -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter]]:
    """A bare WebSocket connection, to be written to as no library would."""
    reader, writer = await asyncio.open_connection(
        "127.0.0.1", server.port, local_addr=(address, 0)
    )
    writer.write(
        b"GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n"
    )
    async with asyncio.timeout(PATIENCE_S):
        assert b" 101 " in await reader.readuntil(b"\r\n\r\n")
    yield reader, writer
    writer.close()


async def _read_pong(reader: asyncio.StreamReader, nonce: int) -> None:
    wanted, received = encode(Pong(nonce=nonce, server_time=0.0))[:-8], b""
    async with asyncio.timeout(PATIENCE_S):
        while wanted not in received:
            received += await reader.read(65_536)


async def _write_for_ever(writer: asyncio.StreamWriter, data: bytes) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while True:
            writer.write(data)
            await writer.drain()
            await asyncio.sleep(0.001)


async def _read_all(reader: asyncio.StreamReader) -> bytes:
    async with asyncio.timeout(PATIENCE_S):
        try:
            return await reader.read()
        except ConnectionResetError:
            return b""


def _frame(payload: bytes) -> bytes:
    return struct.pack(">BB", 0x82, 0x80 | len(payload)) + MASK + payload
