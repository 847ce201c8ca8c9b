"""Answers to requests for pages: written in pieces, as fast as each client reads them.

Every answer in progress views the one copy of its asset, and holds no more than a piece of it
unsent. The number of answers in progress is bounded for each address and in all; others wait.
"""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from http import HTTPStatus
from typing import Final

from websockets.http11 import Response

from esplanade.server.assets import respond
from esplanade.server.net.addresses import LOCAL_KEYS
from esplanade.server.net.connection import CLOSE_S, Connection
from esplanade.server.net.outbox import bound_kernel_buffers
from esplanade.server.net.refusals import Refusals

PIECE_BYTES: Final = 32 * 1024
"""An answer has this much unsent at most."""

STALL_S: Final = 10.0
"""A client that has not taken a piece of its answer within this time is cut off."""

QUEUE_S: Final = 10.0
"""A request that has waited this long for its turn is told to come again."""

RETRY_AFTER_S: Final = 5


class Answers:
    """Writes HTTP answers; `address_bytes` and `all_bytes` bound what is unsent of them."""

    def __init__(self, address_bytes: int, all_bytes: int, refusals: Refusals) -> None:
        self._for_each = max(1, address_bytes // PIECE_BYTES)
        self._all = asyncio.Semaphore(max(1, all_bytes // PIECE_BYTES))
        self._turns: dict[str, _Turns] = {}
        self._refusals = refusals
        self.unsent_bytes = 0
        """Bytes of pieces that clients have not taken yet."""

    async def send(self, connection: Connection, answer: Response) -> None:
        """Write a whole answer and end the connection."""
        connection.answering = True
        bound_kernel_buffers(connection)
        # Nothing may be unsent when the next piece is written.
        connection.transport.set_write_buffer_limits(high=0)
        address = connection.client_address
        try:
            async with self._turn(address):
                await self._write(connection, answer)
        except _TurnNeverCame as refused:
            self._refusals.answer(refused.why, address)
            await self._write(connection, busy("too many answers are on their way\n"))
        except TimeoutError:
            self._refusals.answer("unread", address)
            return
        connection.end_answer()
        async with asyncio.timeout(CLOSE_S):
            await asyncio.shield(connection.connection_lost_waiter)

    async def _write(self, connection: Connection, answer: Response) -> None:
        body = memoryview(answer.body)
        answer.body = b""
        await self._piece(connection, answer.serialize() + bytes(body[:PIECE_BYTES]))
        for begin in range(PIECE_BYTES, len(body), PIECE_BYTES):
            await asyncio.sleep(0)  # a fast client must not keep the world waiting
            await self._piece(connection, body[begin : begin + PIECE_BYTES])

    async def _piece(self, connection: Connection, piece: bytes | memoryview) -> None:
        if connection.transport.is_closing():
            raise ConnectionResetError
        self.unsent_bytes += len(piece)
        try:
            connection.transport.write(piece)
            async with asyncio.timeout(STALL_S):
                await connection.drain()
        finally:
            self.unsent_bytes -= len(piece)

    @asynccontextmanager
    async def _turn(self, address: str) -> AsyncIterator[None]:
        """Wait until an answer to this address may begin, and keep its turn until it ends."""
        turns = self._turns.setdefault(address, _Turns(self._for_each))
        turns.users += 1
        try:
            async with (
                _waiting(None if address in LOCAL_KEYS else turns.free, "address_bytes"),
                _waiting(self._all, "answer_bytes"),
            ):
                yield
        finally:
            turns.users -= 1
            if not turns.users:
                del self._turns[address]


def busy(text: str) -> Response:
    """The answer to a client that is to come again later."""
    return respond(
        HTTPStatus.SERVICE_UNAVAILABLE, text.encode(), {"Retry-After": str(RETRY_AFTER_S)}
    )


class _Turns:
    """The turns of one address, and how many requests have one or wait for one."""

    def __init__(self, most: int) -> None:
        self.free = asyncio.Semaphore(most)
        self.users = 0


class _TurnNeverCame(Exception):  # noqa: N818
    """A request has waited too long; `why` is the limit that it waited for."""

    def __init__(self, why: str) -> None:
        self.why = why


@asynccontextmanager
async def _waiting(turns: asyncio.Semaphore | None, why: str) -> AsyncIterator[None]:
    if turns is None:
        yield
        return
    try:
        async with asyncio.timeout(QUEUE_S):
            await turns.acquire()
    except TimeoutError:
        raise _TurnNeverCame(why) from None
    try:
        yield
    finally:
        turns.release()
