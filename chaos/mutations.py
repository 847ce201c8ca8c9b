"""Frames of clients changed at random, each one reproducible by its seed and number."""

import random
import struct
from collections.abc import Callable
from typing import Any, Final

import msgpack

from chaos.wire import frame
from esplanade.protocol import VERSION, encode
from esplanade.protocol.messages import ChatLine, Hello, Move, Ping, SetDoor, WalkTo, Watch

_MESSAGES: Final = (
    Hello(name="Mutant", version=VERSION, resume="x" * 32, at=(20.0, 1.5, 0.0)),
    Move(seq=1, direction=0.5, speed=1.3),
    WalkTo(seq=2, x=20.0, y=8.0),
    ChatLine(text="Good day"),
    Ping(nonce=7),
    Watch(id=3),
    SetDoor(name="Archive door", open=True),
)
_FRAMES: Final = tuple(encode(message) for message in _MESSAGES)
_FIELDS: Final[tuple[tuple[int, dict[str, Any]], ...]] = tuple(
    (int(message.code), message.model_dump(mode="json")) for message in _MESSAGES
)
_VALUES: Final[tuple[Any, ...]] = (
    *(None, True, False, 0, -1, 1, 2**31, 2**32, 2**63, 2**64 - 1, -(2**63)),
    *(0.0, -0.0, 1e308, -1e308, 5e-324, float("nan"), float("inf"), float("-inf")),
    *("", "x" * 400, "\0", "\u202e", "\ud7ff", "\U0010ffff", b"", b"\xff\xfe", bytes(300)),
    *([], [[]], [0.0, 0.0], [0.0, 0.0, 0.0, 0.0], {}, {"": {}}, {"name": {"name": {}}}),
    msgpack.Timestamp(0, 1),
    msgpack.ExtType(5, b"\0" * 8),
)
_NESTED: Final = b"\x91" * 1500

Mutation = Callable[[random.Random], bytes]


class Mutations:
    """An endless row of frames; the same seed and number are the same frame."""

    def __init__(self, seed: int) -> None:
        self._seed = seed << 40

    def payload(self, number: int) -> bytes:
        """Return the content of a message, changed, for the decoder."""
        chance = random.Random(self._seed + number)
        return _MUTATIONS[number % len(_MUTATIONS)](chance)

    def framed(self, number: int) -> bytes:
        """A whole frame of WebSocket; of every fourth the head is changed too."""
        payload = self.payload(number)
        whole = frame(payload)
        if number % 4:
            return whole
        chance = random.Random(~(self._seed + number))
        return _HEADS[number // 4 % len(_HEADS)](chance, whole, payload)


# --- payloads ---------------------------------------------------------------------------------


def _flipped(chance: random.Random) -> bytes:
    changed = bytearray(chance.choice(_FRAMES))
    for _ in range(chance.randint(1, 4)):
        changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _cut(chance: random.Random) -> bytes:
    whole = chance.choice(_FRAMES)
    return whole[: chance.randrange(len(whole))]


def _inserted(chance: random.Random) -> bytes:
    whole = chance.choice(_FRAMES)
    at = chance.randrange(len(whole) + 1)
    return whole[:at] + chance.randbytes(chance.randint(1, 16)) + whole[at:]


def _spliced(chance: random.Random) -> bytes:
    one, other = chance.choice(_FRAMES), chance.choice(_FRAMES)
    return one[: chance.randrange(len(one))] + other[chance.randrange(len(other)) :]


def _random_bytes(chance: random.Random) -> bytes:
    return chance.randbytes(chance.randint(0, 64))


def _other_value(chance: random.Random) -> bytes:
    code, fields = chance.choice(_FIELDS)
    changed = {**fields, chance.choice(list(fields)): chance.choice(_VALUES)}
    return _packed([code, changed])


def _other_fields(chance: random.Random) -> bytes:
    code, _ = chance.choice(_FIELDS)
    _, fields = chance.choice(_FIELDS)
    return _packed([code, {**fields, chance.choice(("seq", "x", "", "nonce")): 1}])


def _other_shape(chance: random.Random) -> bytes:
    code, fields = chance.choice(_FIELDS)
    value = chance.choice(_VALUES)
    shapes: tuple[Any, ...] = (
        *([], [code], [code, value], [value, fields], [code, fields, value], value),
        *({"code": code}, [[code, fields]], [float(code), fields], [str(code), fields]),
        [chance.randrange(-200, 70_000), fields],
    )
    return _packed(chance.choice(shapes))


def _long_lengths(chance: random.Random) -> bytes:
    """A value that says it is longer than all there is, or that is nested without end."""
    kind = chance.choice((0xC6, 0xDB, 0xDD, 0xDF, 0xC9))
    claimed = struct.pack(">BI", kind, chance.getrandbits(32))
    return chance.choice(
        (claimed, b"\x92\x01" + claimed, b"\x92\x04\x81\xa4text" + claimed, _NESTED)
    )


def _packed(value: Any) -> bytes:
    packed: bytes = msgpack.packb(value)
    return packed


_MUTATIONS: Final[tuple[Mutation, ...]] = (
    *(_flipped, _cut, _inserted, _spliced, _random_bytes),
    *(_other_value, _other_fields, _other_shape, _long_lengths),
)

# --- heads of frames --------------------------------------------------------------------------


def _flipped_head(chance: random.Random, whole: bytes, _: bytes) -> bytes:
    return bytes([whole[0] ^ (1 << chance.randrange(8))]) + whole[1:]


def _any_head(chance: random.Random, _: bytes, payload: bytes) -> bytes:
    return frame(payload, chance.randrange(256))


def _wrong_length(chance: random.Random, whole: bytes, _: bytes) -> bytes:
    return whole[:1] + bytes([chance.randrange(256)]) + whole[2:]


def _not_masked(_: random.Random, __: bytes, payload: bytes) -> bytes:
    return bytes([0x82, len(payload) & 0x7F]) + payload


def _huge_length(chance: random.Random, _: bytes, payload: bytes) -> bytes:
    return struct.pack(">BBQ", 0x82, 0xFF, chance.getrandbits(64)) + payload


_HEADS: Final[tuple[Callable[[random.Random, bytes, bytes], bytes], ...]] = (
    *(_flipped_head, _any_head, _wrong_length, _not_masked, _huge_length),
)
