"""Faults of clients: each has a name and a close code, and the world goes on."""

import asyncio
import os
import struct

import msgpack
import pytest

from esplanade.protocol import VERSION, ClientCode, CloseCode, ErrorCode, encode
from esplanade.protocol.codes import MAX_CLIENT_FRAME_BYTES
from esplanade.protocol.messages import ChatLine, Error, Hello, Move, Ping, Pong, Welcome
from esplanade.server.net import session
from tests.server.client import connected, joined
from tests.server.conftest import Serving

HELLO = encode(Hello(name="Ann", version=VERSION))


@pytest.mark.parametrize(
    ("frame", "error", "close"),
    [
        (
            encode(Hello(name="Ann", version=VERSION + 1)),
            ErrorCode.UNSUPPORTED_VERSION,
            CloseCode.UNSUPPORTED_VERSION,
        ),
        (
            msgpack.packb([1, {"who": "Ann", "version": VERSION + 1, "of": "a later version"}]),
            ErrorCode.UNSUPPORTED_VERSION,
            CloseCode.UNSUPPORTED_VERSION,
        ),
        (b"\xc1garbage", ErrorCode.MALFORMED, CloseCode.MALFORMED),
        (b"", ErrorCode.MALFORMED, CloseCode.MALFORMED),
        ("text", ErrorCode.MALFORMED, CloseCode.MALFORMED),
        (msgpack.packb([250, {}]), ErrorCode.INVALID, CloseCode.INVALID),
        (msgpack.packb([1, {"name": 5, "version": VERSION}]), ErrorCode.INVALID, CloseCode.INVALID),
        (
            msgpack.packb([1, {"name": " ", "version": VERSION}]),
            ErrorCode.INVALID,
            CloseCode.INVALID,
        ),
        (encode(Ping(nonce=1)), ErrorCode.HELLO_EXPECTED, CloseCode.HELLO_EXPECTED),
        (bytes(MAX_CLIENT_FRAME_BYTES + 1), ErrorCode.TOO_LARGE, CloseCode.TOO_LARGE),
    ],
    ids=["version", "unlike", "garbage", "empty", "text", "code", "type", "name", "ping", "large"],
)
async def test_a_bad_first_message_is_refused_by_name(
    serving: Serving, frame: bytes | str, error: ErrorCode, close: CloseCode
) -> None:
    async with serving() as server, connected(server.port) as client:
        await client.connection.send(frame)
        assert await client.refusal() == (error.value, close)
        async with joined(server.port) as other:
            assert other.position


async def test_a_server_may_speak_several_versions(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A client is told which one it is spoken to in, and a refusal names all of them."""
    monkeypatch.setattr(session, "SERVED_VERSIONS", (VERSION, VERSION + 1))
    async with serving() as server:
        for version in (VERSION, VERSION + 1):
            async with connected(server.port) as client:
                await client.send(Hello(name="Ann", version=version))
                assert (await client.until(Welcome)).version == version
        for version in (VERSION - 1, VERSION + 2):
            async with connected(server.port) as client:
                await client.send(Hello(name="Ann", version=version))
                error = await client.until(Error)
                assert error.text == (
                    f"this server speaks version {VERSION} and {VERSION + 1}, the client {version}"
                )


async def test_a_welcome_has_what_a_client_predicts_with(serving: Serving) -> None:
    changes = {"resume_seconds": 12.5, "person_radius_m": 0.3, "person_walk_speed_mps": 1.2}
    async with serving(person_max_speed_mps=2.0, **changes) as server, joined(server.port) as ann:
        assert ann.welcome is not None
        assert ann.welcome.resume_seconds == 12.5
        assert ann.welcome.radius == ann.welcome.clearance == 0.3
        assert (ann.welcome.walk_speed, ann.welcome.max_speed) == (1.2, 2.0)
    async with (
        serving(person_walk_speed_mps=3.0, person_max_speed_mps=2.0) as server,
        joined(server.port) as ann,
    ):
        assert ann.welcome is not None
        assert ann.welcome.walk_speed == 2.0


@pytest.mark.parametrize(
    ("frame", "error", "close"),
    [
        (HELLO, ErrorCode.INVALID, CloseCode.INVALID),
        (os.urandom(64) + b"\xc1", ErrorCode.MALFORMED, CloseCode.MALFORMED),
        (
            msgpack.packb([ClientCode.MOVE, {"seq": 1, "direction": float("nan"), "speed": 1.0}]),
            ErrorCode.INVALID,
            CloseCode.INVALID,
        ),
        (bytes(MAX_CLIENT_FRAME_BYTES + 1), ErrorCode.TOO_LARGE, CloseCode.TOO_LARGE),
    ],
    ids=["hello", "garbage", "nan", "large"],
)
async def test_a_bad_later_message_ends_the_person(
    serving: Serving, frame: bytes, error: ErrorCode, close: CloseCode
) -> None:
    async with (
        serving() as server,
        joined(server.port) as other,
        joined(server.port, "Ben") as client,
    ):
        await other.wait_for(lambda: client.id in other.positions)
        await client.connection.send(frame)
        assert await client.refusal() == (error.value, close)
        await other.wait_for(lambda: client.id not in other.positions)


async def test_a_frame_beyond_all_bounds_is_not_even_read(serving: Serving) -> None:
    async with (
        serving(resume_seconds=0.0) as server,
        joined(server.port, "Eve") as eve,
        joined(server.port) as client,
    ):
        await eve.wait_for(lambda: client.id in eve.positions)
        await client.connection.send(bytes(1_000_000))
        _, code = await client.last_words()
        assert code == CloseCode.TOO_LARGE
        await eve.wait_for(lambda: client.id not in eve.positions)
    assert b'esplanade_closes_total{reason="message_too_big"} 1.0' in server.metrics.exposition()


async def test_garbage_below_the_websocket_layer_harms_nobody(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as other:
        async with connected(server.port) as client:
            client.connection.transport.write(struct.pack(">BB", 0xFF, 0xFF) + os.urandom(500))
            await client.connection.wait_closed()
        await other.until_tick(server.world.tick + 3)
    assert b'esplanade_closes_total{reason="protocol_error"} 1.0' in server.metrics.exposition()


async def test_flooding_ends_the_connection(serving: Serving) -> None:
    async with serving(message_rate=5.0) as server, joined(server.port) as client:
        for seq in range(50):
            client.connection.transport.write(_masked(Move(seq=seq, direction=0.0, speed=1.0)))
        assert await client.refusal() == (ErrorCode.FLOODING.value, CloseCode.FLOODING)


async def test_who_says_no_hello_in_time_is_sent_away(serving: Serving) -> None:
    async with serving(hello_timeout_s=0.1) as server, connected(server.port) as client:
        assert await client.refusal() == (ErrorCode.HELLO_TIMEOUT.value, CloseCode.HELLO_TIMEOUT)


async def test_talking_too_fast_is_told_but_forgiven(serving: Serving) -> None:
    async with serving(chat_rate=0.01) as server, joined(server.port) as client:
        for _ in range(6):
            await client.send(ChatLine(text="hello"))
        error = await client.until(Error)
        assert error.error is ErrorCode.FLOODING
        await client.ticks(2)


async def test_pong_carries_the_nonce_and_a_running_time(serving: Serving) -> None:
    clock = asyncio.get_running_loop().time
    async with serving() as server, joined(server.port) as client:
        asked_s = clock()
        await client.send(Ping(nonce=77))
        first = await client.until(Pong)
        await client.until_tick(int(20.0 * first.server_time) + 4)
        await client.send(Ping(nonce=78))
        second = await client.until(Pong)
        assert (first.nonce, second.nonce) == (77, 78)
        assert second.server_time > first.server_time
        # A tick never begins before its time, and a world that is late never hurries after it.
        assert second.server_time - first.server_time <= clock() - asked_s
        assert second.server_time >= client.tick / 20.0


async def test_errors_are_counted_by_name(serving: Serving) -> None:
    async with serving() as server:
        async with connected(server.port) as client:
            await client.connection.send(b"\xc1")
            await client.refusal()
        assert b'esplanade_errors_total{code="malformed"} 1.0' in server.metrics.exposition()


def _masked(message: Move) -> bytes:
    """A client's frame with a mask of zeros, to be written without waiting."""
    payload = encode(message)
    return struct.pack(">BB", 0x82, 0x80 | len(payload)) + bytes(4) + payload
