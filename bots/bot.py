"""A person made of code: join, look, walk, talk."""

import asyncio
import time
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Self

from esplanade.bots.admission import admission
from esplanade.bots.clock import ServerClock
from esplanade.bots.connection import NO_CLOSE_CODE, OPEN_TIMEOUT_S, Connection
from esplanade.bots.errors import Disconnected, Unreachable
from esplanade.bots.events import Event, SnapshotEvent, StepsEvent
from esplanade.bots.mailbox import Mailbox
from esplanade.bots.person import Person
from esplanade.bots.view import Avatar, View
from esplanade.bots.world_pace import pace_of
from esplanade.protocol import VERSION, ProtocolError, decode_server
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import (
    Bye,
    FromClient,
    Hello,
    Notice,
    Ping,
    Pong,
    ServerMessage,
    SetDoor,
    Snapshot,
    StepBlock,
    Travel,
    Welcome,
)
from esplanade.protocol.snapshot import unpack_block
from esplanade.protocol.steps import step_records


class Bot(Person):
    """A person in the world, moved by a script. Made by `connect`, which also closes it."""

    def __init__(self, connection: Connection) -> None:
        welcome = connection.welcome
        self.welcome = welcome
        self._resume_token = welcome.resume
        self._connection = connection
        self._clock = ServerClock()
        self._clock.seed(welcome.server_time, time.monotonic())
        self._view = View(welcome)
        self._mailbox = Mailbox()
        self._placed = asyncio.Event()
        self._nonce = 0
        self._pings: dict[int, tuple[float, asyncio.Future[float]]] = {}
        self._ended: Disconnected | None = None
        self._said_bye = False
        self._travels = False
        self._reader = asyncio.create_task(self._read())

    @classmethod
    async def join(cls, url: str, hello: Hello, trust: Path | None = None) -> Self:
        """Connect and wait until the own place is known; raises as `connect` does."""
        bot = cls(await Connection.open(url, hello, trust))
        try:
            await bot._until_placed()
        except BaseException:
            await bot.close()
            raise
        return bot

    async def close(self) -> None:
        """Leave the world."""
        self._reader.cancel()
        await asyncio.gather(self._reader, return_exceptions=True)
        await self._connection.close()

    # --- what it knows --------------------------------------------------------------------------

    @property
    def resume_token(self) -> str:
        """The newest token for `connect(resume=...)`, which takes this avatar up again.

        The server may give a new one at each welcome; it is wanted after a lost connection.
        """
        return self._resume_token

    @property
    def avatar(self) -> Avatar:
        """The own avatar: place, heading and speed of the newest snapshot."""
        return self._view.own

    @property
    def doors(self) -> Mapping[str, bool]:
        """Whether each door stands open, by name; changes as the doors do."""
        return MappingProxyType(self._view.doors)

    @property
    def tick(self) -> int:
        """Tick of the newest snapshot."""
        return self._view.tick

    @property
    def acknowledged(self) -> int:
        """The newest of our sequence numbers that counted in the newest snapshot."""
        return self._view.ack

    @property
    def server_time(self) -> float:
        """The server's time now, seconds; the more exact, the more `ping` was called."""
        return self._clock.at(time.monotonic())

    @property
    def dropped_events(self) -> int:
        """Events that went because nobody read them, see `Mailbox`."""
        return self._mailbox.dropped

    # --- what it does ---------------------------------------------------------------------------

    async def set_door(self, name: str, is_open: bool) -> None:
        """Open or close a door of the scene; only for those who joined with the operator key."""
        await self._send(SetDoor(name=name, open=is_open))

    async def ping(self) -> float:
        """Round trip to the server and back, seconds; sharpens `server_time`."""
        self._nonce += 1
        nonce = self._nonce
        answer: asyncio.Future[float] = asyncio.get_running_loop().create_future()
        self._pings[nonce] = (time.monotonic(), answer)
        try:
            await self._send(Ping(nonce=nonce))
            return await answer
        finally:
            self._pings.pop(nonce, None)

    async def events(self) -> AsyncIterator[Event]:
        """The events in order; ends when the bot closes or the server said bye.

        Raises
        ------
        Disconnected
            The connection was lost otherwise; everything that came before was handed out.
        """
        while (event := await self._mailbox.get()) is not None:
            yield event
        if self._ended is not None and not self._said_bye:
            raise self._ended

    # --- inside ---------------------------------------------------------------------------------

    async def _until_placed(self) -> None:
        try:
            async with asyncio.timeout(OPEN_TIMEOUT_S):
                await self._placed.wait()
        except TimeoutError:
            raise Unreachable(f"no snapshot within {OPEN_TIMEOUT_S:g} s of welcome") from None
        if not self._view.placed and self._ended is not None:
            raise self._ended

    async def _send(self, message: FromClient) -> None:
        if self._ended is not None:
            raise self._ended
        await self._connection.send(message)

    async def _read(self) -> None:
        """Take frames until the connection ends; nothing here waits for the script."""
        try:
            while True:
                frame = await self._connection.receive()
                if (message := decode_server(frame)) is not None:
                    self._take(message)
        except Disconnected as ended:
            self._ended = ended
        except (ProtocolError, ValueError) as fault:
            self._ended = Disconnected(NO_CLOSE_CODE, f"the server sent nonsense: {fault}")
        finally:
            self._mailbox.close()
            self._placed.set()
            for _, answer in self._pings.values():
                if not answer.done():
                    answer.set_exception(Disconnected(NO_CLOSE_CODE, "closed before the pong"))

    def _take(self, message: ServerMessage) -> None:
        match message:
            case Snapshot():
                event = SnapshotEvent(
                    message.tick, message.ack, unpack_block(message.block), self.welcome.origin
                )
                self._view.snapshot(event)
                if self._view.placed:
                    self._placed.set()
                self._mailbox.put(event)
                return
            case StepBlock():
                self._mailbox.put(StepsEvent(message.tick, step_records(message.block)))
                return
            case Pong() | Notice():
                self._take_time(message)
            case Bye():
                self._said_bye = True
            case Welcome():
                self._resume_token = message.resume
                if self._travels:
                    self._come_into(message)
                return
            case Travel():
                self._travels = True
            case _:
                self._view.take(message)
        self._mailbox.put(message)

    def _come_into(self, welcome: Welcome) -> None:
        """Begin to look about anew, in the zone that this welcome is of."""
        self._travels = False
        self.welcome = welcome
        self._view = View(welcome)
        self._clock.seed(welcome.server_time, time.monotonic())

    def _take_time(self, message: Pong | Notice) -> None:
        """Learn the server's time, or the pace at which it goes on."""
        now_s = time.monotonic()
        if isinstance(message, Notice):
            if (pace := pace_of(message)) is not None:
                self._clock.pace(*pace, now_s)
            return
        sent_s, answer = self._pings.get(message.nonce, (None, None))
        if sent_s is not None and answer is not None and not answer.done():
            answer.set_result(self._clock.add(sent_s, now_s, message.server_time))


@asynccontextmanager
async def connect(
    url: str,
    name: str = "Bot",
    at: tuple[float, float, float] | None = None,
    resume: str | None = None,
    operator: str | None = None,
    steps: bool = True,
    trust: Path | None = None,
    token: str | None = None,
    look: Look | None = None,
) -> AsyncIterator[Bot]:
    """Join the world at `url` and leave it at the end of the block.

    Parameters
    ----------
    url : like ws://localhost:8080; the path /ws is added when there is none
    name : what others read above the avatar, up to 32 characters
    at : wished place (x, y, z) of a new avatar, metres; granted to operators and in worlds of
        recorded crowds, elsewhere the place of arrival nearest to it is taken
    resume : token of an earlier connection whose avatar is to be taken up again
    operator : the server's operator key; `welcome.operator` says whether it fits
    steps : whether to be sent steps; of others who walk by steps, places come once a second only
    trust : file of the server's certificate, PEM; no other is trusted then, and the server's name
        is not checked. Without it, certificates are checked as the machine does
    token : a bot's token, which lets it into a closed world and at a rate of its own
    look : clothes, hair, skin and stature of the avatar; those of its id without

    Raises
    ------
    ValueError
        One of the arguments is not what it should be.
    Unreachable, Refused
        Nobody is there, or the server does not let the bot in.
    Disconnected
        The connection ended before the avatar stood in the world.
    """
    hello = Hello(
        name=name,
        version=VERSION,
        resume=resume,
        at=at,
        operator=operator,
        admission=admission(token),
        steps=steps,
        look=look,
    )
    bot = await Bot.join(url, hello, trust)
    try:
        yield bot
    finally:
        await bot.close()
