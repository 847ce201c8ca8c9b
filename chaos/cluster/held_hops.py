"""A hop that is held at one of its steps, from outside of the processes that take part in it.

What a process is not to do yet it cannot do: it stands still, or waits for the row of the seat,
which a transaction of ours has locked. What is said to the zone where the person goes is listened
to at the broker, so that the moment is known and not waited for.
"""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from enum import Enum
from typing import Any, Final, Self

import msgpack
from nats.aio.client import Client
from nats.aio.msg import Msg
from sqlalchemy import Connection, Engine, create_engine, select, text
from tests.patience import PATIENCE_S
from tests.server.clustering.clusters import Cluster, Gateway, Process
from tests.server.zones import until

from esplanade.server.cluster.seats import seat_of
from esplanade.server.cluster.world_rows import world_kept
from esplanade.server.host.portals import KEPT, PREPARE
from esplanade.server.link.batches import BatchError, decode_batch
from esplanade.server.link.broker import connected
from esplanade.server.link.subjects import Subjects
from esplanade.server.store.location import Location
from esplanade.server.store.tables import CLUSTER_SEATS

_SYNC: Final = b"sync"


class Step(Enum):
    """The steps of a hop at which everything is held."""

    ASKED = "asked"
    """The zone left has asked for a place, and the other one has not answered."""
    KEPT = "kept"
    """The other zone keeps a place, and the zone left does not know."""
    MOVING = "moving"
    """The statement that moves the seat waits in the database."""
    MOVED = "moved"
    """The seat is the other zone's, and neither that nor the gateway knows."""
    FOLLOWED = "followed"
    """The gateway has gone after the seat, and the other zone does not know yet."""


MOVED: Final = {Step.MOVED, Step.FOLLOWED}
"""From these steps on the person is the other zone's, whoever dies."""


@dataclass(frozen=True)
class Way:
    """The processes that take part in a hop."""

    origin: Process
    destination: Process
    gateway: Gateway
    zone: str
    """The zone of the destination."""


class Ear:
    """Everything that is said to one zone over the broker."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._heard: list[Msg] = []
        self._more = asyncio.Event()

    @classmethod
    @asynccontextmanager
    async def at(cls, servers: str, subjects: Subjects, zone: str) -> AsyncIterator[Self]:
        """Listen from now on at any of the servers, which are separated by commas."""
        async with connected(servers.split(","), "ear") as client:
            made = cls(client)
            for subject in (subjects.questions(zone), subjects.inputs(zone)):
                await client.subscribe(subject, cb=made._take)
            await client.flush()
            yield made

    async def said(self, wanted: Callable[[bytes], bool]) -> Msg:
        """The first message that is wanted, as soon as it is said."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                for message in self._heard:
                    if wanted(message.data):
                        return message
                self._more.clear()
                await self._more.wait()

    async def answers(self, question: Msg) -> "asyncio.Future[bytes]":
        """The answer to a question, which may be waited for."""
        answer: asyncio.Future[bytes] = asyncio.get_running_loop().create_future()

        async def take(message: Msg) -> None:
            if not answer.done():
                answer.set_result(message.data)

        await self._client.subscribe(question.reply, cb=take)
        await self._client.flush()
        return answer

    def forget(self) -> None:
        """Leave out what was said so far."""
        self._heard.clear()

    async def _take(self, message: Msg) -> None:
        self._heard.append(message)
        self._more.set()


class SeatLock:
    """A transaction that holds the row of a seat: whoever wants to write it waits."""

    def __init__(self, database: str, person: int) -> None:
        self._engine: Engine = create_engine(Location.of(None, database).url)
        self._connection: Connection = self._engine.connect()
        table = CLUSTER_SEATS.c
        row = select(table.person).where(table.person == person).with_for_update()
        self._connection.execute(row).one()

    def release(self) -> None:
        self._connection.close()
        self._engine.dispose()


@asynccontextmanager
async def held(
    cluster: Cluster, way: Way, person: int, step: Step, go: Callable[[], None]
) -> AsyncIterator[None]:
    """Let a person go by `go`, and hold the hop at a step; it goes on at the end.

    What was frozen is thawed then, and what was locked is free.
    """
    subjects = Subjects((await asyncio.to_thread(cluster.ask, world_kept)).subject)
    lock: SeatLock | None = None
    try:
        async with Ear.at(cluster.broker.address, subjects, way.zone) as ear:
            if step in {Step.ASKED, Step.KEPT}:
                way.destination.freeze()
                go()
                question = await ear.said(lambda said: _asks_for(person, said))
                if step is Step.KEPT:
                    way.origin.freeze()
                    answer = await ear.answers(question)
                    way.destination.thaw()
                    if await asyncio.wait_for(answer, PATIENCE_S) != KEPT:
                        raise RuntimeError(f"{way.zone} has no room for person {person}")
            else:
                lock = await asyncio.to_thread(SeatLock, cluster.database, person)
                go()
                await _until(cluster, _seat_is_waited_for)
                if step is not Step.MOVING:
                    way.gateway.freeze()
                    way.destination.freeze()
                    ear.forget()
                    lock.release()
                    await _until(cluster, lambda to: _is_in(to, person, way.zone))
                if step is Step.FOLLOWED:
                    way.gateway.thaw()
                    await ear.said(lambda said: said == _SYNC or _serves(person, said))
            yield
    finally:
        cluster.thaw()
        if lock is not None:
            lock.release()


def _asks_for(person: int, said: bytes) -> bool:
    """Whether a message asks for a place for somebody."""
    if said == _SYNC or said.startswith(b"EB"):
        return False
    kind, asked, _ = msgpack.unpackb(said)
    return (kind, asked) == (PREPARE, person)


def _serves(person: int, said: bytes) -> bool:
    """Whether a message is a batch of a gateway that serves somebody."""
    try:
        return any(one == person for one, _ in decode_batch(said).held)
    except BatchError:
        return False


async def _until(cluster: Cluster, condition: Callable[[Connection], Any]) -> None:
    """Wait until the database fulfils a condition."""
    await until(lambda: bool(cluster.ask(condition)))


def _seat_is_waited_for(connection: Connection) -> bool:
    """Whether a statement that moves a seat waits for its row."""
    waiting = text(
        "select count(*) from pg_stat_activity where datname = current_database()"
        " and wait_event_type = 'Lock' and query like 'UPDATE cluster_seats SET zone=%'"
    )
    return bool(connection.execute(waiting).scalar_one())


def _is_in(connection: Connection, person: int, zone: str) -> bool:
    seat = seat_of(connection, person)
    return seat is not None and seat.zone == zone
