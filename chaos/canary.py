"""The canary: well-behaved people in a process of their own, who note how the world treats them.

One walks about, pings and talks; another one stays beside the first and listens; a newcomer looks
in once a second. Everything that was due and never came counts with the time for which it was
waited: a world that stands still must not look well because nothing could be measured in it.
"""

import asyncio
import math
import random
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Final

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidHandshake, WebSocketException

from chaos.wire import SERVER
from esplanade.protocol import VERSION, ProtocolError, decode_server, encode, peek_snapshot
from esplanade.protocol.messages import (
    Chat,
    ChatLine,
    Error,
    FromClient,
    Hello,
    Move,
    Ping,
    Pong,
    WalkTo,
    Welcome,
)

PING_EVERY_S: Final = 0.1
TALK_EVERY_S: Final = 1.25
"""Lines of chat are limited to one a second."""

WISH_EVERY_S: Final = 0.5
WAY_WAITS_S: Final = 10.0
NEWCOMER_EVERY_S: Final = 1.0
NEWCOMER_WAITS_S: Final = 5.0
PROBE_S: Final = 0.01
PLACES: Final = ((20.0, 1.5), (20.0, 8.0), (7.5, 8.0), (32.0, 8.0), (20.0, 12.5))
"""Places in and before the gallery, all on the ground floor."""


@dataclass(frozen=True)
class Sighting:
    """The service that the canary had; times in milliseconds."""

    seconds: float
    gap_ms: float
    """The longest time between two snapshots, and until the end."""
    snapshots: int
    due: int
    """Snapshots that should have come in this time."""
    dropped: int
    """Snapshots of ticks that were made and not sent to the canary."""
    ping_ms: float
    """99 of 100 pongs came within this time."""
    way_ms: float
    """The same for `walk_to`, until a snapshot acknowledges it."""
    chat_ms: float
    """The same for lines, until the other one reads them."""
    unheard: int
    """Lines that the other one never got."""
    join_ms: float
    """The longest time of a newcomer from TCP to welcome."""
    turned_away: int
    """Newcomers who were not let in."""
    own_lag_ms: float
    """By how much the canary's own process was late at most: what a busy machine adds."""
    lost: str
    """Why the canary lost its connection, if it did."""


@dataclass
class _Waits:
    """Requests that wait for their answers, and how long others took."""

    open: dict[int, float] = field(default_factory=dict)
    took_s: list[float] = field(default_factory=list)

    def ask(self, number: int) -> None:
        self.open[number] = time.monotonic()

    def answer(self, number: int) -> None:
        asked_s = self.open.pop(number, None)
        if asked_s is not None:
            self.took_s.append(time.monotonic() - asked_s)

    def answer_up_to(self, number: int) -> None:
        for each in [k for k in self.open if k <= number]:
            self.answer(each)

    def reset(self) -> None:
        self.open.clear()
        self.took_s.clear()

    def p99_ms(self, now: float) -> float:
        times = sorted([*self.took_s, *(now - asked for asked in self.open.values())])
        return 1e3 * times[math.ceil(0.99 * len(times)) - 1] if times else 0.0


class Canary:
    """Two people and their newcomer, and the notes of one measurement."""

    def __init__(self, port: int, seed: int) -> None:
        self._url = f"ws://{SERVER}:{port}/ws"
        self._random = random.Random(seed)
        self._pings, self._ways, self._lines = _Waits(), _Waits(), _Waits()
        self._seq = self._number = 0
        self._tick_rate = 20
        self._tick = 0
        self._lost = ""
        self._answered = asyncio.Event()
        self._begin()

    async def live(self, parent: Connection) -> None:
        """Be in the world until the parent says `end`; `begin` and `tell` make a measurement."""
        loop = asyncio.get_running_loop()
        async with joined(self._url, "Canary") as ann, joined(self._url, "Finch") as ben:
            tasks = [
                asyncio.create_task(each)
                for each in (
                    *(self._read(ann, self._take), self._read(ben, self._hear)),
                    *(self._walk(ann, ben), self._ping(ann), self._talk(ann)),
                    *(self._newcomers(), self._probe()),
                )
            ]
            parent.send("here")
            while True:
                order = await loop.run_in_executor(None, parent.recv)
                if order == "begin":
                    self._begin()
                elif order == "tell":
                    parent.send(self._sighting())
                else:
                    break
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    # --- notes --------------------------------------------------------------------------------

    def _begin(self) -> None:
        for waits in (self._pings, self._ways, self._lines):
            waits.reset()
        self._began_s = self._snapshot_s = time.monotonic()
        self._gap_s = self._lag_s = self._join_s = 0.0
        self._snapshots = self._dropped = self._turned_away = 0

    def _sighting(self) -> Sighting:
        now = time.monotonic()
        seconds = now - self._began_s
        # A line that was said a moment ago may still be heard.
        unheard = sum(now - said_s > 1.0 for said_s in self._lines.open.values())
        return Sighting(
            seconds=seconds,
            gap_ms=1e3 * max(self._gap_s, now - self._snapshot_s),
            snapshots=self._snapshots,
            due=int(seconds * self._tick_rate),
            dropped=self._dropped,
            ping_ms=self._pings.p99_ms(now),
            way_ms=self._ways.p99_ms(now),
            chat_ms=self._lines.p99_ms(now),
            unheard=unheard,
            join_ms=1e3 * self._join_s,
            turned_away=self._turned_away,
            own_lag_ms=1e3 * self._lag_s,
            lost=self._lost,
        )

    # --- what they do -------------------------------------------------------------------------

    async def _read(self, wire: ClientConnection, take: Callable[[bytes], None]) -> None:
        try:
            async for message in wire:
                take(message if isinstance(message, bytes) else message.encode())
        except (WebSocketException, ProtocolError) as fault:
            self._lost = str(fault)
        else:
            self._lost = f"closed with {wire.close_code}"

    def _take(self, message: bytes) -> None:
        head = peek_snapshot(message)
        if head is not None:
            now = time.monotonic()
            self._gap_s = max(self._gap_s, now - self._snapshot_s)
            self._snapshot_s = now
            self._snapshots += 1
            if self._tick:
                self._dropped += head.tick - self._tick - 1
            self._tick = head.tick
            self._answer_ways(head.ack)
            return
        match decode_server(message):
            case Pong() as pong:
                self._pings.answer(pong.nonce)
            case Error() as error if error.error == "no_path":
                self._answer_ways(self._seq)

    def _answer_ways(self, seq: int) -> None:
        self._ways.answer_up_to(seq)
        if not self._ways.open:
            self._answered.set()

    def _hear(self, message: bytes) -> None:
        if peek_snapshot(message) is None:
            said = decode_server(message)
            if isinstance(said, Chat) and said.name == "Canary":
                self._lines.answer(int(said.text.rpartition(" ")[2]))

    async def _walk(self, ann: ClientConnection, ben: ClientConnection) -> None:
        """Walk to a place, and now and then a little by hand; the other one comes along."""
        while True:
            x, y = self._random.choice(PLACES)
            for _ in range(4):
                self._seq += 1
                self._ways.ask(self._seq)
                self._answered.clear()
                aside = self._random.uniform(-0.5, 0.5)
                await _say(ann, WalkTo(seq=self._seq, x=x + aside, y=y))
                await _say(ben, WalkTo(seq=self._seq, x=x, y=y + 0.7))
                # A wish that comes before the answer to the last one would take its place.
                with suppress(TimeoutError):
                    async with asyncio.timeout(WAY_WAITS_S):
                        await self._answered.wait()
                await asyncio.sleep(WISH_EVERY_S)
            self._seq += 1
            direction = self._random.uniform(-math.pi, math.pi)
            await _say(ann, Move(seq=self._seq, direction=direction, speed=1.3))
            await asyncio.sleep(WISH_EVERY_S)

    async def _ping(self, wire: ClientConnection) -> None:
        while True:
            self._number += 1
            self._pings.ask(self._number)
            await _say(wire, Ping(nonce=self._number))
            await asyncio.sleep(PING_EVERY_S)

    async def _talk(self, wire: ClientConnection) -> None:
        number = 0
        while True:
            await asyncio.sleep(TALK_EVERY_S)
            number += 1
            self._lines.ask(number)
            await _say(wire, ChatLine(text=f"a fine day {number}"))

    async def _newcomers(self) -> None:
        while True:
            await asyncio.sleep(NEWCOMER_EVERY_S)
            began_s = time.monotonic()
            try:
                async with asyncio.timeout(NEWCOMER_WAITS_S), joined(self._url, "Newcomer"):
                    self._join_s = max(self._join_s, time.monotonic() - began_s)
            except (OSError, InvalidHandshake, WebSocketException):  # a timeout is an OSError
                self._turned_away += 1

    async def _probe(self) -> None:
        while True:
            due_s = time.monotonic() + PROBE_S
            await asyncio.sleep(PROBE_S)
            self._lag_s = max(self._lag_s, time.monotonic() - due_s)


@asynccontextmanager
async def joined(url: str, name: str) -> AsyncIterator[ClientConnection]:
    """A person in the world, who goes in good order at the end.

    Raises
    ------
    OSError, WebSocketException
        The server does not let anybody in, or has closed the connection.
    """
    async with opened(url) as wire:
        await greet(wire, name)
        yield wire


def opened(url: str) -> connect:
    """A connection that has not said hello."""
    return connect(url, compression=None, max_size=None, max_queue=None, proxy=None)


async def greet(wire: ClientConnection, name: str, resume: str | None = None) -> Welcome:
    """Say hello and wait for the welcome."""
    await wire.send(encode(Hello(name=name, version=VERSION, resume=resume)))
    while True:
        message = await wire.recv()
        if isinstance(message, bytes) and peek_snapshot(message) is None:
            answer = decode_server(message)
            if isinstance(answer, Welcome):
                return answer


async def _say(wire: ClientConnection, message: FromClient) -> None:
    with suppress(WebSocketException):
        await wire.send(encode(message))


def run(port: int, seed: int, parent: Connection) -> None:
    """Run a canary; the other end of the pipe says `begin`, `tell` and `end`."""
    asyncio.run(Canary(port, seed).live(parent))
