"""Messages to frames and back; whatever comes in, only a `ProtocolError` comes out."""

import struct
from contextlib import suppress
from typing import Any

import msgpack
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol import (
    CloseCode,
    ErrorCode,
    ProtocolError,
    ServerCode,
    decode_client,
    decode_server,
    encode,
    encode_snapshot,
    encode_steps,
    peek_snapshot,
    peek_version,
)
from esplanade.protocol.codec import (
    CLIENT_MESSAGES,
    MAX_BLOCK_BYTES,
    SERVER_MESSAGES,
    SNAPSHOT_HEAD_BYTES,
    STEPS_HEAD_BYTES,
)
from esplanade.protocol.codes import MAX_CLIENT_FRAME_BYTES, ClientCode
from esplanade.protocol.messages import (
    Bye,
    Enter,
    Entity,
    Error,
    FromClient,
    FromServer,
    Hello,
    Snapshot,
    StepBlock,
)
from tests.protocol.messages import client_messages, server_messages


@given(client_messages)
def test_a_client_message_comes_back_as_it_was(message: FromClient) -> None:
    assert decode_client(encode(message)) == message


@given(server_messages)
def test_a_server_message_comes_back_as_it_was(message: FromServer) -> None:
    assert decode_server(encode(message)) == message


def test_every_code_has_a_model() -> None:
    assert {int(code) for code in ClientCode} == set(CLIENT_MESSAGES)
    flat = {int(ServerCode.SNAPSHOT), int(ServerCode.STEPS)}
    assert {int(code) for code in ServerCode} == set(SERVER_MESSAGES) | flat


# --- later versions -----------------------------------------------------------------------------


@pytest.mark.parametrize("rest", [[], [{"field": 1}], [1, 2, b"block"]])
def test_a_message_of_the_server_with_an_unknown_code_is_passed_over(rest: list[Any]) -> None:
    assert decode_server(msgpack.packb([99, *rest])) is None


@given(server_messages.filter(lambda message: not isinstance(message, (Snapshot, StepBlock))))
def test_unknown_fields_of_the_server_are_passed_over(message: FromServer) -> None:
    code, fields = msgpack.unpackb(encode(message))
    assert decode_server(msgpack.packb([code, {**fields, "later": [1, {"a": None}]}])) == message


def test_unknown_fields_of_a_part_are_passed_over() -> None:
    entity = {"id": 1, "kind": "actor", "name": "Oak", "layer": 0, "x": 0, "y": 0, "z": 0}
    sizes = {"heading": 0, "radius": 0.25, "leg_m": 0.9, "stature_m": 1.7, "points_at": None}
    frame = msgpack.packb([65, {"tick": 1, "entities": [{**entity, **sizes, "hat": "red"}]}])
    assert decode_server(frame) == Enter(tick=1, entities=[Entity(**entity, **sizes)])


def test_unknown_names_and_numbers_of_the_server_are_taken_as_they_are() -> None:
    error = decode_server(msgpack.packb([70, {"error": "too_windy", "text": "hold on"}]))
    assert isinstance(error, Error)
    assert error.error == "too_windy"
    bye = decode_server(msgpack.packb([71, {"reason": "moved", "text": "elsewhere"}]))
    assert isinstance(bye, Bye)
    assert bye.reason == "moved"
    known = decode_server(msgpack.packb([70, {"error": "no_path", "text": "none"}]))
    assert isinstance(known, Error)
    assert known.error is ErrorCode.NO_PATH


@pytest.mark.parametrize(
    ("frame", "version"),
    [
        (encode(Hello(name="Ann", version=7)), 7),
        (msgpack.packb([1, {"version": 9, "later": None}]), 9),
        (msgpack.packb([1, {"version": "9"}]), None),
        (msgpack.packb([1, {"version": True}]), None),
        (msgpack.packb([1, {}]), None),
        (msgpack.packb([1, 9]), None),
        (msgpack.packb([2, {"version": 9}]), None),
        (b"\xc1", None),
        (msgpack.packb([1, {"version": 9, "long": "x" * MAX_CLIENT_FRAME_BYTES}]), None),
        ("text", None),
    ],
)
def test_the_version_of_a_hello_is_found_whatever_else_it_holds(
    frame: bytes | str, version: int | None
) -> None:
    assert peek_version(frame) == version


# --- hostile frames -----------------------------------------------------------------------------


def decode_or_refuse(frame: bytes) -> None:
    """Decode both ways; a text that goes back to a client stays short."""
    for decode in (decode_client, decode_server):
        try:
            decode(frame)
        except ProtocolError as error:
            assert len(error.text) < 500  # noqa: PT017 (any outcome but another error is right)


@given(st.binary(max_size=MAX_CLIENT_FRAME_BYTES + 1))
def test_random_bytes(frame: bytes) -> None:
    decode_or_refuse(frame)


scalars = (
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.floats()
    | st.text(st.characters(codec="utf-8"), max_size=40)
    | st.binary(max_size=40)
    | st.builds(msgpack.ExtType, st.integers(0, 127), st.binary(max_size=12))
)
keys = st.sampled_from(["name", "version", "seq", "x", "at", "direction"]) | st.binary(max_size=4)
trees: st.SearchStrategy[Any] = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(keys, inner, max_size=5),
    max_leaves=12,
)
codes = st.sampled_from([*CLIENT_MESSAGES, *map(int, ServerCode)])


@given(trees)
def test_random_msgpack(tree: Any) -> None:
    decode_or_refuse(msgpack.packb(tree))


@given(codes, st.lists(trees, max_size=4))
def test_a_known_code_with_random_fields(code: int, rest: list[Any]) -> None:
    decode_or_refuse(msgpack.packb([code, *rest]))


@given(client_messages | server_messages, st.data())
def test_a_good_frame_with_a_changed_byte(message: FromClient, data: st.DataObject) -> None:
    frame = bytearray(encode(message))
    place = data.draw(st.integers(0, len(frame) - 1))
    frame[place] = data.draw(st.integers(0, 255))
    decode_or_refuse(bytes(frame))
    decode_or_refuse(bytes(frame[:place]))


@pytest.mark.parametrize(
    "frame",
    [
        b"\x91" * 600 + b"\x01",  # nested 600 deep, its code a list
        b"\x92\x02" + b"\x91" * 1000 + b"\x01",  # the fields nested
        b"\x92\x02\x81\xa3seq" + b"\x91" * 1000 + b"\x01",  # one field nested
        b"\x91" * 2000,  # deeper than the reader goes
        b"\xdd\xff\xff\xff\xff",  # an array of four thousand million
        b"\xdf\xff\xff\xff\xff",  # a map of as many
        b"\xc6\xff\xff\xff\xff",  # a binary of 4 GiB
        b"\xdb\xff\xff\xff\xff",  # a text of 4 GiB
        b"\xc9\xff\xff\xff\xff\x01",  # an extension of 4 GiB
        b"\x92\x01\xdf\xff\xff\xff\xff",
        b"\xc7\x0c\xff" + b"\xff" * 12,  # a time that is none
        b"\x92\x01\x81\xc0\x01",  # a key that is no text
        b"",
    ],
)
def test_bombs(frame: bytes) -> None:
    with pytest.raises(ProtocolError) as caught:
        decode_client(frame)
    assert caught.value.close in {CloseCode.MALFORMED, CloseCode.INVALID}
    with suppress(ProtocolError):
        assert decode_server(frame) is None, "none of these codes is the server's"


@pytest.mark.parametrize(
    ("frame", "code", "close", "text"),
    [
        (b"\xc1", ErrorCode.MALFORMED, CloseCode.MALFORMED, "not msgpack: a byte begins nothing"),
        (b"\x92\x05", ErrorCode.MALFORMED, CloseCode.MALFORMED, "not msgpack: it ends too early"),
        (b"\x90\x90", ErrorCode.MALFORMED, CloseCode.MALFORMED, "more bytes follow"),
        (b"\x91" * 2000, ErrorCode.MALFORMED, CloseCode.MALFORMED, "nested too deep"),
        (b"\x91\xa1\xff", ErrorCode.MALFORMED, CloseCode.MALFORMED, "a text is not UTF-8"),
        (b"\x01", ErrorCode.MALFORMED, CloseCode.MALFORMED, "begins with a message code"),
        (b"\x90", ErrorCode.MALFORMED, CloseCode.MALFORMED, "begins with a message code"),
        (b"\x91\x05", ErrorCode.MALFORMED, CloseCode.MALFORMED, "[code, map of fields]"),
        (b"\x92\x05\x01", ErrorCode.MALFORMED, CloseCode.MALFORMED, "[code, map of fields]"),
        (b"\x92\xc3\x80", ErrorCode.MALFORMED, CloseCode.MALFORMED, "code is an integer"),
        (b"\x92\x63\x80", ErrorCode.INVALID, CloseCode.INVALID, "unknown message code 99; known"),
        (b"\x92\x05\x80", ErrorCode.INVALID, CloseCode.INVALID, "ping: nonce: Field required"),
    ],
)
def test_faults_are_named(frame: bytes, code: ErrorCode, close: CloseCode, text: str) -> None:
    with pytest.raises(ProtocolError) as caught:
        decode_client(frame)
    assert (caught.value.code, caught.value.close) == (code, close)
    assert text in caught.value.text


def test_an_oversize_frame_is_refused_before_it_is_read() -> None:
    with pytest.raises(ProtocolError, match="may hold 2048 bytes, this one has 2049") as caught:
        decode_client(b"\xc1" * (MAX_CLIENT_FRAME_BYTES + 1))
    assert (caught.value.code, caught.value.close) == (ErrorCode.TOO_LARGE, CloseCode.TOO_LARGE)


def test_the_longest_messages_fit_a_frame() -> None:
    longest = Hello(name="🙂" * 32, version=1, resume="🙂" * 64, at=(-1e5 / 3, 1e5 / 3, 255))
    assert len(encode(longest)) < MAX_CLIENT_FRAME_BYTES
    frame = msgpack.packb([int(ClientCode.CHAT), {"text": "🙂" * 300}])
    assert decode_client(frame) is not None


# --- flat messages ------------------------------------------------------------------------------


@given(st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1), st.binary(max_size=400))
def test_a_snapshot_is_plain_msgpack_with_a_fixed_head(tick: int, ack: int, block: bytes) -> None:
    frame = encode_snapshot(tick, ack, block)
    assert len(frame) == SNAPSHOT_HEAD_BYTES + len(block)
    assert msgpack.unpackb(frame) == [67, tick, ack, block]
    assert peek_snapshot(frame) == (tick, ack)
    assert struct.unpack_from(">H", frame, 13) == (len(block),)


@given(st.integers(0, 2**32 - 1), st.binary(max_size=500))
def test_steps_are_plain_msgpack_with_a_fixed_head(tick: int, block: bytes) -> None:
    frame = encode_steps(tick, block)
    assert len(frame) == STEPS_HEAD_BYTES + len(block)
    assert msgpack.unpackb(frame) == [76, tick, block]
    assert struct.unpack_from(">H", frame, 8) == (len(block),)


@given(server_messages.filter(lambda message: not isinstance(message, Snapshot)))
def test_other_messages_have_no_snapshot_head(message: FromServer) -> None:
    assert peek_snapshot(encode(message)) is None


def test_short_frames_have_no_snapshot_head() -> None:
    assert peek_snapshot(encode_snapshot(1, 2, b"")[:-1]) is None
    assert peek_snapshot(b"") is None


def test_a_block_has_a_limit() -> None:
    assert len(encode_snapshot(1, 1, bytes(MAX_BLOCK_BYTES))) == MAX_BLOCK_BYTES + 15
    with pytest.raises(ValueError, match="at most 65535 bytes"):
        encode_snapshot(1, 1, bytes(MAX_BLOCK_BYTES + 1))
    assert len(encode_steps(1, bytes(MAX_BLOCK_BYTES))) == MAX_BLOCK_BYTES + 10
    with pytest.raises(ValueError, match="at most 65535 bytes"):
        encode_steps(1, bytes(MAX_BLOCK_BYTES + 1))
