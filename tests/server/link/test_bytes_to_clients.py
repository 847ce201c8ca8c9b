"""Clients are sent the same bytes, whether their zone is in their process or behind a broker."""

import asyncio
import hashlib
import multiprocessing
from collections import defaultdict
from collections.abc import Iterator
from multiprocessing.connection import Connection
from typing import Any, Final, cast

import pytest

from esplanade.server.link.broker import connected
from esplanade.server.link.frame_format import decode_frame, encode_frame
from esplanade.server.link.frame_parts import FrameKey
from esplanade.server.link.frames_over_nats import FRAMES_WAITING, FrameReceiver, FrameSender
from esplanade.server.link.local import LocalLink
from esplanade.server.link.subjects import Subjects
from esplanade.server.net.delivery import Delivery
from esplanade.server.world.audience import Audience
from esplanade.server.world.frame import Frame
from tests.patience import COMPILING_PATIENCE_S
from tests.server.brokers import NatsServer, nats_server
from tests.server.doubles import ScriptedPopulation
from tests.server.link.test_frame_format import inputs_of
from tests.server.net.test_delivery import Listener
from tests.server.worlds import FIELD, TICK_S, Trial

TICKS: Final = 2000
PEOPLE: Final = 50
ACTORS: Final = 12
TOGETHER: Final = FRAMES_WAITING // 2
"""The zone's process runs ahead of the clients' by so many ticks at most."""
SUBJECTS: Final = Subjects("town")
EPOCH: Final = 5


@pytest.fixture
def server() -> Iterator[NatsServer]:
    with nats_server() as running:
        yield running


def frames() -> Iterator[Frame]:
    """All frames of a zone in which people come, walk about, talk and go among actors."""
    population = ScriptedPopulation(TICK_S)
    for number in range(ACTORS):
        population.put(f"actor-{number}", (60.0 + number, 70.0))
    trial = Trial(FIELD, population, max_people=PEOPLE + 5)
    for tick in range(TICKS):
        for name, (x, y) in list(population.positions.items()):
            population.put(name, (x + 0.02 * (-1) ** (tick // 400), y + 0.02 * (tick % 3 - 1)))
        yield trial.frame(*inputs_of(trial, tick, PEOPLE))


class Clients:
    """The clients of a zone; a digest of all bytes that each was sent."""

    def __init__(self) -> None:
        trial = Trial(FIELD)
        self._sessions: dict[int, Listener] = {}
        self._audience = Audience(trial.world.rules, trial.world.origin_m, trial.world.times)
        rate = trial.world.rules.tick_rate
        self._delivery = Delivery(self._audience, cast(Any, self._sessions), rate, lambda _: None)
        self.sent: defaultdict[int, Any] = defaultdict(hashlib.sha256)
        self.bytes_sent = 0

    def take(self, frame: Frame) -> None:
        """Send everybody the news of a tick; now and then some of them do not read."""
        self._sessions.update((person, Listener()) for _, person in frame.joined)
        for person, session in self._sessions.items():
            session.line.unsent = 1001 if (person + frame.tick // 5) % 7 == 0 else 0
            session.outbox.fill()
        self._delivery.deliver(self._audience.take(frame), frame.tick * TICK_S)
        for person, session in self._sessions.items():
            sent, session.line.frames = b"".join(session.line.frames), []
            self.sent[person].update(sent)
            self.bytes_sent += len(sent)

    def digests(self) -> dict[int, str]:
        return {person: sent.hexdigest() for person, sent in self.sent.items()}


def run_zone(parent: Connection, address: str) -> None:
    """The process of a zone: so many ticks each time that it is told to go on."""
    asyncio.run(_publish(parent, address))


async def _publish(parent: Connection, address: str) -> None:
    async with connected([address], "host") as client:
        whole = FrameKey(EPOCH, 0, is_whole=True), b""
        sender = FrameSender(client, SUBJECTS, "hall", lambda: whole)
        await sender.start()
        for number, frame in enumerate(frames()):
            if number % TOGETHER == 0:
                await asyncio.to_thread(parent.recv)
            assert await sender.publish(FrameKey(EPOCH, frame.tick), encode_frame(frame))
        await client.flush()
        await sender.stop()


async def test_clients_are_sent_the_same_bytes_by_a_zone_of_another_process(
    server: NatsServer,
) -> None:
    link, near, far = LocalLink(), Clients(), Clients()
    spawning = multiprocessing.get_context("spawn")
    here, there = spawning.Pipe()
    zone = spawning.Process(target=run_zone, args=(there, server.address), daemon=True)
    zone.start()
    async with connected([server.address], "gateway") as client:
        receiver = FrameReceiver(client, SUBJECTS, "hall")
        await receiver.start()
        async with asyncio.timeout(COMPILING_PATIENCE_S):
            key, _ = await receiver.next()
            assert key.is_whole
            for number, frame in enumerate(frames()):
                if number % TOGETHER == 0:
                    here.send("go on")
                link.publish(frame)
                for each in link.frames():
                    near.take(each)
                key, body = await receiver.next()
                assert key == FrameKey(EPOCH, frame.tick)
                far.take(decode_frame(body))
        await receiver.stop()
    await asyncio.to_thread(zone.join)
    assert zone.exitcode == 0
    assert far.digests() == near.digests()
    assert len(near.sent) > PEOPLE
    assert near.bytes_sent > 1000 * TICKS
