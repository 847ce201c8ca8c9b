"""A client measures one connection; load tests and replays use hundreds of them.

It decodes as little as it can: a snapshot costs a look at its head, so that the generator of
load is not what limits the load.
"""

import asyncio
import time
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from esplanade.bots.clock import ServerClock
from esplanade.bots.connection import Connection
from esplanade.bots.due import DueTicks
from esplanade.bots.errors import BotError, Disconnected, Refused, TimedOut
from esplanade.bots.tally import Tally
from esplanade.bots.walkers import Walkers
from esplanade.bots.world_pace import pace_of
from esplanade.protocol import ErrorCode, ProtocolError, ServerCode, decode_server, peek_snapshot
from esplanade.protocol.codes import CloseCode
from esplanade.protocol.messages import Error, FromClient, Hello, Notice, Ping, Pong, Welcome

PING_EVERY_S: Final = 1.0
FIRST_PINGS: Final = 3
"""Round trips right after joining, so that the ages of the first snapshots can be told."""

MAX_UNANSWERED: Final = 60
"""A pong later than this many pings is no longer waited for."""

PONG_WITHIN_S: Final = 0.5
"""A ping that was sent so shortly before the end is not called unanswered."""

DOUBT_S: Final = 0.25
"""A snapshot of this age is a reason to ask for the server's time anew, this often at most."""

_CODE_BYTE: Final = 1
"""Position of the message code in a frame."""
_STEPS: Final = bytes([ServerCode.STEPS])
_LOOKED_INTO: Final = tuple(
    bytes([code])
    for code in (ServerCode.ERROR, ServerCode.PONG, ServerCode.NOTICE, ServerCode.WELCOME)
)

OnSnapshot = Callable[[int, int, bytes], Awaitable[None]]
OnFrame = Callable[[bytes], None]


class Client:
    """Counts everything that goes in and out into a tally; `clock` is shared by a process.

    `welcome` is that of the zone where the client is now.
    """

    def __init__(self, connection: Connection, clock: ServerClock, tally: Tally) -> None:
        self.welcome: Welcome = connection.welcome
        self._connection = connection
        self._clock = clock
        self._tally = tally
        self._nonce = 0
        self._pinged_s: dict[int, float] = {}
        self._last_snapshot_s: float | None = None
        self._in_doubt = asyncio.Event()
        self._walkers = Walkers(tally, self.welcome.tick_rate)
        self._tick_s = 1.0 / self.welcome.tick_rate
        now_s = time.monotonic()
        self._due = DueTicks(tally, self.welcome.tick_rate, now_s)
        clock.seed(self.welcome.server_time, now_s)

    async def send(self, message: FromClient) -> None:
        """Send and count; raises Disconnected."""
        size = await self._connection.send(message)
        self._tally.bytes_out += size
        self._tally.messages_out += 1
        self._tally.series.at(time.monotonic()).bytes_out += size

    async def keep_pinging(self) -> None:
        """Ping once a second, with a few more at the start and in doubt; never returns."""
        for _ in range(FIRST_PINGS):
            await self._ping()
            await asyncio.sleep(self._tick_s)
        while True:
            await self._ping()
            self._in_doubt.clear()
            with suppress(TimeoutError):
                async with asyncio.timeout(PING_EVERY_S):
                    await self._in_doubt.wait()

    async def read(
        self, on_snapshot: OnSnapshot | None = None, on_frame: OnFrame | None = None
    ) -> None:
        """Take frames until the connection ends, which raises Disconnected.

        `on_snapshot(tick, ack, frame)` is awaited before the next frame is read;
        `on_frame(frame)` is called with every frame.
        """
        tally = self._tally
        while True:
            frame = await self._connection.receive()
            now_s = time.monotonic()
            tally.messages_in += 1
            tally.bytes_in += len(frame)
            tally.series.at(now_s).bytes_in += len(frame)
            head = peek_snapshot(frame)
            if head is None:
                self._take(frame, now_s)
            else:
                self._measure(head.tick, now_s)
            if on_frame is not None:
                on_frame(frame)
            if head is not None and on_snapshot is not None:
                await on_snapshot(head.tick, head.ack, frame)

    def finish(self) -> None:
        """Count what has not come and will not: snapshots that were due, and answers to pings."""
        now_s = time.monotonic()
        self._due.finish(now_s)
        for sent_s in self._pinged_s.values():
            if now_s - sent_s > PONG_WITHIN_S:
                self._unanswered(now_s - sent_s)
        self._pinged_s.clear()

    async def _ping(self) -> None:
        now_s = time.monotonic()
        self._nonce += 1
        forgotten_s = self._pinged_s.pop(self._nonce - MAX_UNANSWERED, None)
        if forgotten_s is not None:
            self._unanswered(now_s - forgotten_s)
        self._pinged_s[self._nonce] = now_s
        self._tally.pings_sent += 1
        await self.send(Ping(nonce=self._nonce))

    def _unanswered(self, waited_s: float) -> None:
        self._tally.pings_unanswered += 1
        self._tally.round_trip_s.add(waited_s)

    def _measure(self, tick: int, now_s: float) -> None:
        if self._last_snapshot_s is not None:
            self._tally.snapshot_interval_s.add(now_s - self._last_snapshot_s)
        self._last_snapshot_s = now_s
        due_s = self._clock.local(tick * self._tick_s)
        if now_s - due_s > DOUBT_S and self._clock.doubt(now_s, DOUBT_S):
            self._in_doubt.set()
        self._due.take(tick, due_s, now_s)

    def _take(self, frame: bytes, now_s: float) -> None:
        """Look into steps, pongs, errors, notices and welcomes, and into nothing else."""
        code = frame[_CODE_BYTE : _CODE_BYTE + 1]
        if code == _STEPS:
            self._walkers.take(frame)
        elif code in _LOOKED_INTO:
            message = decode_server(frame)
            if isinstance(message, Error):
                self._complain(message.error)
            elif isinstance(message, Welcome):
                self._come_into(message, now_s)
            elif isinstance(message, Notice) and (pace := pace_of(message)) is not None:
                self._clock.pace(*pace, now_s)
                self._due.pace(pace.rate, now_s)
            elif isinstance(message, Pong) and message.nonce in self._pinged_s:
                sent_s = self._pinged_s.pop(message.nonce)
                round_trip_s = self._clock.add(sent_s, now_s, message.server_time)
                self._tally.round_trip_s.add(round_trip_s)

    def _come_into(self, welcome: Welcome, now_s: float) -> None:
        """Count on in another zone of the world, which has a clock of its own."""
        self.welcome = welcome
        self._clock = ServerClock()
        self._clock.seed(welcome.server_time, now_s)
        self._due.finish(now_s)
        self._due = DueTicks(self._tally, welcome.tick_rate, now_s)
        self._walkers = Walkers(self._tally, welcome.tick_rate)

    def _complain(self, code: ErrorCode | str) -> None:
        if code == ErrorCode.NO_PATH:
            self._tally.no_path += 1
        else:
            self._tally.complain(str(code))


async def visit(
    url: str,
    hello: Hello,
    clock: ServerClock,
    tally: Tally,
    stay: Callable[[Client], Awaitable[None]],
    trust: Path | None = None,
) -> None:
    """One client's whole visit: join, `stay` for as long as that takes, leave. Never raises.

    Whatever goes wrong is counted in the tally.
    """
    began_s = time.monotonic()
    try:
        connection = await Connection.open(url, hello, trust)
    except BotError as error:
        now_s = time.monotonic()
        tally.failed += 1
        tally.series.at(now_s).failed += 1
        tally.complain(_join_error(error))
        if isinstance(error, TimedOut):
            tally.join_s.add(now_s - began_s)
        return
    joined_s = time.monotonic()
    tally.join_s.add(joined_s - began_s)
    tally.joined += 1
    tally.series.at(joined_s).joined += 1
    client = Client(connection, clock, tally)
    lost = ""
    try:
        await stay(client)
    except Disconnected as ended:
        lost = _close_name(ended)
    except (ProtocolError, ValueError):  # the second of blocks that are no records
        lost = "nonsense_from_server"
    finally:
        client.finish()
        now_s = time.monotonic()
        tally.client_seconds += now_s - joined_s
        bucket = tally.series.at(now_s)
        if lost:
            tally.lost += 1
            bucket.lost += 1
            tally.complain(lost)
        else:
            tally.left += 1
            bucket.left += 1
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


def _join_error(error: BotError) -> str:
    """Name of what kept a client from joining, for the table of errors."""
    match error:
        case Refused():
            return error.code
        case TimedOut():
            return "join_timed_out"
    return "unreachable"
