"""Answers that clients do not read cost no memory, and hold up nobody from elsewhere."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from esplanade.server.app import Running
from esplanade.server.assets import Assets
from esplanade.server.net import answers
from esplanade.server.net.answers import PIECE_BYTES
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import NO_CLIENT, ServingAssets

LARGE = bytes(range(256)) * 64 * 1024  # 16 MiB; compression would make it small


@pytest.fixture
def large() -> tuple[Assets, str]:
    assets, path = NO_CLIENT.with_data("mesh", LARGE)
    return assets, f"/{path}"


async def test_a_large_answer_arrives_whole(
    serving_assets: ServingAssets, large: tuple[Assets, str]
) -> None:
    assets, path = large
    async with serving_assets(assets) as server, joined(server.port) as client:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        writer.write(_request(path))
        async with asyncio.timeout(PATIENCE_S):
            head = await reader.readuntil(b"\r\n\r\n")
            body = await reader.read(-1)
        assert b" 200 OK" in head
        assert b"Connection: close" in head
        assert body == LARGE
        writer.close()
        await client.ticks(3)
        assert b"esplanade_answer_bytes_unsent 0.0" in server.metrics.exposition()


async def test_a_client_that_does_not_read_is_dropped_and_holds_a_piece_only(
    serving_assets: ServingAssets, large: tuple[Assets, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "STALL_S", 1.0)
    assets, path = large
    async with serving_assets(assets) as server, joined(server.port) as other:
        async with _unread(server, path, "127.0.0.2", 20):
            unsent = await _settled(server)
            assert 0 < unsent <= 20 * PIECE_BYTES
            await _until(server, b'esplanade_answers_refused_total{why="unread"} 20.0')
            assert _value(server, b"esplanade_answer_bytes_unsent") == 0
        await other.ticks(3)


async def test_answers_to_one_address_wait_for_each_other_and_nobody_else_does(
    serving_assets: ServingAssets, large: tuple[Assets, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "QUEUE_S", 0.5)
    assets, path = large
    async with serving_assets(assets, address_bytes=2 * PIECE_BYTES) as server:
        async with _unread(server, path, "127.0.0.2", 2):
            assert await _settled(server) <= 2 * PIECE_BYTES
            refused = await _get(server, path, "127.0.0.2")
            assert refused.startswith(b"HTTP/1.1 503 ")
            assert b"Retry-After: 5\r\n" in refused
            for free in ("127.0.0.3", "127.0.0.1"):
                assert (await _get(server, path, free)).endswith(LARGE)
        assert b'esplanade_answers_refused_total{why="address_bytes"} 1.0' in (
            server.metrics.exposition()
        )


async def test_a_turn_comes_when_an_answer_before_it_has_ended(
    serving_assets: ServingAssets, large: tuple[Assets, str]
) -> None:
    assets, path = large
    async with serving_assets(assets, address_bytes=PIECE_BYTES) as server:
        async with _unread(server, path, "127.0.0.2", 1):
            await _settled(server)
            waiting = asyncio.create_task(_get(server, path, "127.0.0.2"))
            await asyncio.sleep(0.1)
            assert not waiting.done()
        assert (await waiting).endswith(LARGE)


async def test_answers_to_all_are_bounded(
    serving_assets: ServingAssets, large: tuple[Assets, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(answers, "QUEUE_S", 0.2)
    assets, path = large
    async with serving_assets(assets, answer_bytes=2 * PIECE_BYTES) as server:
        async with _unread(server, path, "127.0.0.2", 2):
            await _settled(server)
            assert (await _get(server, path, "127.0.0.3")).startswith(b"HTTP/1.1 503 ")
        assert b'esplanade_answers_refused_total{why="answer_bytes"} 1.0' in (
            server.metrics.exposition()
        )


async def test_what_a_client_sends_behind_its_request_disturbs_nothing(
    serving_assets: ServingAssets, large: tuple[Assets, str]
) -> None:
    assets, path = large
    async with serving_assets(assets) as server:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        writer.write(_request(path))
        async with asyncio.timeout(PATIENCE_S):
            await reader.readuntil(b"\r\n\r\n")
            writer.write(_request(path))
            writer.write_eof()
            assert await reader.read(-1) == LARGE
        writer.close()


def test_an_answer_views_the_one_copy_of_its_asset(large: tuple[Assets, str]) -> None:
    assets, path = large
    first, second = (_found(assets, path) for _ in range(2))
    assert first.body is second.body


def _found(assets: Assets, path: str) -> Response:
    return assets.answer(Request(path, Headers()))


def _request(path: str) -> bytes:
    return f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()


async def _get(server: Running, path: str, address: str) -> bytes:
    reader, writer = await asyncio.open_connection(
        "127.0.0.1", server.port, local_addr=(address, 0)
    )
    writer.write(_request(path))
    async with asyncio.timeout(PATIENCE_S):
        answer = await reader.read(-1)
    writer.close()
    return answer


@asynccontextmanager
async def _unread(server: Running, path: str, address: str, number: int) -> AsyncIterator[None]:
    """Clients that ask for an asset and do not read it."""
    writers = []
    for _ in range(number):
        _, writer = await asyncio.open_connection(
            "127.0.0.1", server.port, local_addr=(address, 0), limit=1024
        )
        writer.write(_request(path))
        writers.append(writer)
    yield
    for writer in writers:
        writer.transport.abort()


def _value(server: Running, name: bytes) -> float:
    lines = server.metrics.exposition().splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith(name + b" "))


async def _settled(server: Running) -> float:
    """The bytes that are unsent once they have not changed for a while."""
    before, same = -1.0, 0
    async with asyncio.timeout(PATIENCE_S):
        while same < 5:
            await asyncio.sleep(0.05)
            unsent = _value(server, b"esplanade_answer_bytes_unsent")
            same = same + 1 if unsent == before and unsent else 0
            before = unsent
    return before


async def _until(server: Running, line: bytes) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while line not in server.metrics.exposition():  # noqa: ASYNC110
            await asyncio.sleep(0.05)
