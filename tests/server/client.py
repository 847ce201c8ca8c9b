"""A real WebSocket client for tests: remembers what it is told, waits for what it wants."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import TypeVar

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from esplanade.protocol import VERSION, decode_server, encode
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import (
    Enter,
    Entity,
    Error,
    FromClient,
    Hello,
    Leave,
    Move,
    Reshape,
    ServerMessage,
    Snapshot,
    Welcome,
)
from esplanade.protocol.snapshot import positions_m, unpack_block
from tests.patience import PATIENCE_S

Message = TypeVar("Message")

PLACING_KEY = "let me stand where I wish"
"""The operator key of servers under test: with it clients come in at the place of their wish."""


class Client:
    """One connection. `positions` and `entities` hold what is in view."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.welcome: Welcome | None = None
        self.entities: dict[int, Entity] = {}
        self.positions: dict[int, tuple[float, float]] = {}
        self.tick = 0
        self.ack = 0
        self.seq = 0

    @property
    def id(self) -> int:
        assert self.welcome is not None
        return self.welcome.id

    @property
    def position(self) -> tuple[float, float]:
        return self.positions[self.id]

    async def send(self, message: FromClient) -> None:
        await self.connection.send(encode(message))

    async def move(self, direction: float, speed: float) -> None:
        self.seq += 1
        await self.send(Move(seq=self.seq, direction=direction, speed=speed))

    async def next(self) -> ServerMessage:
        """The next message, taken into account."""
        frame = await self.connection.recv()
        assert isinstance(frame, bytes)
        message = decode_server(frame)
        assert message is not None
        match message:
            case Welcome():
                # It begins anew with nobody in view, also behind a portal.
                self.welcome, self.entities, self.positions = message, {}, {}
            case Enter():
                self.entities.update({entity.id: entity for entity in message.entities})
            case Reshape():
                told = message.model_dump(include={"radius", "leg_m", "stature_m"})
                changed = {**told, "look": message.look}
                self.entities[message.id] = self.entities[message.id].model_copy(update=changed)
            case Leave():
                for gone in message.ids:
                    del self.entities[gone]
                    self.positions.pop(gone, None)
            case Snapshot():
                assert self.welcome is not None
                self.tick, self.ack = message.tick, message.ack
                records = unpack_block(message.block)
                places = positions_m(records, self.welcome.origin)
                for avatar, (x, y) in zip(records["id"].tolist(), places.tolist(), strict=True):
                    assert avatar in self.entities, "a snapshot of somebody who never entered"
                    self.positions[avatar] = (x, y)
        return message

    async def until(self, kind: type[Message]) -> Message:
        """Read up to the next message of a kind."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                message = await self.next()
                if isinstance(message, kind):
                    return message

    async def wait_for(self, condition: Callable[[], bool]) -> None:
        """Read until a condition holds."""
        async with asyncio.timeout(PATIENCE_S):
            while not condition():
                await self.next()

    async def ticks(self, number: int) -> None:
        """Read on for so many ticks from the last snapshot read."""
        await self.until_tick(self.tick + number)

    async def until_tick(self, tick: int) -> None:
        """Read up to the snapshot of a tick."""
        await self.wait_for(lambda: self.tick >= tick)

    async def last_words(self) -> tuple[list[ServerMessage], int | None]:
        """Read to the end of the connection: the messages, and the close code."""
        messages = []
        async with asyncio.timeout(PATIENCE_S):
            try:
                while True:
                    messages.append(await self.next())
            except ConnectionClosed:
                return messages, self.connection.close_code

    async def refusal(self) -> tuple[str, int | None]:
        """Read to the end of the connection: the last error's name, and the close code."""
        messages, code = await self.last_words()
        errors = [str(message.error) for message in messages if isinstance(message, Error)]
        return errors[-1], code


@asynccontextmanager
async def connected(
    port: int, source: str = "127.0.0.1", zone: str | None = None
) -> AsyncIterator[Client]:
    """A connection that has not said hello; its address may wish for a zone."""
    url = f"ws://127.0.0.1:{port}/ws" + (f"?zone={zone}" if zone else "")
    # Without a bound on its queue, a client that a test does not read from can still close.
    async with connect(
        url,
        compression=None,
        max_size=None,
        max_queue=None,
        proxy=None,
        local_addr=(source, 0),
    ) as connection:
        yield Client(connection)


@asynccontextmanager
async def joined(
    port: int,
    name: str = "Ann",
    at: tuple[float, float, int] | None = None,
    resume: str | None = None,
    source: str = "127.0.0.1",
    look: Look | None = None,
    zone: str | None = None,
) -> AsyncIterator[Client]:
    """A person in the world who has had a first snapshot; an operator if `at` is given.

    `source` is the address that the client connects from, `zone` the one that it wishes for.
    """
    key = None if at is None else PLACING_KEY
    hello = Hello(name=name, version=VERSION, at=at, resume=resume, operator=key, look=look)
    async with connected(port, source, zone) as client:
        await client.send(hello)
        await client.until(Snapshot)
        yield client
