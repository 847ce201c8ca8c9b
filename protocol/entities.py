"""The avatars of an enter message, packed in two parts: what never changes of them, and the rest.

An avatar comes into the view of many. Its constants are packed once in its life, and its place
once in each tick in which it comes into somebody's view.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import msgpack

from esplanade.protocol.codes import Kind
from esplanade.protocol.looks import NO_LOOK, Look, parts_of

Place = tuple[float, float, float]

_FIELDS: Final = 12
"""Of an avatar without a look; the look is one more."""
_FLOAT: Final = b"\xcb"


def _keyed(*names: str) -> list[bytes]:
    """Names of fields with the mark of a 64-bit float behind them."""
    return [msgpack.packb(name) + _FLOAT for name in names]


_LAYER: Final = msgpack.packb("layer")
_X, _Y, _Z, _HEADING = _keyed("x", "y", "z", "heading")
_POINTS_AT: Final = msgpack.packb("points_at")
_NIL: Final = msgpack.packb(None)
_MOVING = struct.Struct(f">{len(_X)}sd{len(_Y)}sd{len(_Z)}sd{len(_HEADING)}sd")


@dataclass(frozen=True)
class Entity:
    """The constant fields of an avatar, as in `esplanade.protocol.messages.Entity`."""

    id: int
    kind: Kind
    name: str
    radius: float
    leg_m: float
    stature_m: float
    look: Look = NO_LOOK


def pack_constants(entity: Entity) -> tuple[bytes, bytes]:
    """The bytes before and after the place of an avatar."""
    packer = msgpack.Packer(autoreset=False)
    packer.pack_map_header(_FIELDS + (entity.look != NO_LOOK))
    for name, value in (("id", entity.id), ("kind", entity.kind.value), ("name", entity.name)):
        packer.pack(name)
        packer.pack(value)
    head: bytes = packer.bytes()
    packer.reset()
    for name in ("radius", "leg_m", "stature_m"):
        packer.pack(name)
        packer.pack(getattr(entity, name))
    if entity.look != NO_LOOK:
        packer.pack("look")
        packer.pack(parts_of(entity.look))
    return head, packer.bytes()


def pack_entity(
    constants: tuple[bytes, bytes],
    layer: int,
    position_m: Sequence[float],
    heading_rad: float,
    points_at: Place | None,
) -> bytes:
    """A whole avatar of an enter message, around its packed constants."""
    x, y, z = position_m
    moving = _MOVING.pack(_X, x, _Y, y, _Z, z, _HEADING, heading_rad)
    packed_layer = bytes((layer,)) if layer < 0x80 else bytes((0xCC, layer))
    target: bytes = _NIL if points_at is None else msgpack.packb(points_at)
    return b"".join((constants[0], _LAYER, packed_layer, moving, constants[1], _POINTS_AT, target))
