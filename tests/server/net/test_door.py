"""Limits of one address, with real sockets: 127.0.0.2 is an address like any other."""

import asyncio
import errno
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import pytest
import structlog
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidStatus
from websockets.http11 import Response

from esplanade.protocol import VERSION, encode
from esplanade.protocol.messages import Hello
from esplanade.server.app import Running
from esplanade.server.net.refusals import LINES_BURST
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.http import get

REQUEST = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"


async def test_open_connections_of_an_address_are_limited_and_named(serving: Serving) -> None:
    async with serving(address_sockets=5) as server:
        with structlog.testing.capture_logs() as lines:
            async with silent(server, "127.0.0.2", 30) as readers:
                assert await ended(readers[5:]) == 25
                assert (await get(server.port, "/")).status == 200
                async with joined(server.port) as client:
                    await client.ticks(2)
                async with silent(server, "127.0.0.3", 1) as others:
                    assert not others[0].at_eof()
        metrics = server.metrics.exposition()
        assert b'esplanade_sockets_refused_total{why="address_sockets"} 25.0' in metrics
        named = [line for line in lines if line["event"] == "connection refused"]
        assert [(line["address"], line["why"], line["times"]) for line in named] == [
            ("127.0.0.2", "address_sockets", 1)
        ]


async def test_a_connection_that_ends_makes_room(serving: Serving) -> None:
    async with serving(address_sockets=1) as server:
        for _ in range(20):
            answer = await ask(server, "127.0.0.2")
            assert answer.startswith(b"HTTP/1.1 200 ")
            await gone(server)


async def test_new_connections_of_an_address_are_limited(serving: Serving) -> None:
    async with serving(address_connects=3) as server:
        asked = [ask(server, "127.0.0.2") for _ in range(5)]
        assert sum(bool(answer) for answer in await asyncio.gather(*asked)) == 3
        assert await ask(server, "127.0.0.3")
        assert b'refused_total{why="address_connects"} 2.0' in server.metrics.exposition()


async def test_joins_of_an_address_are_limited(serving: Serving) -> None:
    async with serving(address_joins=2) as server:
        came = await asyncio.gather(*[refusal(server, "127.0.0.2") for _ in range(40)])
        refused = [each for each in came if each is not None]
        assert came.count(None) >= 2
        assert refused
        assert {each.status_code for each in refused} == {503}
        assert {each.headers["Retry-After"] for each in refused} == {"5"}
        async with person(server, local_addr=("127.0.0.3", 0)), joined(server.port):
            pass
        told = f'answers_refused_total{{why="address_joins"}} {len(refused)}.0'
        assert told.encode() in server.metrics.exposition()


async def test_silent_connections_keep_out_only_others_of_their_address(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The port is full of them; a newcomer from elsewhere takes the place of the oldest."""
    monkeypatch.setattr("esplanade.server.net.listener.MAX_UNGREETED", 2)
    monkeypatch.setattr("esplanade.server.net.listener.MAX_VISITS", 5)
    async with serving(max_clients=3) as server, joined(server.port) as first:
        async with silent(server, "127.0.0.2", 20) as readers:
            assert await ended(readers[9:]) == 11  # nine places are left beside the person's
            async with joined(server.port) as second:
                assert await ended(readers[:1]) == 1
                assert (await get(server.port, "/")).status == 200
                assert (await ask(server, "127.0.0.3")).startswith(b"HTTP/1.1 200 ")
                await first.ticks(3)
                await second.ticks(3)
            assert not readers[8].at_eof()
        assert b'sockets_refused_total{why="port_full"}' in server.metrics.exposition()


async def test_this_machine_has_no_limits_in_ipv6_either(serving: Serving) -> None:
    async with serving(host="::1", address_sockets=1, address_joins=1) as server:
        url = f"ws://[::1]:{server.port}/ws"
        async with connect(url, proxy=None) as first, connect(url, proxy=None) as second:
            for each in (first, second):
                await each.send(encode(Hello(name="Six", version=VERSION)))
                assert await each.recv()


async def test_a_trusted_proxy_has_no_limits_and_its_clients_do(serving: Serving) -> None:
    async with serving(
        trusted_proxies="127.0.0.2/32", address_sockets=2, address_connects=50, address_joins=50
    ) as server:
        async with silent(server, "127.0.0.2", 10) as readers:
            assert not any_ended(readers)
            async with behind(server, "203.0.113.9"), behind(server, "203.0.113.9"):
                assert await status_behind(server, "203.0.113.9") == 503
                # A client may write into the header what it likes: the proxy appends the truth.
                assert await status_behind(server, "127.0.0.1, 203.0.113.9") == 503
                assert await status_behind(server, "198.51.100.1, 203.0.113.9") == 503
                assert await status_behind(server, "203.0.113.10") == 200
                assert await status_behind(server, "203.0.113.9, 203.0.113.10") == 200
            await gone(server, left=10)
            assert await status_behind(server, "203.0.113.9") == 200
        assert b'why="address_sockets"} 3.0' in server.metrics.exposition()


async def test_addresses_of_one_ipv6_network_are_one(serving: Serving) -> None:
    async with (
        serving(trusted_proxies="127.0.0.2", address_sockets=2) as server,
        behind(server, "2001:db8:1:2::1"),
        behind(server, "2001:db8:1:2:ffff::9"),
    ):
        assert await status_behind(server, "2001:db8:1:2:3:4:5:6") == 503
        assert await status_behind(server, "2001:db8:1:3::1") == 200


async def test_strangers_cannot_say_who_they_are(serving: Serving) -> None:
    """A client that is no trusted proxy is counted by the address of its socket."""
    async with (
        serving(trusted_proxies="127.0.0.9", address_sockets=2) as server,
        behind(server, "203.0.113.1"),
        behind(server, "203.0.113.2"),
        silent(server, "127.0.0.2", 1) as readers,
    ):
        assert await ended(readers) == 1


async def test_lines_of_the_log_are_bounded(serving: Serving) -> None:
    async with serving(address_connects=1, address_sockets=1) as server:
        with structlog.testing.capture_logs() as lines:
            for number in range(2, 2 + 2 * int(LINES_BURST)):
                async with silent(server, f"127.0.1.{number}", 3) as readers:
                    assert await ended(readers[1:]) == 2
        told = [line for line in lines if line["event"] == "connection refused"]
        assert 0 < len(told) < 2 * LINES_BURST
        total = 4.0 * LINES_BURST
        assert f'why="address_sockets"}} {total}'.encode() in server.metrics.exposition()


async def test_a_process_without_descriptors_lets_connections_wait(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving() as server, joined(server.port) as client:
        accept, full = socket.socket.accept, True

        def exhausted(listening: socket.socket) -> tuple[socket.socket, object]:
            if full:
                raise OSError(errno.EMFILE, "Too many open files")
            return accept(listening)

        monkeypatch.setattr(socket.socket, "accept", exhausted)
        asking = asyncio.create_task(ask(server, "127.0.0.1"))
        async with asyncio.timeout(PATIENCE_S):
            while b'why="no_descriptor"' not in server.metrics.exposition():  # noqa: ASYNC110
                await asyncio.sleep(0.01)
        await client.ticks(3)
        full = False
        assert (await asking).startswith(b"HTTP/1.1 200 ")


async def test_an_accept_that_fails_does_not_close_the_door(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving() as server:
        with monkeypatch.context() as patch:
            patch.setattr("esplanade.server.net.connections.address_key", lambda text: 1 / 0)
            assert await ask(server, "127.0.0.2") == b""
        assert (await ask(server, "127.0.0.2")).startswith(b"HTTP/1.1 200 ")


@asynccontextmanager
async def silent(
    server: Running, address: str, number: int
) -> AsyncIterator[list[asyncio.StreamReader]]:
    """Connections that say nothing."""
    streams = [
        await asyncio.open_connection("127.0.0.1", server.port, local_addr=(address, 0))
        for _ in range(number)
    ]
    yield [reader for reader, _ in streams]
    for _, writer in streams:
        writer.close()
    for _, writer in streams:
        with suppress(ConnectionError):
            await writer.wait_closed()


async def ended(readers: list[asyncio.StreamReader]) -> int:
    """Wait until the server has ended all of these; the number of them."""
    async with asyncio.timeout(PATIENCE_S):
        for reader in readers:
            with suppress(ConnectionError):
                assert await reader.read() == b""
    return len(readers)


def any_ended(readers: list[asyncio.StreamReader]) -> bool:
    """Whether the server has ended any of these so far."""
    return any(reader.at_eof() or reader.exception() for reader in readers)


async def ask(server: Running, address: str, forwarded: str | None = None) -> bytes:
    """The whole answer to a request for the page; nothing if the connection was refused."""
    reader, writer = await asyncio.open_connection(
        "127.0.0.1", server.port, local_addr=(address, 0)
    )
    line = b"" if forwarded is None else f"X-Forwarded-For: {forwarded}\r\n".encode()
    answer = b""
    async with asyncio.timeout(PATIENCE_S):
        try:
            writer.write(REQUEST[:-2] + line + b"\r\n")
            answer = await reader.read()
        except ConnectionError:
            pass
    writer.close()
    return answer


async def gone(server: Running, left: int = 0) -> None:
    """Wait until only so many connections are open."""
    line = f"esplanade_sockets {left}.0".encode()
    async with asyncio.timeout(PATIENCE_S):
        while line not in server.metrics.exposition():  # noqa: ASYNC110
            await asyncio.sleep(0.01)


@asynccontextmanager
async def person(server: Running, **options: object) -> AsyncIterator[ClientConnection]:
    url = f"ws://127.0.0.1:{server.port}/ws"
    async with connect(url, proxy=None, **options) as connection:  # type: ignore[arg-type]
        yield connection


async def refusal(server: Running, address: str) -> Response | None:
    """The answer that refuses a WebSocket from an address; None where it is let in."""
    try:
        async with person(server, local_addr=(address, 0)):
            return None
    except InvalidStatus as refused:
        return refused.response


@asynccontextmanager
async def behind(server: Running, forwarded: str) -> AsyncIterator[ClientConnection]:
    """A WebSocket that comes from 127.0.0.2, which says for whom."""
    async with person(
        server,
        local_addr=("127.0.0.2", 0),
        additional_headers={"X-Forwarded-For": forwarded},
    ) as connection:
        yield connection


async def status_behind(server: Running, forwarded: str) -> int:
    return int((await ask(server, "127.0.0.2", forwarded)).split()[1])
