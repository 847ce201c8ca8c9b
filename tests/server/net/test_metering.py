"""A meter counts the frames that the library's parser finds, whatever the chunks."""

import struct
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.frames import Frame, Opcode
from websockets.protocol import Protocol, Side

from esplanade.server.net.metering import (
    CONTROL_RATE,
    MAX_FRAME_BYTES,
    MAX_HEAD_BYTES,
    FrameWalk,
    Meter,
)

REQUEST = b"GET /ws HTTP/1.1\r\nHost: localhost\r\n\r\n"
EMPTY_PING = b"\x89\x80" + bytes(4)

SIZES = st.one_of(st.integers(0, 130), st.sampled_from([125, 126, 127, 2048, 65_535, 65_536]))


@st.composite
def frames(draw: st.DrawFn) -> list[Frame]:
    """A valid stream of frames from a client: messages in fragments, control frames among them."""
    found: list[Frame] = []
    within = False
    for _ in range(draw(st.integers(0, 12))):
        if draw(st.booleans()):
            opcode = draw(st.sampled_from([Opcode.PING, Opcode.PONG]))
            found.append(Frame(opcode, bytes(draw(st.integers(0, 125)))))
        else:
            final = draw(st.booleans())
            opcode = Opcode.CONT if within else Opcode.BINARY
            found.append(Frame(opcode, bytes(draw(SIZES)), final))
            within = not final
    return found


def chunks(stream: bytes, cuts: list[int]) -> list[bytes]:
    places = [0, *sorted(cut % (len(stream) + 1) for cut in cuts), len(stream)]
    return [stream[begin:end] for begin, end in pairwise(places)]


@given(frames(), st.lists(st.integers(0, 2**20), max_size=40), st.integers(1, 3))
def test_the_walk_finds_the_frames_that_the_library_parses(
    sent: list[Frame], cuts: list[int], apart: int
) -> None:
    stream = b"".join(frame.serialize(mask=True) for frame in sent)
    cuts = [cut + step for cut in cuts for step in range(apart)]
    walk, parser = FrameWalk(), Protocol(Side.SERVER, max_size=None)
    begun = parsed = 0
    for chunk in chunks(stream, cuts):
        begun += walk.begun(chunk, 10**9)
        parser.receive_data(chunk)
        parsed += len(parser.events_received())
        assert begun == parsed + walk.within_frame
    assert parser.parser_exc is None
    assert begun == len(sent)


@given(st.binary(max_size=200), st.lists(st.integers(0, 200), max_size=10))
def test_no_bytes_whatever_disturb_the_walk(stream: bytes, cuts: list[int]) -> None:
    in_one, in_pieces = FrameWalk(), FrameWalk()
    count = sum(in_pieces.begun(chunk, 10**9) for chunk in chunks(stream, cuts))
    assert count == in_one.begun(stream, 10**9)
    assert in_pieces.within_frame == in_one.within_frame


def test_a_walk_goes_no_further_than_the_credit() -> None:
    assert FrameWalk().begun(EMPTY_PING * 40_000, 7) == 8


@pytest.mark.parametrize(
    "frame",
    [EMPTY_PING, b"\x8a\x80" + bytes(4), b"\x00\x80" + bytes(4), b"\x82\x81" + bytes(5)],
    ids=["pings", "pongs", "empty fragments", "messages"],
)
def test_frames_of_every_kind_are_charged_and_the_rate_is_granted(frame: bytes) -> None:
    rate = 10.0
    meter = Meter(rate, now=0.0)
    assert meter.charge(REQUEST, 0.0) is None
    burst = 2 * int(rate + CONTROL_RATE) - 1  # the request was charged as well
    assert meter.charge(frame * burst, 0.0) is None
    for second in range(1, 20):
        assert meter.charge(frame * int(rate + CONTROL_RATE), float(second)) is None
    assert meter.charge(frame, 19.0) == "frames"


def test_a_chunk_that_begins_no_frame_is_charged_as_one() -> None:
    meter = Meter(10.0, now=0.0)
    assert meter.charge(REQUEST, 0.0) is None
    stream = struct.pack(">BBH", 0x82, 0x80 | 126, 2000) + bytes(2004)
    taken = 0
    while meter.charge(stream[taken : taken + 1], 0.0) is None:
        taken += 1
    assert taken == 2 * (10 + CONTROL_RATE) - 1


def test_bytes_are_charged_too() -> None:
    meter = Meter(1.0, now=0.0)
    assert meter.charge(REQUEST, 0.0) is None
    large = struct.pack(">BBH", 0x82, 0x80 | 126, MAX_FRAME_BYTES) + bytes(4 + MAX_FRAME_BYTES)
    assert meter.charge(large, 0.0) is None
    assert [meter.charge(large, 0.0) for _ in range(2)] == [None, "bytes"]


@pytest.mark.parametrize("size", [1, 3, 1000])
def test_a_request_ends_where_its_empty_line_is_however_it_comes(size: int) -> None:
    stream = REQUEST + EMPTY_PING * 3
    meter = Meter(1000.0, now=0.0)
    for begin in range(0, len(REQUEST), size):
        assert meter.charge(stream[begin : min(begin + size, len(REQUEST))], 0.0) is None
        assert not meter.began
    assert meter.charge(stream[len(REQUEST) :], 0.0) is None
    assert meter.began
    assert not meter.within_frame


def test_frames_behind_a_request_in_its_chunk_are_charged() -> None:
    meter = Meter(10.0, now=0.0)
    assert meter.charge(REQUEST + EMPTY_PING * 100, 0.0) == "frames"


def test_a_request_is_bounded() -> None:
    line = b"X-Filling: " + b"x" * 1000 + b"\r\n"
    meter = Meter(1000.0, now=0.0)
    taken = 0
    while (excess := meter.charge(line, 0.0)) is None:
        taken += len(line)
    assert excess == "request"
    assert MAX_HEAD_BYTES - len(line) < taken <= MAX_HEAD_BYTES
    assert Meter(1000.0, now=0.0).charge(line * 20 + b"\r\n\r\n", 0.0) == "request"


def test_frames_that_are_paid_for_in_advance_are_charged_and_given_back() -> None:
    meter = Meter(message_rate=5.0, now=0.0)
    assert meter.charge(REQUEST, 0.0) is None
    # The request has cost as much as a frame.
    assert meter.prepay(19, 100, 0.0)
    assert not meter.prepay(1, 100, 0.0)
    meter.pay_back(19, 100, 0.0)
    assert not meter.prepay(1, 10**9, 0.0)
    assert meter.charge(19 * EMPTY_PING, 0.0) is None
    assert meter.charge(EMPTY_PING, 0.0) == "frames"
