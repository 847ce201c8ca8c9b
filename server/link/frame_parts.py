"""Frames as they go over a network: cut into parts that a broker carries, and put together again.

Every part says whose frame it is of, so that a gateway may judge it before it decodes anything.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

MAGIC: Final = b"EF"
VERSION: Final = 1
PART_BYTES: Final = 256 * 1024
"""No part holds more of a frame."""
MOST_PARTS: Final = 64

_HEAD: Final = struct.Struct("<2sBBQIHH")
_WHOLE: Final = 1


class FrameError(ValueError):
    """The bytes are no frame of this version; the message says what is wrong."""


@dataclass(frozen=True)
class FrameKey:
    """The identity of a frame, by which gateways judge it."""

    epoch: int
    """The ownership in which it was made."""
    tick: int
    is_whole: bool = False
    """Whether it says everything of the zone, and not what changed since the frame before it."""


def parts_of(key: FrameKey, body: bytes) -> Iterator[bytes]:
    """The messages that carry a frame.

    Raises
    ------
    FrameError
        The frame is too large.
    """
    count = max(1, -(-len(body) // PART_BYTES))
    if count > MOST_PARTS:
        raise FrameError(f"a frame of {len(body)} bytes has more than {MOST_PARTS} parts")
    flags = _WHOLE if key.is_whole else 0
    for part in range(count):
        head = _HEAD.pack(MAGIC, VERSION, flags, key.epoch, key.tick, part, count)
        yield head + body[part * PART_BYTES : (part + 1) * PART_BYTES]


class Assembly:
    """Puts the parts of one zone's frames together; of whole states and of changes apart.

    Parts of a frame come one after the other. Whatever breaks that order makes the frame be
    missing, and a gap in the ticks tells of it. One frame is under way at most, so that memory is
    bounded by its size.
    """

    def __init__(self) -> None:
        self._key: FrameKey | None = None
        self._count = 0
        self._parts: list[bytes] = []

    def take(self, message: bytes) -> tuple[FrameKey, bytes] | None:
        """Take in a part; returns the frame's identity and body once it is complete.

        Raises
        ------
        FrameError
            The message is no part of a frame; what was under way remains.
        """
        key, part, count, content = _read(message)
        if part == 0:
            self._key, self._count, self._parts = key, count, []
        elif (key, count, part) != (self._key, self._count, len(self._parts)):
            self._key = None
            return None
        self._parts.append(content)
        if len(self._parts) < count:
            return None
        body, self._key, self._parts = b"".join(self._parts), None, []
        return key, body


def _read(message: bytes) -> tuple[FrameKey, int, int, bytes]:
    if len(message) < _HEAD.size:
        raise FrameError(f"a part of a frame has at least {_HEAD.size} bytes, not {len(message)}")
    magic, version, flags, epoch, tick, part, count = _HEAD.unpack_from(message)
    if magic != MAGIC:
        raise FrameError("the bytes are no part of a frame")
    if version != VERSION:
        raise FrameError(f"the frame has version {version}, and this program reads {VERSION}")
    content = message[_HEAD.size :]
    if not part < count <= MOST_PARTS or len(content) > PART_BYTES:
        raise FrameError(f"part {part} of {count} with {len(content)} bytes cannot be")
    return FrameKey(epoch, tick, bool(flags & _WHOLE)), part, count, content
