"""The inputs of a gateway's people as bytes: one batch for each zone, twenty times a second.

A batch that is lost takes nothing with it that is not said again: the newest movement follows the
one before, and whom the gateway serves is repeated. All numbers are little-endian.
"""

import struct
from dataclasses import dataclass, field
from typing import Annotated, Any, Final

import msgpack
import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from esplanade.protocol.codes import Gesture
from esplanade.protocol.looks import KnownLook, Look
from esplanade.protocol.messages import Line, Report, WalkTo

MAGIC: Final = b"EB"
VERSION: Final = 1
MOVEMENT: Final = np.dtype(
    [
        ("person", "<u4"),
        ("generation", "<u4"),
        ("seq", "<u4"),
        ("direction_rad", "<f8"),
        ("speed_mps", "<f8"),
    ]
)
"""A person's newest wish to walk, and the occupation of the seat from which it comes."""

MOST_BYTES: Final = 1024 * 1024
"""No longer batch is read."""

MOST_MUTED: Final = 200
"""A person mutes no more others at once."""

_HEAD: Final = struct.Struct("<2sBxIQQ")

Number = Annotated[int, Field(ge=0, le=2**63 - 1)]
Held = tuple[Number, Number]
"""A person, and the generation of the seat."""
Made = Annotated[int, Field(ge=min(Gesture), le=max(Gesture))]
Muted = Annotated[list[Number], Field(max_length=MOST_MUTED)]
_Rest = tuple[
    str,  # gateway
    list[Held],
    list[tuple[Number, Number, bool]],  # departed
    list[tuple[Number, Number, WalkTo]],
    list[tuple[Number, Number, Line]],
    list[tuple[Number, Number, Number | None]],  # watched
    list[tuple[Number, Number, str, bool]],  # doors
    list[Held],  # stood
    list[tuple[Number, Number, Muted]],
]
_REST: Final = TypeAdapter(_Rest)
_PARTS: Final = 9


class _Further(BaseModel):
    """Inputs that older programs do not know: a map behind the others, where there are any.

    A program passes over those that only newer ones know.
    """

    reports: list[tuple[Number, Number, Report]] = Field(default_factory=list)
    presences: list[tuple[Number, Number, bool]] = Field(default_factory=list)
    gestures: list[tuple[Number, Number, Made]] = Field(default_factory=list)
    looks: list[tuple[Number, Number, KnownLook]] = Field(default_factory=list)


class BatchError(ValueError):
    """The bytes are no batch of this version; the message says what is wrong."""


@dataclass(frozen=True)
class Batch:
    """All that people of one gateway want of one zone since the batch before it."""

    gateway: str
    """The name of the gateway's process, which no other process has or gets."""
    number: int
    """Grows by one with each batch of the gateway for the zone."""
    epoch: int
    """The ownership of the zone that the gateway knows; another owner takes nothing of it."""
    movements: NDArray[np.void] = field(default_factory=lambda: np.zeros(0, dtype=MOVEMENT))
    held: list[Held] = field(default_factory=list)
    """Whom the gateway serves: the newest ones in each batch, everyone now and then."""
    departed: list[tuple[int, int, bool]] = field(default_factory=list)
    """Persons whose connection has ended, and whether they may come back."""
    walks: list[tuple[int, int, WalkTo]] = field(default_factory=list)
    lines: list[tuple[int, int, str]] = field(default_factory=list)
    watched: list[tuple[int, int, int | None]] = field(default_factory=list)
    """Actors whose plans somebody wants from now on, or None."""
    doors: list[tuple[int, int, str, bool]] = field(default_factory=list)
    """Doors that operators want open or closed."""
    stood: list[Held] = field(default_factory=list)
    """Persons whose clients have fallen silent, and whose avatars are to stand."""
    muted: list[tuple[int, int, list[int]]] = field(default_factory=list)
    """Whom persons do not want to hear from now on, all of them."""
    reports: list[tuple[int, int, Report]] = field(default_factory=list)
    """Reports of persons to those who look after the world."""
    presences: list[tuple[int, int, bool]] = field(default_factory=list)
    """Whether persons are away from their screens."""
    gestures: list[tuple[int, int, int]] = field(default_factory=list)
    """Gestures that persons make."""
    looks: list[tuple[int, int, Look]] = field(default_factory=list)
    """Looks that persons want to have from now on."""


def encode_batch(batch: Batch) -> bytes:
    """Return the bytes of a batch."""
    head = _HEAD.pack(MAGIC, VERSION, len(batch.movements), batch.epoch, batch.number)
    rest: list[Any] = [
        batch.gateway,
        batch.held,
        batch.departed,
        [(person, generation, wish.model_dump()) for person, generation, wish in batch.walks],
        batch.lines,
        batch.watched,
        batch.doors,
        batch.stood,
        batch.muted,
    ]
    reports = [(person, generation, one.model_dump()) for person, generation, one in batch.reports]
    manners = {"presences": batch.presences, "gestures": batch.gestures, "looks": batch.looks}
    further = {"reports": reports, **manners}
    if any(further.values()):
        rest.append({name: inputs for name, inputs in further.items() if inputs})
    packed: bytes = msgpack.packb(rest)
    return head + batch.movements.tobytes() + packed


def decode_batch(message: bytes) -> Batch:
    """Return the batch that the bytes say.

    Raises
    ------
    BatchError
        They say none.
    """
    if not _HEAD.size <= len(message) <= MOST_BYTES:
        raise BatchError(f"a batch has {_HEAD.size} to {MOST_BYTES} bytes, not {len(message)}")
    magic, version, count, epoch, number = _HEAD.unpack_from(message)
    if magic != MAGIC:
        raise BatchError("the bytes are no batch of inputs")
    if version != VERSION:
        raise BatchError(f"the batch has version {version}, and this program reads {VERSION}")
    end = _HEAD.size + count * MOVEMENT.itemsize
    if end > len(message):
        raise BatchError(f"{count} movements do not fit into the batch")
    movements = np.frombuffer(message, dtype=MOVEMENT, count=count, offset=_HEAD.size)
    if not (
        np.isfinite(movements["direction_rad"]).all() and np.isfinite(movements["speed_mps"]).all()
    ):
        raise BatchError("a movement is not finite")
    rest, further = _read_rest(message[end:])
    gateway, held, departed, walks, lines, watched, doors, stood, muted = rest
    return Batch(
        gateway,
        number,
        epoch,
        movements,
        held,
        departed,
        walks,
        lines,
        watched,
        doors,
        stood,
        muted,
        further.reports,
        further.presences,
        further.gestures,
        further.looks,
    )


def _read_rest(packed: bytes) -> tuple[_Rest, _Further]:
    try:
        rest = list(msgpack.unpackb(packed))
        further = rest[_PARTS] if len(rest) > _PARTS else {}
        return _REST.validate_python(rest[:_PARTS]), _Further.model_validate(further)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = " / ".join(str(part) for part in first["loc"])
        raise BatchError(f"the inputs of the batch: {where}: {first['msg']}") from None
    except (ValueError, msgpack.UnpackException, TypeError) as error:
        raise BatchError(f"the inputs of the batch are not msgpack: {error}") from None
