"""A client measures one connection; load tests and replays use hundreds of them.

It decodes as little as it can: a snapshot costs a look at its head, so that the generator of
load is not what limits the load.
"""

import asyncio
import time
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from typing import Any, Final

from esplanade.bots.clock import ServerClock
from esplanade.bots.connection import Connection
from esplanade.bots.errors import BotError, Disconnected, Refused
from esplanade.bots.tally import Tally
from esplanade.bots.walkers import Walkers
from esplanade.protocol import ErrorCode, ProtocolError, ServerCode, decode_server, peek_snapshot
from esplanade.protocol.codes import CloseCode
from esplanade.protocol.messages import Error, FromClient, Hello, Ping, Pong, Welcome

PING_EVERY_S: Final = 1.0
FIRST_PINGS: Final = 3
"""Round trips right after joining, so that the ages of the first snapshots can be told."""

MAX_UNANSWERED: Final = 60
"""A pong later than this many pings is no longer waited for."""

_CODE_BYTE: Final = 1
"""Position of the message code in a frame."""
_STEPS: Final = bytes([ServerCode.STEPS])
_LOOKED_INTO: Final = (bytes([ServerCode.PONG]), bytes([ServerCode.ERROR]))

OnSnapshot = Callable[[int, int, bytes], Awaitable[None]]


class Client:
    """Counts everything that goes in and out into a tally; `clock` is shared by a process."""

    def __init__(self, connection: Connection, clock: ServerClock, tally: Tally) -> None:
        self.welcome: Welcome = connection.welcome
        self._connection = connection
        self._clock = clock
        self._tally = tally
        self._nonce = 0
        self._pinged_s: dict[int, float] = {}
        self._last_snapshot_s: float | None = None
        self._walkers = Walkers(tally, self.welcome.tick_rate)
        self._tick_s = 1.0 / self.welcome.tick_rate
        clock.seed(self.welcome.server_time, time.monotonic())

    async def send(self, message: FromClient) -> None:
        """Send and count; raises Disconnected."""
        self._tally.bytes_out += await self._connection.send(message)
        self._tally.messages_out += 1

    async def keep_pinging(self) -> None:
        """Ping once a second, with a few more at the start; never returns."""
        for _ in range(FIRST_PINGS):
            await self._ping()
            await asyncio.sleep(self._tick_s)
        while True:
            await self._ping()
            await asyncio.sleep(PING_EVERY_S)

    async def read(self, on_snapshot: OnSnapshot | None = None) -> None:
        """Take frames until the connection ends, which raises Disconnected.

        `on_snapshot(tick, ack, frame)` is awaited before the next frame is read.
        """
        tally = self._tally
        while True:
            frame = await self._connection.receive()
            tally.messages_in += 1
            tally.bytes_in += len(frame)
            head = peek_snapshot(frame)
            if head is None:
                self._take(frame)
                continue
            self._measure(head.tick)
            if on_snapshot is not None:
                await on_snapshot(head.tick, head.ack, frame)

    async def _ping(self) -> None:
        self._nonce += 1
        self._pinged_s.pop(self._nonce - MAX_UNANSWERED, None)
        self._pinged_s[self._nonce] = time.monotonic()
        await self.send(Ping(nonce=self._nonce))

    def _measure(self, tick: int) -> None:
        now_s = time.monotonic()
        if self._last_snapshot_s is not None:
            self._tally.snapshot_interval_s.add(now_s - self._last_snapshot_s)
        self._last_snapshot_s = now_s
        if self._clock.is_set:
            age_s = self._clock.at(now_s) - tick * self._tick_s
            self._tally.snapshot_age_s.add(max(0.0, age_s))

    def _take(self, frame: bytes) -> None:
        """Look into steps, pongs and errors, and into nothing else."""
        if frame[_CODE_BYTE : _CODE_BYTE + 1] == _STEPS:
            self._walkers.take(frame)
            return
        if frame[_CODE_BYTE : _CODE_BYTE + 1] not in _LOOKED_INTO:
            return
        message = decode_server(frame)
        if isinstance(message, Error):
            self._complain(message.error)
        elif isinstance(message, Pong) and message.nonce in self._pinged_s:
            sent_s = self._pinged_s.pop(message.nonce)
            round_trip_s = self._clock.add(sent_s, time.monotonic(), message.server_time)
            self._tally.round_trip_s.add(round_trip_s)

    def _complain(self, code: ErrorCode) -> None:
        if code is ErrorCode.NO_PATH:
            self._tally.no_path += 1
        else:
            self._tally.errors[code.value] += 1


async def visit(
    url: str,
    hello: Hello,
    clock: ServerClock,
    tally: Tally,
    stay: Callable[[Client], Awaitable[None]],
) -> None:
    """One client's whole visit: join, `stay` for as long as that takes, leave. Never raises.

    Whatever goes wrong is counted in the tally.
    """
    try:
        connection = await Connection.open(url, hello)
    except BotError as error:
        tally.failed += 1
        tally.errors[error.code if isinstance(error, Refused) else "unreachable"] += 1
        return
    tally.joined += 1
    began_s = time.monotonic()
    try:
        await stay(Client(connection, clock, tally))
        tally.left += 1
    except Disconnected as ended:
        tally.lost += 1
        tally.errors[_close_name(ended)] += 1
    except ProtocolError:
        tally.lost += 1
        tally.errors["nonsense_from_server"] += 1
    finally:
        tally.client_seconds += time.monotonic() - began_s
        await connection.close()


async def until_first(*works: Coroutine[Any, Any, object]) -> None:
    """Run some works side by side until the first ends; end the others; raise what it raised."""
    tasks = [asyncio.create_task(work) for work in works]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()


async def sleep_until(time_s: float, event: asyncio.Event) -> None:
    """Sleep until the loop's clock says `time_s`, or until the event is set."""
    with suppress(TimeoutError):
        async with asyncio.timeout_at(time_s):
            await event.wait()


def _close_name(ended: Disconnected) -> str:
    """Name of a close code, for the table of errors."""
    try:
        return f"closed_{CloseCode(ended.code).name.lower()}"
    except ValueError:
        return f"closed_{ended.code}"
