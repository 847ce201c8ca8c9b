"""A herd: all gateways are restarted at once, and everybody who was connected comes back."""

import asyncio
import random
import struct
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Final, cast

from tests.server.clustering.clusters import Cluster
from tests.server.zones import until

from chaos.wire import SERVER, UPGRADE, RefusedError, frame
from esplanade.protocol import VERSION, CloseCode, ServerCode, decode_server, encode
from esplanade.protocol.messages import Error, Hello, Welcome

TOGETHER: Final = 40
"""In the beginning this many people come in at once."""
FIRST_S: Final = 0.4
LONGEST_S: Final = 4.0
"""Waiting times before one tries again, as in the web client (`client_web/src/net/backoff.ts`)."""
_HEAD_END: Final = b"\r\n\r\n"
_CODE_AT: Final = 1
_OPCODE, _PING, _PONG, _CLOSE = 0x0F, 0x9, 0x8A, 0x88
_LONG: Final = 126
"""A size of a frame that is at least this is a mark, and stands in the bytes after it."""


class Member(asyncio.Protocol):
    """One connection of a member of the herd. It decodes the welcome and refusals alone: a thousand
    of them are to leave the machine to the gateways."""

    def __init__(self, hello: Hello) -> None:
        self._hello = hello
        self._rest = b""
        self._upgraded = False
        loop = asyncio.get_running_loop()
        self.welcome: asyncio.Future[Welcome] = loop.create_future()
        self.ended = asyncio.Event()
        self.refusal: str | None = None
        self.bytes_received = 0
        self.snapshots = 0
        self.snapshot_s = 0.0
        """When the newest snapshot came, seconds of the loop."""
        self.gap_s = 0.0
        """The longest time between two snapshots; whoever asks sets it to 0 again."""
        self._loop = loop

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast(asyncio.Transport, transport)
        self.transport.write(UPGRADE + b"\r\n")

    def connection_lost(self, _error: Exception | None) -> None:
        self.ended.set()
        if not self.welcome.done():
            self.welcome.set_exception(RefusedError(self.refusal or "the connection has ended"))

    def leave(self) -> None:
        """Go for good."""
        if not self.ended.is_set():
            self.transport.write(frame(struct.pack(">H", CloseCode.NORMAL), _CLOSE))
            self.transport.close()

    def data_received(self, data: bytes) -> None:
        self.bytes_received += len(data)
        data = self._rest + data
        if not self._upgraded:
            head, end, rest = data.partition(_HEAD_END)
            if not end:
                self._rest = data
                return
            if b" 101 " not in head.split(b"\r\n")[0]:
                self.refusal = head.split(b"\r\n")[0].decode("latin-1")
                self.transport.abort()
                return
            self._upgraded, data = True, rest
            self.transport.write(frame(encode(self._hello)))
        begin = 0
        while (found := _frame_at(data, begin)) is not None:
            self._take(data[begin] & _OPCODE, data[found[0] : found[1]])
            begin = found[1]
        self._rest = data[begin:]

    def _take(self, opcode: int, payload: bytes) -> None:
        if opcode == _PING:
            self.transport.write(frame(payload, _PONG))
        code = payload[_CODE_AT] if len(payload) > _CODE_AT else None
        if code == ServerCode.SNAPSHOT:
            now_s = self._loop.time()
            if self.snapshots:
                self.gap_s = max(self.gap_s, now_s - self.snapshot_s)
            self.snapshots, self.snapshot_s = self.snapshots + 1, now_s
        elif code in {ServerCode.WELCOME, ServerCode.ERROR}:
            match decode_server(payload):
                case Welcome() as welcome if not self.welcome.done():
                    self.welcome.set_result(welcome)
                case Error() as error:
                    self.refusal = str(error.error)


def _frame_at(data: bytes, begin: int) -> tuple[int, int] | None:
    """The begin and end of the payload of the frame that begins there; None if it is not whole."""
    head = begin + 2
    if len(data) < head:
        return None
    size = data[begin + 1]
    if size >= _LONG:
        head += 2 if size == _LONG else 8
        size = int.from_bytes(data[begin + 2 : head], "big")
    return (head, head + size) if head + size <= len(data) else None


@dataclass
class Person:
    """A member of the herd through all of its connections."""

    name: str
    id: int | None = None
    token: str | None = None
    connection: Member | None = None
    """None while it has no connection on which it was welcomed."""


class Herd:
    """People who stand about, and who come back by their tokens whenever a connection ends."""

    def __init__(self, people: Sequence[Person], ports: Sequence[int], seed: int) -> None:
        self.people = people
        self.refusals: Counter[str] = Counter()
        """Names of errors, by which somebody was refused."""
        self.faults: list[str] = []
        self._ports = ports
        self._chance = random.Random(seed)
        self._gate = asyncio.Semaphore(TOGETHER)

    @property
    def inside(self) -> int:
        """The number of those who are shown the place."""
        return sum(each.connection is not None for each in self.people)

    @property
    def bytes_received(self) -> int:
        """Bytes that came on the connections that there are now."""
        connections = (each.connection for each in self.people)
        return sum(one.bytes_received for one in connections if one is not None)

    async def all_in(self) -> None:
        """Wait until everybody is in, and is shown something from then on."""
        await until(lambda: self.inside == len(self.people))
        before = [_snapshots(each) for each in self.people]
        await until(
            lambda: all(
                _snapshots(each) != had for each, had in zip(self.people, before, strict=True)
            )
        )

    async def live(self) -> None:
        """Let everybody live, until cancelled."""
        async with asyncio.TaskGroup() as tasks:
            for each in self.people:
                tasks.create_task(self._live(each))

    async def _live(self, person: Person) -> None:
        attempt = 0
        while True:
            try:
                member = await self._come_in(person)
            except OSError:
                longest_s = min(LONGEST_S, FIRST_S * 2**attempt)
                await asyncio.sleep(longest_s * self._chance.uniform(0.5, 1.0))
                attempt += 1
                continue
            attempt = 0
            try:
                await member.ended.wait()
            finally:
                person.connection = None
                member.leave()

    async def _come_in(self, person: Person) -> Member:
        """Come in, or come back.

        Raises
        ------
        OSError
            Nobody listens, or the person is refused.
        """
        member = Member(Hello(name=person.name, version=VERSION, resume=person.token))
        port = self._chance.choice(self._ports)
        async with self._gate if person.id is None else nullcontext():
            await asyncio.get_running_loop().create_connection(lambda: member, SERVER, port)
            try:
                welcome = await member.welcome
            except BaseException:
                member.transport.abort()
                if member.refusal is not None:
                    self.refusals[member.refusal] += 1
                raise
        if person.id not in {None, welcome.id}:
            self.faults.append(f"{person.name} was {person.id} and has come back as {welcome.id}")
        person.id, person.token, person.connection = welcome.id, welcome.resume, member
        return member


@dataclass(frozen=True)
class Return:
    """The return of a herd."""

    seconds: float
    """From the death of all gateways until everybody was in again."""
    refusals: dict[str, int]
    """The number of refusals on the way, by the names of errors."""
    faults: list[str]
    """Things that cannot be; a sentence each."""


async def restart_gateways(cluster: Cluster, people: int, *words: str) -> Return:
    """Let a herd in, kill all gateways, and begin others at their ports with these options."""
    gateways = cluster.gateways
    members = [Person(f"Member {k + 1}") for k in range(people)]
    herd = Herd(members, [each.port for each in gateways], seed=people)
    living = asyncio.create_task(herd.live())
    try:
        await herd.all_in()
        since_s = time.monotonic()
        for gateway in gateways:
            gateway.kill()
        for gateway in gateways:
            cluster.gateway("--port", str(gateway.port), *words, name=f"{gateway.name}-again")
        await until(lambda: not herd.inside)
        await herd.all_in()
        seconds = time.monotonic() - since_s
        seats = len(await asyncio.to_thread(lambda: cluster.seats))
        faults = list(herd.faults)
        if seats != people:
            faults.append(f"there are {seats} seats of {people} people")
        return Return(seconds, dict(herd.refusals), faults)
    finally:
        living.cancel()
        await asyncio.gather(living, return_exceptions=True)


def _snapshots(person: Person) -> int:
    return 0 if person.connection is None else person.connection.snapshots
