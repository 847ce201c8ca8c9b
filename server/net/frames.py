"""Server messages as WebSocket frames, header included, ready for a transport.

A frame is built once and goes to any number of clients. Messages that go out in large numbers are
packed here without their pydantic models; the tests hold both encodings together.
"""

import struct
from collections.abc import Sequence
from functools import lru_cache
from typing import Final

import msgpack

from esplanade.protocol import ServerCode, encode
from esplanade.protocol.messages import FromServer

_FINAL_BINARY: Final = 0x82
_SHORT = struct.Struct(">BB")
_MEDIUM = struct.Struct(">BBH")
_LONG = struct.Struct(">BBQ")


def frame(payload: bytes) -> bytes:
    """One unmasked binary WebSocket frame (RFC 6455, section 5.2)."""
    size = len(payload)
    if size < 126:
        return _SHORT.pack(_FINAL_BINARY, size) + payload
    if size < 65536:
        return _MEDIUM.pack(_FINAL_BINARY, 126, size) + payload
    return _LONG.pack(_FINAL_BINARY, 127, size) + payload


def message(content: FromServer) -> bytes:
    """The frame of any message but the welcome, and snapshots and steps, which `packing` packs."""
    return frame(encode(content))


def leave(tick: int, ids: Sequence[int]) -> bytes:
    packed: bytes = msgpack.packb([int(ServerCode.LEAVE), {"tick": tick, "ids": ids}])
    return frame(packed)


def enter(tick: int, entities: Sequence[bytes]) -> bytes:
    """An enter message from avatars that `esplanade.protocol.entities` has packed."""
    return frame(b"".join((_enter_head(tick), _array_head(len(entities)), *entities)))


@lru_cache(maxsize=1)
def _enter_head(tick: int) -> bytes:
    """The bytes of an enter message before the array of avatars, the same for all of a tick."""
    packer = msgpack.Packer(autoreset=False)
    packer.pack_array_header(2)
    packer.pack(int(ServerCode.ENTER))
    packer.pack_map_header(2)
    packer.pack("tick")
    packer.pack(tick)
    packer.pack("entities")
    head: bytes = packer.bytes()
    return head


@lru_cache(maxsize=256)
def _array_head(count: int) -> bytes:
    packer = msgpack.Packer(autoreset=False)
    packer.pack_array_header(count)
    head: bytes = packer.bytes()
    return head
