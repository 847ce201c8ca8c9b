"""Messages to frames and back.

A frame is one msgpack array: `[code, fields]`, fields being a map, for every message but two. A
snapshot is flat, `[67, tick, ack, block]`, always with the same 15-byte head, and so are steps,
`[76, tick, block]` with a head of 10 bytes, so that the server can lay out thousands a second
without an encoder.
"""

import struct
from typing import Any, Final, NamedTuple

import msgpack
from pydantic import ValidationError

from esplanade.protocol.codes import (
    MAX_CLIENT_FRAME_BYTES,
    ClientCode,
    CloseCode,
    ErrorCode,
    ServerCode,
)
from esplanade.protocol.errors import ProtocolError
from esplanade.protocol.messages import (
    Away,
    Bye,
    Census,
    Chat,
    ChatLine,
    ChooseLook,
    ClientMessage,
    Doors,
    Enter,
    Error,
    FromClient,
    FromServer,
    GestureMade,
    Hello,
    Hide,
    Leave,
    MakeGesture,
    Move,
    MutePerson,
    Notice,
    Ping,
    Plan,
    Point,
    Pong,
    Presence,
    Report,
    Reshape,
    ServerMessage,
    SetDoor,
    Snapshot,
    StepBlock,
    Travel,
    WalkTo,
    Watch,
    Welcome,
)

CLIENT_MESSAGES: Final[dict[int, type[FromClient]]] = {
    int(model.code): model
    for model in (
        *(Hello, Move, WalkTo, ChatLine, Ping, Watch, SetDoor, Report, MutePerson),
        *(Presence, MakeGesture, ChooseLook),
    )
}
SERVER_MESSAGES: Final[dict[int, type[FromServer]]] = {
    int(model.code): model
    for model in (
        *(Welcome, Enter, Leave, Chat, Notice, Error, Bye),
        *(Pong, Plan, Census, Doors, Point, Reshape, Hide, Travel, Away, GestureMade),
    )
}

_FLAT: Final = frozenset({int(ServerCode.SNAPSHOT), int(ServerCode.STEPS)})
_SNAPSHOT_HEAD = struct.Struct(">BBBIBIBH")
_STEPS_HEAD = struct.Struct(">BBBIBH")
SNAPSHOT_HEAD_BYTES: Final = _SNAPSHOT_HEAD.size
STEPS_HEAD_BYTES: Final = _STEPS_HEAD.size
MAX_BLOCK_BYTES: Final = 0xFFFF

_MAX_QUOTED_CHARS: Final = 60
"""The text of a fault repeats at most this many characters of a frame."""


class SnapshotHead(NamedTuple):
    """The part of a snapshot before its block."""

    tick: int
    ack: int


def encode(message: FromClient | FromServer) -> bytes:
    """One frame, of any message."""
    if isinstance(message, Snapshot):
        return encode_snapshot(message.tick, message.ack, message.block)
    if isinstance(message, StepBlock):
        return encode_steps(message.tick, message.block)
    packed: bytes = msgpack.packb([int(message.code), message.model_dump(mode="json")])
    return packed


def encode_snapshot(tick: int, ack: int, block: bytes | memoryview) -> bytes:
    """Encode a snapshot as a frame.

    Raises
    ------
    ValueError
        The block is longer than 65 535 bytes (4681 records).
    """
    _check_length(block)
    head = _SNAPSHOT_HEAD.pack(
        0x94, ServerCode.SNAPSHOT, 0xCE, tick & 0xFFFF_FFFF, 0xCE, ack, 0xC5, len(block)
    )
    return head + block


def encode_steps(tick: int, block: bytes | memoryview) -> bytes:
    """Encode steps as a frame.

    Raises
    ------
    ValueError
        The block is longer than 65 535 bytes (287 steps).
    """
    _check_length(block)
    head = _STEPS_HEAD.pack(0x93, ServerCode.STEPS, 0xCE, tick & 0xFFFF_FFFF, 0xC5, len(block))
    return head + block


def peek_snapshot(frame: bytes) -> SnapshotHead | None:
    """Head of a snapshot, read without decoding the frame; None for every other message."""
    if len(frame) < SNAPSHOT_HEAD_BYTES or frame[1] != ServerCode.SNAPSHOT or frame[0] != 0x94:
        return None
    _, _, _, tick, _, ack, _, _ = _SNAPSHOT_HEAD.unpack_from(frame)
    return SnapshotHead(tick, ack)


def peek_version(frame: bytes | str) -> int | None:
    """The version that a hello asks for, whatever its other fields are; None for other frames."""
    if isinstance(frame, str) or len(frame) > MAX_CLIENT_FRAME_BYTES:
        return None
    try:
        parts = _unpack(frame)
    except ProtocolError:
        return None
    if len(parts) != 2 or parts[0] != ClientCode.HELLO or not isinstance(parts[1], dict):
        return None
    version = parts[1].get("version")
    return version if type(version) is int else None


def decode_client(frame: bytes) -> ClientMessage:
    """Decode a message of a client.

    Raises
    ------
    ProtocolError
        Too large, no msgpack, not `[code, map]`, unknown code, or fields that break their model.
    """
    if len(frame) > MAX_CLIENT_FRAME_BYTES:
        raise ProtocolError(
            ErrorCode.TOO_LARGE,
            f"a frame may hold {MAX_CLIENT_FRAME_BYTES} bytes, this one has {len(frame)}",
            CloseCode.TOO_LARGE,
        )
    parts = _unpack(frame)
    if len(parts) != 2 or not isinstance(parts[1], dict):
        raise _malformed("a frame is the array [code, map of fields]")
    code, fields = parts
    if type(code) is not int:
        raise _malformed("a message code is an integer")
    model = CLIENT_MESSAGES.get(code)
    if model is None:
        known = ", ".join(f"{c.value} {c.name.lower()}" for c in ClientCode)
        text = f"unknown message code {code}; known: {known}"
        raise ProtocolError(ErrorCode.INVALID, text, CloseCode.INVALID)
    try:
        return model.model_validate(fields)  # type: ignore[return-value]
    except ValidationError as error:
        raise ProtocolError(
            ErrorCode.INVALID,
            f"{model.code.name.lower()}: {_first_fault(error)}",
            CloseCode.INVALID,
        ) from None


def decode_server(frame: bytes) -> ServerMessage | None:
    """Decode a message of the server; None for a code that is not known, to be passed over.

    Raises
    ------
    ProtocolError
        No msgpack, not an array that begins with a code, or fields that break their model.
    """
    code, *rest = _unpack(frame)
    if type(code) is not int:
        raise _malformed("a message code is an integer")
    try:
        if code == ServerCode.SNAPSHOT and len(rest) == 3:
            return Snapshot(tick=rest[0], ack=rest[1], block=rest[2])
        if code == ServerCode.STEPS and len(rest) == 2:
            return StepBlock(tick=rest[0], block=rest[1])
        model = SERVER_MESSAGES.get(code)
        if model is None and code not in _FLAT:
            return None
        if model is None or len(rest) != 1 or not isinstance(rest[0], dict):
            raise _malformed(f"no server message: code {code} with {len(rest)} parts")
        return model.model_validate(rest[0])  # type: ignore[return-value]
    except ValidationError as error:
        raise _malformed(_first_fault(error)) from None


def _unpack(frame: bytes) -> list[Any]:
    try:
        parts = msgpack.unpackb(frame, strict_map_key=True)
    except (ValueError, TypeError, OverflowError) as error:  # among them msgpack's own, all bounded
        raise _malformed(f"not msgpack: {_why_not(error)}") from None
    if not isinstance(parts, list) or not parts:
        raise _malformed("a frame is a msgpack array that begins with a message code")
    return parts


def _why_not(error: Exception) -> str:
    """The words for why bytes are no msgpack."""
    kinds = (
        (msgpack.ExtraData, "more bytes follow where it ends"),
        (msgpack.StackError, "arrays and maps are nested too deep"),
        (msgpack.FormatError, "a byte begins nothing that there is"),
        (UnicodeDecodeError, "a text is not UTF-8"),
    )
    for kind, words in kinds:
        if isinstance(error, kind):
            return words
    return "it ends too early" if "incomplete" in str(error) else "it cannot be read"


def _check_length(block: bytes | memoryview) -> None:
    if len(block) > MAX_BLOCK_BYTES:
        raise ValueError(f"a block holds at most {MAX_BLOCK_BYTES} bytes, not {len(block)}")


def _malformed(text: str) -> ProtocolError:
    return ProtocolError(ErrorCode.MALFORMED, text, CloseCode.MALFORMED)


def _first_fault(error: ValidationError) -> str:
    fault = error.errors(include_url=False, include_input=False)[0]
    where = ".".join(str(part) for part in fault["loc"]) or "message"
    return f"{where[:_MAX_QUOTED_CHARS]}: {fault['msg']}"
