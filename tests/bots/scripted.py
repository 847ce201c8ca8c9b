"""A server that speaks the protocol and nothing more: no walls, no view limit, no queues.

Tests set what it should do wrong. Positions move exactly as commanded, one command a tick, so
that what a client does can be checked against plain arithmetic.
"""

import asyncio
import math
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from esplanade.protocol import VERSION, ErrorCode, Kind, decode_client, encode, encode_snapshot
from esplanade.protocol.messages import (
    Chat,
    ChatLine,
    ClientMessage,
    Doors,
    Enter,
    Entity,
    Error,
    FromServer,
    Hello,
    Leave,
    Move,
    Ping,
    Pong,
    SetDoor,
    WalkTo,
    Welcome,
)
from esplanade.protocol.snapshot import pack_records
from tests.patience import PATIENCE_S

ORIGIN = (-50.0, -50.0)
OPERATOR = "key"
TURNS = 20
"""Turns of the event loop before a tick; there and back again takes five."""
SCENE: dict[str, Any] = {"name": "scripted", "bounds": [-50.0, -50.0, 50.0, 50.0]}


@dataclass
class Person:
    """One connected client, as the scripted server knows it."""

    id: int
    socket: ServerConnection
    hello: Hello
    position: tuple[float, float]
    velocity: tuple[float, float] = (0.0, 0.0)
    height: float = 0.0
    ack: int = 0
    heard: list[ClientMessage] = field(default_factory=list)


class ScriptedServer:
    """A world of points that move as they are told."""

    def __init__(self, tick_rate: int = 20, max_speed: float = 10.0, delay_ticks: int = 0) -> None:
        self.tick_rate = tick_rate
        self.max_speed = max_speed
        self.delay_ticks = delay_ticks
        self.tick = 100
        self.people: dict[int, Person] = {}
        self.all_people: list[Person] = []
        self.on_hello: Callable[[Hello], FromServer | None] = lambda hello: None
        self.silent = False
        self.doors = {"gate": True}
        self.port = 0
        self._loop_start_s = 0.0
        self._late: list[tuple[int, Person, ClientMessage]] = []

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}"

    @property
    def time_s(self) -> float:
        """Server time; where no time was lost, tick k is due at k / tick_rate."""
        return asyncio.get_running_loop().time() - self._loop_start_s

    async def talk(self, socket: ServerConnection) -> None:
        """The whole life of one connection."""
        with suppress(ConnectionClosed):
            hello = decode_client(await socket.recv(decode=False))
            assert isinstance(hello, Hello)
            refusal = self.on_hello(hello)
            if refusal is not None:
                await socket.send(encode(refusal))
                return
            person = Person(
                len(self.all_people) + 1, socket, hello, (hello.at or (0.0, 0.0, 0))[:2]
            )
            self.all_people.append(person)
            await socket.send(encode(self.welcome(person)))
            everyone = [*self.people.values(), person]
            for other in everyone:
                with suppress(ConnectionClosed):
                    await other.socket.send(encode(self._enter([person])))
            await socket.send(encode(self._enter(everyone[:-1])))
            self.people[person.id] = person
            try:
                async for frame in socket:
                    assert isinstance(frame, bytes)
                    await self._hear(person, decode_client(frame))
            finally:
                self.people.pop(person.id, None)
                for other in list(self.people.values()):
                    with suppress(ConnectionClosed):
                        await other.socket.send(encode(Leave(tick=self.tick, ids=[person.id])))

    def welcome(self, person: Person) -> Welcome:
        return Welcome(
            version=VERSION,
            id=person.id,
            name=person.hello.name,
            resume=f"token-{person.id}",
            resumed=person.hello.resume is not None,
            scene=SCENE,
            tick=self.tick,
            tick_rate=self.tick_rate,
            server_time=self.time_s,
            resume_seconds=30.0,
            radius=0.25,
            clearance=0.25,
            body_height=1.8,
            step_height=0.6,
            max_speed=self.max_speed,
            walk_speed=1.4,
            origin=ORIGIN,
            doors=self.doors,
            operator=person.hello.operator == OPERATOR,
        )

    def _enter(self, people: list[Person]) -> Enter:
        return Enter(
            tick=self.tick,
            entities=[
                Entity(
                    id=person.id,
                    kind=Kind.PERSON,
                    name=person.hello.name,
                    layer=0,
                    x=person.position[0],
                    y=person.position[1],
                    z=person.height,
                    heading=0.0,
                    radius=0.25,
                    leg_m=0.9,
                    stature_m=1.75,
                    points_at=None,
                )
                for person in people
            ],
        )

    async def _hear(self, person: Person, message: ClientMessage) -> None:
        person.heard.append(message)
        match message:
            case Move() | WalkTo():
                self._late.append((self.tick + self.delay_ticks, person, message))
            case Ping():
                await person.socket.send(encode(Pong(nonce=message.nonce, server_time=self.time_s)))
            case ChatLine():
                line = Chat(id=person.id, name=person.hello.name, text=message.text)
                await self._tell_all(line)
            case SetDoor() if person.hello.operator == OPERATOR:
                self.doors[message.name] = message.open
                await self._tell_all(Doors(doors={message.name: message.open}))
            case SetDoor():
                error = Error(error=ErrorCode.FORBIDDEN, text="only operators")
                await person.socket.send(encode(error))

    async def _tell_all(self, message: FromServer) -> None:
        for person in list(self.people.values()):
            await person.socket.send(encode(message))

    async def run_ticks(self) -> None:
        """Tick for ever, on schedule but for the time that a busy machine took away.

        After a delay the world is late by it, and everybody has a whole tick's time to answer.
        """
        loop = asyncio.get_running_loop()
        self._loop_start_s = loop.time() - self.tick / self.tick_rate
        due_s = loop.time()
        while True:
            due_s += 1.0 / self.tick_rate
            await asyncio.sleep(max(0.0, due_s - loop.time()))
            await self._before_tick()
            if loop.time() - due_s > 0.5 / self.tick_rate:
                due_s = loop.time()
            await _let_messages_arrive()
            self.tick += 1
            self._apply()
            for person in list(self.people.values()):
                if not self.silent:
                    with suppress(ConnectionClosed):
                        await person.socket.send(self._snapshot(person))

    async def _before_tick(self) -> None:
        """A place where a test can hold the world up."""

    def _apply(self) -> None:
        """Obey what has arrived, then move everyone one tick on."""
        due = [entry for entry in self._late if entry[0] < self.tick]
        self._late = [entry for entry in self._late if entry[0] >= self.tick]
        for _, person, message in due:
            assert isinstance(message, Move | WalkTo)
            person.ack = message.seq
            if isinstance(message, WalkTo):
                person.position = (message.x, message.y)
                person.height = message.z
                person.velocity = (0.0, 0.0)
                continue
            speed = min(message.speed, self.max_speed)
            person.velocity = (
                speed * math.cos(message.direction),
                speed * math.sin(message.direction),
            )
        for person in self.people.values():
            x, y = person.position
            vx, vy = person.velocity
            person.position = (x + vx / self.tick_rate, y + vy / self.tick_rate)

    def _snapshot(self, person: Person) -> bytes:
        people = list(self.people.values())
        none = np.zeros(len(people), dtype=np.int64)
        velocities = np.array([each.velocity for each in people])
        records = pack_records(
            np.array([each.id for each in people]),
            none,
            none,
            np.array([each.position for each in people]),
            np.array([each.height for each in people]),
            np.arctan2(velocities[:, 1], velocities[:, 0]),
            np.hypot(velocities[:, 0], velocities[:, 1]),
            ORIGIN,
        )
        return encode_snapshot(self.tick, person.ack, records.tobytes())


Scripted = TypeVar("Scripted", bound=ScriptedServer)


@asynccontextmanager
async def scripted_server(**settings: Any) -> AsyncIterator[ScriptedServer]:
    """A scripted server on a free port of this machine."""
    async with listening(ScriptedServer(**settings)) as server:
        yield server


@asynccontextmanager
async def listening(server: Scripted) -> AsyncIterator[Scripted]:
    """This server, on a free port of this machine."""
    async with serve(server.talk, "127.0.0.1", 0, compression=None, close_timeout=1.0) as listener:
        server.port = next(iter(listener.sockets)).getsockname()[1]
        ticking = asyncio.create_task(server.run_ticks())
        try:
            yield server
        finally:
            ticking.cancel()
            await asyncio.gather(ticking, return_exceptions=True)


async def _let_messages_arrive() -> None:
    """Let clients in this process answer what they were sent, and let the answers arrive."""
    for _ in range(TURNS):
        await asyncio.sleep(0)


async def until(condition: Callable[[], bool]) -> None:
    """Wait for a condition, as long as tests wait."""
    async with asyncio.timeout(PATIENCE_S):
        while not condition():  # noqa: ASYNC110 (conditions of many kinds, none has an event)
            await asyncio.sleep(0.005)
