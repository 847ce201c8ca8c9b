import asyncio

import pytest

from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving


async def test_connections_without_a_request_hold_no_stop_up(serving: Serving) -> None:
    async with serving() as server:
        silent = [
            await asyncio.open_connection("127.0.0.1", port)
            for port in (server.port, server.private_port)
        ]
        silent[0][1].write(b"GET / HT")
        await silent[0][1].drain()
        reading = [asyncio.create_task(_answer(reader)) for reader, _ in silent]
    # A client that is not cut off is told, in the end, that the handshake took too long.
    assert [await task for task in reading] == [b"", b""]
    for _, writer in silent:
        writer.close()


async def test_sockets_are_bounded_from_their_first_moment(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.listener.MAX_UNGREETED", 1)
    monkeypatch.setattr("esplanade.server.net.listener.MAX_VISITS", 1)
    async with serving(max_clients=1) as server, joined(server.port) as client:
        streams = [await asyncio.open_connection("127.0.0.1", server.port) for _ in range(4)]
        assert [await _answer(reader) for reader, _ in streams[2:]] == [b"", b""]
        metrics = server.metrics.exposition()
        assert b"esplanade_sockets 3.0" in metrics
        assert b'esplanade_sockets_refused_total{why="port_full"} 2.0' in metrics
        for _, writer in streams:
            writer.close()
        await client.ticks(2)


async def _answer(reader: asyncio.StreamReader) -> bytes:
    """The bytes that come until the server ends the connection; none where it was cut off."""
    async with asyncio.timeout(PATIENCE_S):
        try:
            return await reader.read()
        except ConnectionResetError:
            return b""
