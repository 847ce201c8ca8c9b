"""The policy for slow clients, on a connection whose buffer a test fills; then on a real one."""

from typing import cast

import pytest
import structlog
from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from esplanade.protocol import ByeCode, encode_snapshot
from esplanade.protocol.messages import Bye, Snapshot
from esplanade.server.metrics import Traffic
from esplanade.server.net import frames
from esplanade.server.net.outbox import JOINING_PATIENCE_S, MAX_WAITING_FRAMES, Outbox, SlowPolicy
from esplanade.server.world.audience import STEP_BYTES
from tests.server.client import joined
from tests.server.conftest import Serving

POLICY = SlowPolicy(slow_bytes=1000, drop_bytes=4000, drop_seconds=5.0)
SNAPSHOT = frames.frame(encode_snapshot(4, 2, b""))
PING = b"\x89\xfd" + bytes(4 + 125)
"""A ping of a client with the largest payload there may be."""


class StuffedConnection:
    """Plays connection, transport and socket; `unsent` is what the client has not read."""

    def __init__(self) -> None:
        self.transport = self
        self.state = State.OPEN
        self.unsent = 0
        self.frames: list[bytes] = []
        self.aborted = False

    def get_extra_info(self, _: str) -> "StuffedConnection":
        return self

    def setsockopt(self, *_: int) -> None: ...

    def get_write_buffer_size(self) -> int:
        return self.unsent

    def is_closing(self) -> bool:
        return self.aborted

    def write(self, frame: bytes) -> None:
        self.frames.append(frame)

    def abort(self) -> None:
        self.aborted = True


@pytest.fixture
def line() -> StuffedConnection:
    return StuffedConnection()


@pytest.fixture
def traffic() -> Traffic:
    return Traffic()


@pytest.fixture
def outbox(line: StuffedConnection, traffic: Traffic) -> Outbox:
    return Outbox(cast(ServerConnection, line), POLICY, traffic)


def test_a_client_that_reads_gets_everything_at_once(
    outbox: Outbox, line: StuffedConnection, traffic: Traffic
) -> None:
    outbox.welcome(b"welcome")
    outbox.post(b"important")
    assert outbox.offer(b"offered")
    assert outbox.snapshot(SNAPSHOT, 0, now=0.0)
    assert line.frames[:3] == [b"welcome", b"important", b"offered"]
    assert line.frames[3] == SNAPSHOT
    assert traffic.messages_out == 4
    assert traffic.bytes_out == sum(map(len, line.frames))


def test_a_slow_client_misses_snapshots_but_nothing_important_and_in_order(
    outbox: Outbox, line: StuffedConnection, traffic: Traffic
) -> None:
    line.unsent = 1001
    assert not outbox.snapshot(SNAPSHOT, 0, now=0.0)
    assert not outbox.offer(b"offered")
    outbox.post(b"first")
    outbox.post(b"second")
    assert (line.frames, outbox.waiting) == ([], 2)
    line.unsent = 0
    outbox.post(b"third")
    assert line.frames == []
    assert outbox.snapshot(SNAPSHOT, 0, now=0.1)
    assert line.frames[:3] == [b"first", b"second", b"third"]
    assert traffic.snapshots_skipped == 1
    assert not line.aborted


def test_steps_go_out_before_their_snapshot_or_both_are_left_out(
    outbox: Outbox, line: StuffedConnection, traffic: Traffic
) -> None:
    line.unsent = 1001
    assert not outbox.snapshot(b"steps and snapshot", 3, now=0.0)
    assert (line.frames, traffic.steps_out) == ([], 0)
    line.unsent = 0
    assert outbox.snapshot(b"steps and snapshot", 3, now=0.1)
    assert line.frames == [b"steps and snapshot"]
    assert (traffic.steps_out, traffic.step_bytes_out) == (3, 3 * STEP_BYTES)
    assert traffic.messages_out == 2
    assert outbox.snapshot(SNAPSHOT, 0, now=0.2)
    assert (traffic.steps_out, traffic.messages_out) == (3, 3)


def test_what_must_not_be_lost_goes_first_with_the_snapshot_or_waits(
    outbox: Outbox, line: StuffedConnection, traffic: Traffic
) -> None:
    assert outbox.snapshot(b"snapshot", 0, now=0.0, first=[b"leave ", b"enter "])
    assert line.frames == [b"leave enter snapshot"]
    assert traffic.messages_out == 3
    line.unsent = 1001
    assert not outbox.snapshot(b"left out", 0, now=0.1, first=[b"leave", b"enter"])
    assert outbox.waiting == 2
    line.unsent = 0
    assert outbox.snapshot(b"snapshot", 0, now=0.2, first=[b"later"])
    assert line.frames[1:] == [b"leave", b"enter", b"later", b"snapshot"]
    line.unsent = 1001
    many = [b"important"] * (MAX_WAITING_FRAMES + 1)
    assert not outbox.snapshot(b"left out", 0, now=0.3, first=many)
    assert outbox.dropped == "waiting"


def test_a_client_that_stays_slow_is_dropped(outbox: Outbox, line: StuffedConnection) -> None:
    line.unsent = 1001
    outbox.snapshot(SNAPSHOT, 0, now=0.0)
    outbox.snapshot(SNAPSHOT, 0, now=5.0)
    assert not line.aborted
    outbox.snapshot(SNAPSHOT, 0, now=5.1)
    assert line.aborted
    assert outbox.dropped == "seconds"


def test_being_slow_now_and_then_is_forgiven(outbox: Outbox, line: StuffedConnection) -> None:
    for second in range(20):
        line.unsent = 1001 if second % 4 else 0
        outbox.snapshot(SNAPSHOT, 0, now=float(second))
    assert not line.aborted


def test_too_much_unsent_drops_at_once(outbox: Outbox, line: StuffedConnection) -> None:
    line.unsent = 4001
    outbox.snapshot(SNAPSHOT, 0, now=0.0)
    assert outbox.dropped == "bytes"


def test_the_list_of_what_must_not_be_lost_is_bounded(
    outbox: Outbox, line: StuffedConnection
) -> None:
    line.unsent = 1001
    for _ in range(MAX_WAITING_FRAMES):
        outbox.post(b"important")
    assert not line.aborted
    outbox.post(b"one too many")
    assert line.aborted
    assert outbox.dropped == "waiting"
    outbox.post(b"after the end")
    assert not outbox.offer(b"after the end")
    assert line.frames == []


def test_a_large_scene_may_take_its_time(outbox: Outbox, line: StuffedConnection) -> None:
    outbox.welcome(bytes(100_000))
    line.unsent = 101_000
    outbox.snapshot(SNAPSHOT, 0, now=0.0)
    outbox.snapshot(SNAPSHOT, 0, now=JOINING_PATIENCE_S - 1.0)
    assert not line.aborted
    line.unsent = 0
    assert outbox.snapshot(SNAPSHOT, 0, now=JOINING_PATIENCE_S)
    line.unsent = 4001
    outbox.snapshot(SNAPSHOT, 0, now=JOINING_PATIENCE_S + 0.1)
    assert line.aborted


def test_nothing_is_written_to_a_connection_that_closes(
    outbox: Outbox, line: StuffedConnection
) -> None:
    line.state = State.CLOSING
    outbox.post(b"important")
    assert not outbox.offer(b"offered")
    assert not outbox.snapshot(SNAPSHOT, 0, now=0.0)
    assert line.frames == []


def test_at_the_end_all_that_waits_goes_out(outbox: Outbox, line: StuffedConnection) -> None:
    line.unsent = 1001
    farewell = frames.message(Bye(reason=ByeCode.SHUTDOWN, text="good night"))
    outbox.post(farewell)
    outbox.flush()
    assert line.frames == [farewell]


async def test_a_client_that_never_reads_is_dropped_and_nobody_else_waits(
    serving: Serving,
) -> None:
    async with (
        serving(drop_seconds=0.3, drop_bytes=64 * 1024**2, message_rate=10_000.0) as server,
        joined(server.port, "Ann") as ann,
        joined(server.port, "Deaf", source="127.0.0.2") as deaf,
    ):
        deaf.connection.transport.pause_reading()
        # The answers to these are more than the kernel's buffers on both sides swallow.
        deaf.connection.transport.write(PING * 18_000)
        with structlog.testing.capture_logs() as lines:
            await ann.wait_for(
                lambda: b'slow_total{limit="seconds"}' in server.metrics.exposition()
            )
        (line,) = [line for line in lines if line["event"] == "client dropped, too slow"]
        assert (line["why"], line["address"]) == ("seconds", "127.0.0.2")
        assert b'closes_total{reason="too_slow"} 1.0' in server.metrics.exposition()
        assert server.metrics.traffic.snapshots_skipped > 0
        begin = ann.tick
        ticks = [begin]
        while ticks[-1] < begin + 5:
            await ann.until(Snapshot)
            ticks.append(ann.tick)
        assert ticks == list(range(begin, begin + 6))
        deaf.connection.transport.resume_reading()


def test_what_waits_for_a_slow_client_is_void_in_another_zone(
    outbox: Outbox, line: StuffedConnection
) -> None:
    line.unsent = POLICY.slow_bytes + 1
    outbox.post(b"of the zone before")
    assert outbox.waiting == 1
    outbox.begin_anew()
    outbox.welcome(b"welcome")
    line.unsent = 0
    outbox.snapshot(SNAPSHOT, 0, 1.0)
    assert line.frames == [b"welcome", SNAPSHOT]
