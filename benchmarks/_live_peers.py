"""Servers without a world, to compare with: frames of one size to every client, at the same times.

`bare` knows no more of WebSocket than its handshake and discards what it is sent; `websockets`
reads every message with the library of that name. Run as a program: `python -m
benchmarks._live_peers KIND BYTES`. It prints its port, and ends with its standard input.
"""

import asyncio
import base64
import hashlib
import struct
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Final, cast

import uvloop
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.protocol import State

TICK_S: Final = 0.05
_SHORT_BYTES: Final = 127
"""A longer frame has a head of four bytes instead of two."""
_GUID: Final = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


def frame_of(size: int) -> bytes:
    """A frame of one binary message, of so many bytes with its head."""
    if size <= _SHORT_BYTES:
        return struct.pack(">BB", 0x82, size - 2) + bytes(size - 2)
    return struct.pack(">BBH", 0x82, 126, size - 4) + bytes(size - 4)


class Bare(asyncio.Protocol):
    """A connection that answers the handshake and discards all else."""

    def __init__(self, transports: list[asyncio.Transport]) -> None:
        self._transports = transports
        self._upgraded = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.Transport, transport)

    def connection_lost(self, _error: Exception | None) -> None:
        if self._upgraded:
            self._transports.remove(self._transport)

    def data_received(self, data: bytes) -> None:
        if self._upgraded:
            return
        self._upgraded = True
        key = data.partition(b"Sec-WebSocket-Key: ")[2].partition(b"\r\n")[0]
        accept = base64.b64encode(hashlib.sha1(key + _GUID).digest())  # noqa: S324 (RFC 6455)
        self._transport.write(
            b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Accept: " + accept + b"\r\n\r\n"
        )
        self._transports.append(self._transport)


async def serve_bare(size: int) -> None:
    """Serve without a library until standard input ends."""
    transports: list[asyncio.Transport] = []
    loop = asyncio.get_running_loop()
    listening = await loop.create_server(lambda: Bare(transports), "127.0.0.1", 0, backlog=1024)
    frame = frame_of(size)

    def write() -> None:
        for transport in transports:
            transport.write(frame)

    await _tick(listening.sockets[0].getsockname()[1], write)


async def serve_websockets(size: int) -> None:
    """Serve with the library until standard input ends."""
    connections: set[ServerConnection] = set()

    async def read(connection: ServerConnection) -> None:
        connections.add(connection)
        with suppress(ConnectionClosed):
            async for _ in connection:
                pass
        connections.discard(connection)

    frame = frame_of(size)

    def write() -> None:
        for connection in connections:
            if connection.state is State.OPEN:
                connection.transport.write(frame)

    async with serve(read, "127.0.0.1", 0, compression=None, backlog=1024) as server:
        await _tick(next(iter(server.sockets)).getsockname()[1], write)


async def _tick(port: int, write: Callable[[], None]) -> None:
    print(port, flush=True)
    loop = asyncio.get_running_loop()
    ended = loop.create_task(asyncio.to_thread(sys.stdin.read))
    due_s = loop.time()
    while not ended.done():
        write()
        due_s += TICK_S
        await asyncio.sleep(due_s - loop.time())


KINDS: Final = {"bare": serve_bare, "websockets": serve_websockets}

if __name__ == "__main__":
    uvloop.run(KINDS[sys.argv[1]](int(sys.argv[2])))
