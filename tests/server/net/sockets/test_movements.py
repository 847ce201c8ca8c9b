"""Movements that a kernel reads are those of the protocol's own decoder."""

import struct
from typing import Any

import msgpack
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.frames import Frame, Opcode

from esplanade.protocol import ClientCode, encode
from esplanade.protocol.messages import Move, Ping
from esplanade.server.net.compiled._movement_kernels import NOT_ALL, movements
from tests.naive.movements import movements_in

FIELDS = [np.frombuffer(name.encode(), np.uint8) for name in Move.model_fields]
NUMBERS = st.one_of(
    st.floats(width=32),
    st.floats(-1001.0, 1001.0),
    st.integers(-(2**33), 2**33),
    st.sampled_from([0, -1, 0.0, -0.0, 1000, 100]),
)


def read(chunk: bytes) -> tuple[int, Move | None]:
    """The number of movements by the kernel, and the latest."""
    count, seq, direction, speed = movements(
        np.frombuffer(chunk, np.uint8), int(ClientCode.MOVE), *FIELDS
    )
    if count < 1:
        return count, None
    return count, Move(seq=seq, direction=direction, speed=speed)


def framed(payload: bytes) -> bytes:
    return Frame(Opcode.BINARY, payload).serialize(mask=True)


def check(chunk: bytes) -> int:
    """Check that the kernel reads the same as the decoder, if it reads anything."""
    count, latest = read(chunk)
    if count > 0:
        wanted = movements_in(chunk)
        assert wanted is not None
        assert (count, latest) == (len(wanted), wanted[-1])
        assert latest is not None
        signs = [np.signbit((each.direction, each.speed)).tolist() for each in (latest, wanted[-1])]
        assert signs[0] == signs[1]
    return count


@given(
    st.lists(
        st.tuples(st.integers(0, 2**32 - 1), st.floats(-1000.0, 1000.0), st.floats(0.0, 100.0)),
        min_size=1,
        max_size=5,
    ),
    st.integers(1, 60),
)
def test_good_movements_are_read_and_torn_ones_are_not(
    wishes: list[tuple[int, float, float]], cut: int
) -> None:
    sent = [Move(seq=seq, direction=turn, speed=speed) for seq, turn, speed in wishes]
    chunk = b"".join(framed(encode(each)) for each in sent)
    assert check(chunk) == len(sent)
    last = len(framed(encode(sent[-1])))
    assert read(chunk[: -min(cut, last - 1)])[0] == NOT_ALL
    assert read(chunk + framed(encode(Ping(nonce=1))))[0] == NOT_ALL


@given(
    st.permutations(["seq", "direction", "speed"]),
    st.fixed_dictionaries({"seq": NUMBERS, "direction": NUMBERS, "speed": NUMBERS}),
    st.booleans(),
)
def test_fields_in_any_order_and_numbers_of_any_kind(
    order: list[str], values: dict[str, Any], single: bool
) -> None:
    fields = {name: values[name] for name in order}
    payload = msgpack.packb([int(ClientCode.MOVE), fields], use_single_float=single)
    count = check(framed(payload))
    # The usual form of clients is never left to the parser.
    usual = movements_in(framed(payload)) is not None and all(
        abs(value) < 2**31 for value in values.values()
    )
    assert (count == 1) == usual or not usual


@given(st.data())
def test_nothing_is_read_from_damaged_movements_that_the_decoder_refuses(
    data: st.DataObject,
) -> None:
    payload = bytearray(encode(Move(seq=77_000, direction=0.5, speed=1.25)))
    for _ in range(data.draw(st.integers(1, 3))):
        payload[data.draw(st.integers(0, len(payload) - 1))] = data.draw(st.integers(0, 255))
    at = data.draw(st.integers(0, len(payload)))
    if data.draw(st.booleans()):
        del payload[at:]
    check(framed(bytes(payload)))
    frame = bytearray(framed(bytes(payload)))
    frame[data.draw(st.integers(0, len(frame) - 1))] = data.draw(st.integers(0, 255))
    check(bytes(frame))


@given(st.binary(max_size=200))
def test_any_bytes_at_all(chunk: bytes) -> None:
    check(chunk)
    check(framed(chunk))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1000.0001, -1001.0])
def test_what_the_protocol_forbids_is_left_to_the_parser(value: float) -> None:
    fields = {"seq": 1, "direction": value, "speed": 1.0}
    payload = msgpack.packb([int(ClientCode.MOVE), fields])
    assert read(framed(payload)) == (NOT_ALL, None)


def test_a_name_at_the_very_end_and_a_number_that_is_cut_are_not_read() -> None:
    whole = encode(Move(seq=300, direction=0.5, speed=1.25))
    for size in range(len(whole)):
        assert read(framed(whole[:size]))[0] == NOT_ALL
    assert read(b"")[0] == 0
    assert struct.unpack(">d", whole[-8:]) == (1.25,)
