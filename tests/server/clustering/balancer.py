"""One name for several gateways: each connection goes to the first of them that takes it."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager, suppress

PIECE_BYTES = 1 << 16


@asynccontextmanager
async def balancing(ports: Sequence[int]) -> AsyncIterator[int]:
    """The port at which connections are passed on to those ports, in their order."""
    ongoing: set[asyncio.Task[None]] = set()

    async def take(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        ongoing.add(task)
        try:
            for port in ports:
                with suppress(OSError):
                    there = await asyncio.open_connection("127.0.0.1", port)
                    await _join((reader, writer), there)
                    break
        finally:
            writer.close()
            ongoing.discard(task)

    server = await asyncio.start_server(take, "127.0.0.1", 0)
    try:
        yield server.sockets[0].getsockname()[1]
    finally:
        server.close()
        for task in ongoing:
            task.cancel()
        await asyncio.gather(*ongoing, return_exceptions=True)


Stream = tuple[asyncio.StreamReader, asyncio.StreamWriter]


async def _join(here: Stream, there: Stream) -> None:
    """Pass on what comes at either end, until one of them has ended."""
    passing = [
        asyncio.create_task(_pass(one[0], other[1]))
        for one, other in ((here, there), (there, here))
    ]
    try:
        await asyncio.wait(passing, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in passing:
            task.cancel()
        await asyncio.gather(*passing, return_exceptions=True)
        there[1].close()


async def _pass(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with suppress(OSError):
        while piece := await reader.read(PIECE_BYTES):
            writer.write(piece)
            await writer.drain()
