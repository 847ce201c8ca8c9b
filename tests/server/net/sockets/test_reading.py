"""However a stream is cut, the same messages come in the same order as by a transport alone."""

import asyncio
import socket
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import asynccontextmanager
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from websockets.frames import Frame, Opcode

from esplanade.protocol import decode_client, encode
from esplanade.protocol.messages import ClientMessage, Move, Ping
from esplanade.server.metrics import Traffic
from esplanade.server.net.metering import Meter
from esplanade.server.net.sockets.reading import FRAME_BYTES, LOW, PAID, Reading
from esplanade.server.net.sockets.receiving import CHUNK_BYTES
from esplanade.server.net.sockets.system import AVAILABLE, descriptor_of
from tests.naive.movements import movements_in

pytestmark = pytest.mark.skipif(not AVAILABLE, reason="kernels call the system on Linux only")

AVATAR = 7
RATE = 1000.0


class Recorder(asyncio.Protocol):
    """A connection that parses what it is given, and asks to be read at once after a movement."""

    def __init__(self, rate: float = RATE) -> None:
        self.heard = False
        self.descriptor = -1
        self.reading: Reading | None = None
        self.got: list[ClientMessage] = []
        self.alone = 0
        """Movements that were taken without the kernel."""
        self.ended = asyncio.Event()
        self.broken: str | None = None
        self._rest = b""
        self._meter = Meter(rate, asyncio.get_running_loop().time())
        self._meter.charge(b"GET / HTTP/1.1\r\n\r\n", asyncio.get_running_loop().time())

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport
        self.descriptor = descriptor_of(transport)

    def connection_lost(self, _error: Exception | None) -> None:
        if self.reading is not None:
            self.reading.leave(self)
        self.ended.set()

    def prepay(self, frames: int, now: float) -> bool:
        return self._meter.prepay(frames, FRAME_BYTES, now)

    def pay_back(self, frames: int, now: float) -> None:
        self._meter.pay_back(frames, FRAME_BYTES, now)

    def data_received(self, data: bytes) -> None:
        self.broken = self.broken or self._meter.charge(data, asyncio.get_running_loop().time())
        self._rest += data
        moved = False
        while len(self._rest) >= 6 and len(self._rest) >= (size := 6 + (self._rest[1] & 0x7F)):
            mask, payload = self._rest[2:6], self._rest[6:size]
            plain = bytes(byte ^ mask[k % 4] for k, byte in enumerate(payload))
            message = decode_client(plain)
            moved = isinstance(message, Move)
            self.alone += moved
            self.got.append(message)
            self._rest = self._rest[size:]
        if moved and not self._rest and self.reading is not None:
            self.reading.enter(self, AVATAR)

    def moved(
        self,
        avatars: Sequence[int],
        numbers: Sequence[int],
        directions: Sequence[float],
        speeds: Sequence[float],
    ) -> None:
        """Take the movements that were read by the kernel."""
        assert avatars == [AVATAR]
        self.got.append(Move(seq=numbers[0], direction=directions[0], speed=speeds[0]))


@asynccontextmanager
async def watched(
    rate: float = RATE, traffic: Traffic | None = None, *, ticking: bool = True
) -> AsyncIterator[tuple[Recorder, socket.socket, Reading]]:
    """A connection, its other end, and what reads it; `ticking` asks for movements."""
    loop = asyncio.get_running_loop()
    with socket.create_server(("127.0.0.1", 0)) as listening:
        there = socket.create_connection(listening.getsockname())
        here, _ = listening.accept()
    here.setblocking(False)
    there.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    recorder = Recorder(rate)
    transport, _ = await loop.connect_accepted_socket(lambda: recorder, here)
    reading = recorder.reading = Reading(recorder.moved, traffic or Traffic())
    ticks = asyncio.create_task(tick(reading)) if ticking else None
    try:
        with there:
            yield recorder, there, reading
    finally:
        if ticks is not None:
            ticks.cancel()
        reading.close()
        transport.abort()
        await recorder.ended.wait()


async def tick(reading: Reading) -> None:
    while True:
        await asyncio.sleep(0.001)
        reading.deliver()


def frame(message: ClientMessage) -> bytes:
    return Frame(Opcode.BINARY, encode(message)).serialize(mask=True)


def is_subsequence(of: Sequence[ClientMessage], found: Sequence[ClientMessage]) -> bool:
    rest: Iterator[ClientMessage] = iter(of)
    return all(message in rest for message in found)


async def until(condition: object) -> None:
    assert callable(condition)
    async with asyncio.timeout(10.0):
        while not condition():  # noqa: ASYNC110 (the other end of a socket tells nobody)
            await asyncio.sleep(0.001)


MESSAGES = st.lists(
    st.one_of(
        st.builds(Ping, nonce=st.integers(0, 1000)),
        st.builds(Move, seq=st.just(0), direction=st.floats(-9.0, 9.0), speed=st.just(1.0)),
        st.builds(Move, seq=st.just(0), direction=st.floats(-9.0, 9.0), speed=st.just(1.0)),
    ),
    min_size=1,
    max_size=20,
)


@settings(max_examples=40, deadline=None)
@given(MESSAGES, st.lists(st.integers(0, 2**16), max_size=12), st.lists(st.booleans(), min_size=9))
def test_all_messages_come_in_their_order_but_movements_that_later_ones_replace(
    messages: list[ClientMessage], cuts: list[int], waits: list[bool]
) -> None:
    sent: list[ClientMessage] = [
        each.model_copy(update={"seq" if isinstance(each, Move) else "nonce": k})
        for k, each in enumerate(messages)
    ]
    frames = [frame(each) for each in sent]
    stream = b"".join(frames)
    # Most cuts are between frames, as from honest clients.
    borders = [len(b"".join(frames[:k])) for k in range(len(frames) + 1)]
    places = {borders[cut % len(borders)] if cut % 3 else cut % len(stream) for cut in cuts}

    async def run() -> list[ClientMessage]:
        async with watched() as (recorder, there, reading):
            for k, (begin, end) in enumerate(pairwise(sorted({0, *places, len(stream)}))):
                there.sendall(stream[begin:end])
                if waits[k % len(waits)]:
                    await asyncio.sleep(0.0)
                    reading.poll()
                if waits[-k % len(waits)]:
                    reading.deliver()
            await until(lambda: recorder.got and recorder.got[-1] == sent[-1])
            assert recorder.broken is None
            return recorder.got

    got = asyncio.run(run())
    assert is_subsequence(sent, got)
    missing = [each for each in sent if each not in got]
    assert all(isinstance(each, Move) for each in missing)
    for each in missing:
        # A later one came before it was asked for.
        assert isinstance(sent[sent.index(each) + 1], Move)


async def test_whole_movements_are_read_at_once_and_anything_else_alone() -> None:
    traffic = Traffic()
    async with watched(traffic=traffic) as (recorder, there, reading):
        first = [Move(seq=k, direction=0.5 * k, speed=1.0) for k in range(4)]
        for k, each in enumerate(first):
            there.sendall(frame(each))
            await until(lambda k=k: len(recorder.got) == k + 1)
        assert recorder.got == first
        assert recorder.alone == 1
        assert traffic.messages_in == 3
        assert traffic.bytes_in == sum(len(encode(each)) for each in first[1:])
        assert len(reading) == 1
        both = frame(first[0]) + frame(first[1])
        assert movements_in(both) == first[:2]
        there.sendall(both)
        await until(lambda: len(recorder.got) == 5)
        assert (recorder.got[-1], traffic.movements_superseded) == (first[1], 1)
        there.sendall(frame(Ping(nonce=1)))
        await until(lambda: len(recorder.got) == 6)
        assert recorder not in reading
        assert recorder.transport.is_reading()
        there.sendall(frame(first[2]))
        await until(lambda: recorder in reading)
        assert recorder.alone == 2


@pytest.mark.parametrize("kept", ["half a frame", "many"])
async def test_a_half_frame_and_a_long_chunk_go_back_whole(kept: str) -> None:
    async with watched() as (recorder, there, reading):
        there.sendall(frame(Move(seq=0, direction=0.0, speed=1.0)))
        await until(lambda: recorder in reading)
        sent = [Move(seq=k, direction=0.0, speed=1.0) for k in range(1, 2 + CHUNK_BYTES // 20)]
        stream = b"".join(frame(each) for each in sent)
        assert len(stream) > CHUNK_BYTES
        end = 20 if kept == "half a frame" else len(stream)
        there.sendall(stream[:end])
        await until(lambda: recorder not in reading or recorder.alone > 1)
        there.sendall(stream[end:])
        await until(lambda: recorder.got[-1] == sent[-1])
        assert recorder.got[1:] == sent


async def test_frames_are_paid_for_before_they_are_read() -> None:
    async with watched(rate=5.0) as (recorder, there, reading):
        # The burst is 20 frames: one of them comes alone, and the purse is filled from the others.
        sent = 0
        while recorder.broken is None and sent < 40:
            there.sendall(frame(Move(seq=sent, direction=0.0, speed=1.0)))
            sent += 1
            await until(lambda sent=sent: len(recorder.got) == sent)
            if sent == 2:
                assert reading._receiving.purses.frames[recorder.descriptor] == PAID - 1
        assert recorder.broken == "frames"
        assert 20 <= sent <= 20 + PAID
        assert 0 < LOW < PAID


async def test_credit_is_given_back_to_whoever_leaves() -> None:
    async with watched(rate=5.0) as (recorder, there, reading):
        for k in range(6):
            there.sendall(frame(Move(seq=k, direction=0.0, speed=1.0)))
            await until(lambda k=k: recorder in reading and len(recorder.got) > 2 * k)
            there.sendall(frame(Ping(nonce=k)))
            await until(lambda k=k: len(recorder.got) > 2 * k + 1)
        assert recorder.broken is None


async def test_movements_that_cannot_be_taken_end_nothing() -> None:
    async with watched() as (recorder, there, reading):
        there.sendall(frame(Move(seq=0, direction=0.0, speed=1.0)))
        await until(lambda: recorder in reading)
        taken: list[int] = []

        def fail_once(*columns: Sequence[float]) -> None:
            taken.append(int(columns[1][0]))
            if len(taken) == 1:
                raise ValueError("it was meant to fail")

        reading._take = fail_once
        for k in (1, 2):
            there.sendall(frame(Move(seq=k, direction=0.0, speed=1.0)))
            await until(lambda k=k: len(taken) == k)
        assert taken == [1, 2]
        assert recorder in reading


@pytest.mark.parametrize("how", ["end", "reset"])
async def test_an_end_is_left_to_the_transport(how: str) -> None:
    async with watched() as (recorder, there, reading):
        there.sendall(frame(Move(seq=0, direction=0.0, speed=1.0)))
        await until(lambda: recorder in reading)
        if how == "reset":
            there.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        else:
            there.sendall(frame(Move(seq=1, direction=0.0, speed=1.0)))
        there.close()
        await asyncio.wait_for(recorder.ended.wait(), 10.0)
        assert recorder not in reading
        if how == "end":
            assert recorder.got[-1] == Move(seq=1, direction=0.0, speed=1.0)


async def test_a_connection_that_was_cut_off_is_read_no_more() -> None:
    async with watched() as (recorder, there, reading):
        there.sendall(frame(Move(seq=0, direction=0.0, speed=1.0)))
        await until(lambda: recorder in reading)
        there.sendall(frame(Ping(nonce=1)))
        recorder.transport.abort()
        reading.poll()
        await recorder.ended.wait()
        assert len(recorder.got) == 1
        assert len(reading) == 0


async def test_the_latest_movement_waits_for_the_tick_and_goes_before_what_comes_after_it() -> None:
    traffic = Traffic()
    async with watched(traffic=traffic, ticking=False) as (recorder, there, reading):
        moves = [Move(seq=k, direction=0.5 * k, speed=1.0) for k in range(5)]
        there.sendall(frame(moves[0]))
        await until(lambda: recorder in reading)
        for k in (1, 2, 3):
            there.sendall(frame(moves[k]))
            await until(lambda k=k: traffic.messages_in == k)
        assert recorder.got == moves[:1]
        assert reading.waiting() == [AVATAR]
        assert traffic.movements_superseded == 2
        reading.deliver()
        assert recorder.got == [moves[0], moves[3]]
        assert reading.waiting() == []
        assert not recorder.heard
        reading.tell_heard()
        assert recorder.heard
        recorder.heard = False
        reading.tell_heard()
        assert not recorder.heard
        there.sendall(frame(moves[4]))
        await until(lambda: reading.waiting() == [AVATAR])
        assert len(recorder.got) == 2
        there.sendall(frame(Ping(nonce=1)))
        await until(lambda: len(recorder.got) == 4)
        assert recorder.got[2:] == [moves[4], Ping(nonce=1)]
        assert recorder.heard
        assert recorder not in reading
        assert reading.waiting() == []


async def test_a_movement_that_waits_is_taken_when_its_connection_ends() -> None:
    async with watched(ticking=False) as (recorder, there, reading):
        there.sendall(frame(Move(seq=0, direction=0.0, speed=1.0)))
        await until(lambda: recorder in reading)
        there.sendall(frame(Move(seq=1, direction=0.0, speed=1.0)))
        await until(lambda: reading.waiting() == [AVATAR])
        there.close()
        await asyncio.wait_for(recorder.ended.wait(), 10.0)
        assert recorder.got[1:] == [Move(seq=1, direction=0.0, speed=1.0)]
        assert reading.waiting() == []


async def test_a_quiet_loop_looks_only_when_something_comes() -> None:
    async with watched(ticking=False) as (recorder, there, reading):
        there.sendall(frame(Move(seq=0, direction=0.0, speed=1.0)))
        await until(lambda: recorder in reading)
        looks = 0
        poll = reading.poll

        def count() -> int:
            nonlocal looks
            looks += 1
            return poll()

        reading.poll = count  # type: ignore[method-assign]
        await asyncio.sleep(0.1)
        quiet = looks
        assert quiet <= 2
        there.sendall(frame(Move(seq=1, direction=0.0, speed=1.0)))
        await until(lambda: reading.waiting() == [AVATAR])
        assert looks > quiet
