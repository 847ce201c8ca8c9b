"""Frames over a real NATS server: the same as in one process, and none after a gap."""

import asyncio
import signal
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import replace
from itertools import pairwise
from typing import Final

import pytest
from nats.aio.client import Client

from esplanade.server.link import broker
from esplanade.server.link.broker import BrokerError, connected
from esplanade.server.link.frame_format import decode_frame, encode_frame
from esplanade.server.link.frame_parts import FrameKey
from esplanade.server.link.frames_over_nats import FRAMES_WAITING, FrameReceiver, FrameSender
from esplanade.server.link.line_numbers import line_number
from esplanade.server.link.subjects import Subjects
from esplanade.server.link.whole_state import WholeState
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input
from tests.patience import PATIENCE_S
from tests.server.brokers import NatsServer, nats_server
from tests.server.link.test_frame_format import inputs_of, same
from tests.server.worlds import FIELD, Trial

SUBJECTS: Final = Subjects("town")
TICK_S: Final = 0.01


@pytest.fixture(scope="module")
def server() -> Iterator[NatsServer]:
    with nats_server() as running:
        yield running


class Host:
    """A host whose zone says nothing but its ticks."""

    def __init__(self, epoch: int = 5) -> None:
        self.epoch = epoch
        self.tick = 0
        self.sender: FrameSender
        self._ticked = asyncio.Condition()

    def key(self, *, whole: bool = False) -> FrameKey:
        return FrameKey(self.epoch, self.tick, whole)

    def whole(self) -> tuple[FrameKey, bytes]:
        return self.key(whole=True), b"all until %d" % self.tick

    async def beat(self) -> None:
        self.tick += 1
        await self.sender.publish(self.key(), b"%d" % self.tick)
        async with self._ticked:
            self._ticked.notify_all()

    async def reached(self, tick: int) -> None:
        async with self._ticked, asyncio.timeout(PATIENCE_S):
            await self._ticked.wait_for(lambda: self.tick >= tick)

    async def beat_for_ever(self) -> None:
        while True:
            await self.beat()
            await asyncio.sleep(TICK_S)


@asynccontextmanager
async def hosting(server: NatsServer, host: Host) -> AsyncIterator[Host]:
    async with connected([server.address], "host") as client:
        host.sender = FrameSender(client, SUBJECTS, "hall", host.whole)
        await host.sender.start()
        beating = asyncio.create_task(host.beat_for_ever())
        yield host
        beating.cancel()
        await host.sender.stop()


@asynccontextmanager
async def receiving(server: NatsServer) -> AsyncIterator[FrameReceiver]:
    async with connected([server.address], "gateway") as client:
        receiver = FrameReceiver(client, SUBJECTS, "hall")
        await receiver.start()
        yield receiver
        await receiver.stop()


async def until(receiver: FrameReceiver, done: Callable[[FrameKey], bool]) -> list[FrameKey]:
    """The frames until then; they come without a gap, or begin anew with a whole state."""
    keys: list[FrameKey] = []
    async with asyncio.timeout(PATIENCE_S):
        while not keys or not done(keys[-1]):
            key, body = await receiver.next()
            told = b"all until %d" % key.tick if key.is_whole else b"%d" % key.tick
            assert body == told
            keys.append(key)
    for one, other in pairwise(keys):
        if other.is_whole:
            assert (other.epoch, other.tick) >= (one.epoch, one.tick)
        else:
            assert (other.epoch, other.tick) == (one.epoch, one.tick + 1)
    return keys


async def test_a_broker_that_is_killed_loses_nothing_of_the_state(server: NatsServer) -> None:
    trial, host, gateway = Trial(FIELD, max_people=40), WholeState(), WholeState()
    host.take(trial.frame())
    said: list[int] = []
    heard: list[int] = []

    def told(*inputs: Input) -> Frame:
        frame = trial.frame(*inputs)
        chat = [
            replace(line, number=line_number(2, frame.tick, k))
            for k, line in enumerate(frame.events.chat)
        ]
        said.extend(line.number for line in chat)
        return replace(frame, events=replace(frame.events, chat=chat))

    def whole() -> tuple[FrameKey, bytes]:
        frame = host.whole()
        return FrameKey(5, frame.tick, is_whole=True), encode_frame(frame)

    async with connected([server.address], "host") as ours, receiving(server) as receiver:
        sender = FrameSender(ours, SUBJECTS, "hall", whole)
        await sender.start()
        begun = asyncio.Event()

        async def take() -> None:
            last: int | None = None
            while True:
                key, body = await receiver.next()
                frame = decode_frame(body)
                if key.is_whole:
                    frame = gateway.difference(frame, heard=last)
                heard.extend(line.number for line in frame.events.chat)
                last = frame.tick
                gateway.take(frame)
                begun.set()

        async def publish(frame: Frame) -> None:
            host.take(frame)
            await sender.publish(FrameKey(5, frame.tick), encode_frame(frame))
            await asyncio.sleep(TICK_S)

        taking = asyncio.create_task(take())
        async with asyncio.timeout(PATIENCE_S):
            while not begun.is_set():  # what was said before is not told to a gateway that comes
                await publish(trial.frame())
        for tick in range(160):
            if tick == 40:
                server.kill()
            if tick == 80:
                server.start()
            await publish(told(*inputs_of(trial, tick)))
        async with asyncio.timeout(PATIENCE_S):
            while not same(gateway.whole(), host.whole()):
                await publish(trial.frame())  # a frame after the gap makes it known
        taking.cancel()
        await sender.stop()
    assert sender.left_out > 10
    assert len(said) > 10
    assert heard == said  # those of the gap as well, and none twice
    assert len(host.whole().entered) > 20


async def test_a_cancellation_that_the_library_misses_is_said_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Deaf(Client):
        async def connect(self, **_: object) -> None:
            for _ in range(3):
                with suppress(asyncio.CancelledError):
                    await asyncio.sleep(PATIENCE_S)
            await asyncio.sleep(PATIENCE_S)

        async def close(self) -> None:
            """Nothing was opened."""

    monkeypatch.setattr(broker, "Client", Deaf)
    monkeypatch.setattr(broker, "CONNECT_S", 0.1)
    async with asyncio.timeout(PATIENCE_S):
        with pytest.raises(BrokerError, match="too late"):
            async with connected(["nats://localhost:1"], "host"):
                pass


async def test_a_gateway_that_comes_late_begins_with_the_whole_state(server: NatsServer) -> None:
    async with hosting(server, Host()) as host:
        await host.reached(20)
        async with receiving(server) as receiver:
            first, *others = await until(receiver, lambda key: key.tick >= 60)
            assert first.is_whole
            assert first.tick >= 20
            assert len(others) >= 60 - first.tick
            assert receiver.resyncs == {"start": 1}


async def test_a_broker_that_is_killed_costs_frames_and_no_more(server: NatsServer) -> None:
    async with hosting(server, Host()) as host, receiving(server) as receiver:
        await until(receiver, lambda key: key.tick >= 10)
        server.kill()
        await asyncio.sleep(0.5)
        at = host.tick
        server.start()
        keys = await until(receiver, lambda key: key.tick > at + 20)
        assert any(key.is_whole for key in keys)
        assert host.sender.left_out > 0
        assert receiver.resyncs["gap"] >= 1


async def test_a_frozen_broker_costs_frames_and_no_more(server: NatsServer) -> None:
    async with hosting(server, Host()) as host, receiving(server) as receiver:
        await until(receiver, lambda key: key.tick >= 10)
        server.signal(signal.SIGSTOP)
        await asyncio.sleep(1.5 * broker.PING_S * (broker.PINGS_UNANSWERED + 1))
        server.signal(signal.SIGCONT)
        at = host.tick
        keys = await until(receiver, lambda key: key.tick > at + 20)
        assert keys[-1].tick > at


async def test_a_slow_gateway_harms_only_itself(server: NatsServer) -> None:
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(hosting(server, Host()))
        slow = await stack.enter_async_context(receiving(server))
        quick = await stack.enter_async_context(receiving(server))
        end = 4 * FRAMES_WAITING
        keys = await until(quick, lambda key: key.tick >= end)
        assert [key for key in keys if key.is_whole] == keys[:1]
        assert slow.resyncs["slow"] >= 1
        late = await until(slow, lambda key: key.tick >= end)
        assert late[0].tick > FRAMES_WAITING


async def test_frames_of_an_owner_that_lost_the_zone_are_refused(server: NatsServer) -> None:
    async with hosting(server, Host(epoch=5)) as old, receiving(server) as receiver:
        await until(receiver, lambda key: key.tick >= 10)
        async with hosting(server, Host(epoch=6)):
            keys = await until(receiver, lambda key: key.epoch == 6 and key.tick >= 50)
            assert [key.epoch for key in keys] == sorted(key.epoch for key in keys)
            assert receiver.resyncs["epoch"] == 1
            assert receiver.refused["stale"] > 10
        assert old.tick > 50


async def test_bytes_that_are_no_frame_are_counted_and_passed_over(server: NatsServer) -> None:
    async with hosting(server, Host()) as host, receiving(server) as receiver:
        await until(receiver, lambda key: key.tick >= 5)
        async with connected([server.address], "stranger") as stranger:
            for body in (b"", b"hello", bytes(500)):
                await stranger.publish(SUBJECTS.frames("hall"), body)
                await stranger.publish(SUBJECTS.questions("hall"), body, reply="nobody")
            await stranger.flush()
        end = host.tick + 5
        await until(receiver, lambda key: key.tick >= end)
        assert receiver.refused["bad"] == 3


async def test_a_broker_that_is_not_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(broker, "CONNECT_S", 0.3)
    with pytest.raises(BrokerError, match=r"no NATS server answers at nats://127\.0\.0\.1:9:"):
        async with connected(["nats://127.0.0.1:9"], "gateway"):
            pass


@pytest.mark.parametrize("name", ["", "Town", "a.b", "a*", "x" * 41])
def test_names_are_checked(name: str) -> None:
    with pytest.raises(ValueError, match="lower-case letters, digits and hyphens"):
        Subjects(name)
    with pytest.raises(ValueError, match="zone has"):
        SUBJECTS.frames(name)
