"""The policy for slow clients, on a connection whose buffer a test fills; then on a real one."""

from typing import cast

import pytest
from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from esplanade.protocol import ByeCode, decode_server
from esplanade.protocol.messages import Bye, Snapshot, StepBlock
from esplanade.protocol.steps import pack_steps
from esplanade.server.metrics import Traffic
from esplanade.server.net import frames
from esplanade.server.net.outbox import JOINING_PATIENCE_S, MAX_WAITING_FRAMES, Outbox, SlowPolicy
from tests.protocol.steps import made_up_steps
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.net.test_frames import payload_of

POLICY = SlowPolicy(slow_bytes=1000, drop_bytes=4000, drop_seconds=5.0)
NOTHING = memoryview(b"")
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
    assert outbox.snapshot(4, 2, NOTHING, NOTHING, now=0.0)
    assert line.frames[:3] == [b"welcome", b"important", b"offered"]
    assert decode_server(payload_of(line.frames[3])) == Snapshot(tick=4, ack=2, block=b"")
    assert traffic.messages_out == 4
    assert traffic.bytes_out == sum(map(len, line.frames))


def test_a_slow_client_misses_snapshots_but_nothing_important_and_in_order(
    outbox: Outbox, line: StuffedConnection, traffic: Traffic
) -> None:
    line.unsent = 1001
    assert not outbox.snapshot(1, 0, NOTHING, NOTHING, now=0.0)
    assert not outbox.offer(b"offered")
    outbox.post(b"first")
    outbox.post(b"second")
    assert (line.frames, outbox.waiting) == ([], 2)
    line.unsent = 0
    outbox.post(b"third")
    assert line.frames == []
    assert outbox.snapshot(2, 0, NOTHING, NOTHING, now=0.1)
    assert line.frames[:3] == [b"first", b"second", b"third"]
    assert traffic.snapshots_skipped == 1
    assert not line.aborted


def test_steps_go_out_before_their_snapshot_or_both_are_left_out(
    outbox: Outbox, line: StuffedConnection, traffic: Traffic
) -> None:
    steps = pack_steps(made_up_steps(3)).tobytes()
    line.unsent = 1001
    assert not outbox.snapshot(4, 2, NOTHING, memoryview(steps), now=0.0)
    assert (line.frames, traffic.steps_out) == ([], 0)
    line.unsent = 0
    assert outbox.snapshot(5, 2, NOTHING, memoryview(steps), now=0.1)
    assert [decode_server(payload_of(frame)) for frame in line.frames] == [
        StepBlock(tick=5, block=steps),
        Snapshot(tick=5, ack=2, block=b""),
    ]
    assert (traffic.steps_out, traffic.step_bytes_out) == (3, len(steps))
    assert outbox.snapshot(6, 2, NOTHING, NOTHING, now=0.2)
    assert len(line.frames) == 3


def test_a_client_that_stays_slow_is_dropped(outbox: Outbox, line: StuffedConnection) -> None:
    line.unsent = 1001
    outbox.snapshot(1, 0, NOTHING, NOTHING, now=0.0)
    outbox.snapshot(2, 0, NOTHING, NOTHING, now=5.0)
    assert not line.aborted
    outbox.snapshot(3, 0, NOTHING, NOTHING, now=5.1)
    assert line.aborted
    assert outbox.dropped == "seconds"


def test_being_slow_now_and_then_is_forgiven(outbox: Outbox, line: StuffedConnection) -> None:
    for second in range(20):
        line.unsent = 1001 if second % 4 else 0
        outbox.snapshot(second, 0, NOTHING, NOTHING, now=float(second))
    assert not line.aborted


def test_too_much_unsent_drops_at_once(outbox: Outbox, line: StuffedConnection) -> None:
    line.unsent = 4001
    outbox.snapshot(1, 0, NOTHING, NOTHING, now=0.0)
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
    outbox.snapshot(1, 0, NOTHING, NOTHING, now=0.0)
    outbox.snapshot(2, 0, NOTHING, NOTHING, now=JOINING_PATIENCE_S - 1.0)
    assert not line.aborted
    line.unsent = 0
    assert outbox.snapshot(3, 0, NOTHING, NOTHING, now=JOINING_PATIENCE_S)
    line.unsent = 4001
    outbox.snapshot(4, 0, NOTHING, NOTHING, now=JOINING_PATIENCE_S + 0.1)
    assert line.aborted


def test_nothing_is_written_to_a_connection_that_closes(
    outbox: Outbox, line: StuffedConnection
) -> None:
    line.state = State.CLOSING
    outbox.post(b"important")
    assert not outbox.offer(b"offered")
    assert not outbox.snapshot(1, 0, NOTHING, NOTHING, now=0.0)
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
        joined(server.port, "Deaf") as deaf,
    ):
        deaf.connection.transport.pause_reading()
        # The answers to these are more than the kernel's buffers on both sides swallow.
        deaf.connection.transport.write(PING * 18_000)
        await ann.wait_for(lambda: b'slow_total{limit="seconds"}' in server.metrics.exposition())
        assert b'closes_total{reason="too_slow"} 1.0' in server.metrics.exposition()
        assert server.metrics.traffic.snapshots_skipped > 0
        begin = ann.tick
        ticks = [begin]
        while ticks[-1] < begin + 5:
            await ann.until(Snapshot)
            ticks.append(ann.tick)
        assert ticks == list(range(begin, begin + 6))
        deaf.connection.transport.resume_reading()
