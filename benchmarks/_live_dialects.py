"""A walker speaks the dialect of each compared server, and counts the snapshots that come."""

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.protocol import VERSION, ServerCode, encode
from esplanade.protocol.messages import Hello, Move

_BINARY: Final = 0x82
_MASKED: Final = 0x80
_PONG: Final = 0x8A
_NO_MASK: Final = bytes(4)
"""This mask changes nothing; the server has the same work with it as with any other."""

_JOIN_ROOM, _ROOM_DATA, _ROOM_STATE_PATCH = 10, 13, 15
_MOVE: Final = 1


@dataclass(frozen=True)
class Dialect:
    """A server's messages as far as a walker must know them; codes are single bytes."""

    code_at: int
    """The place of the code in a message."""
    snapshot: int | None
    """The code of a snapshot; None where every message is one."""
    welcome: int | None
    """The code of the message that lets the client in; None where the handshake does that."""
    hello: Callable[[int, float], bytes]
    """The frames after the handshake, of this walker on a field of this side in metres."""
    move: Callable[[int, float, float], bytes]
    """The frame of a movement: its number, direction in radians, speed in m/s."""
    thanks: bytes = b""
    """The frame that answers the welcome."""


def handshake(path: str) -> bytes:
    """The request for a WebSocket at this path."""
    return (
        f"GET {path} HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
        "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
    ).encode()


def frame(payload: bytes) -> bytes:
    """A client's frame of a short message."""
    return struct.pack(">BB", _BINARY, _MASKED | len(payload)) + _NO_MASK + payload


def pong(payload: bytes) -> bytes:
    """The answer to a ping."""
    return struct.pack(">BB", _PONG, _MASKED | len(payload)) + _NO_MASK + payload


def _hello(number: int, side_m: float) -> bytes:
    x, y = np.random.default_rng(number).uniform(0.0, side_m, 2).tolist()
    return frame(encode(Hello(name=f"Walker {number + 1}", version=VERSION, at=(x, y, 0.0))))


def _move(seq: int, direction: float, speed: float) -> bytes:
    return frame(encode(Move(seq=seq, direction=direction, speed=speed)))


def _nothing(_number: int, _side_m: float) -> bytes:
    return b""


def _colyseus_move(_seq: int, direction: float, speed: float) -> bytes:
    numbers = struct.pack(">BBdBd", 0x92, 0xCB, math.remainder(direction, math.tau), 0xCB, speed)
    return frame(bytes([_ROOM_DATA, _MOVE]) + numbers)


DIALECTS: Final = {
    "esplanade": Dialect(1, ServerCode.SNAPSHOT, ServerCode.WELCOME, _hello, _move),
    "bare": Dialect(0, None, None, _nothing, _move),
    "colyseus": Dialect(
        0, _ROOM_STATE_PATCH, _JOIN_ROOM, _nothing, _colyseus_move, frame(bytes([_JOIN_ROOM]))
    ),
}
