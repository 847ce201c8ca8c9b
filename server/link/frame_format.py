"""A frame as bytes: arrays as they are in memory, and one list of everything else.

The body begins with a head of counts. Records and steps follow as they go to clients, then the
acknowledged movements, and then a list in msgpack. What is packed for clients already (constants of
avatars, plans) is carried as it is. All numbers are little-endian.
"""

import struct
from typing import Any, Final

import msgpack
import numpy as np
from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from esplanade.protocol.looks import NO_LOOK, KnownLook
from esplanade.protocol.snapshot import RECORD
from esplanade.protocol.steps import STEP
from esplanade.server.link.frame_parts import FrameError
from esplanade.server.world.frame import Entered, Events, Frame, Line, Reshaped, Tickets
from esplanade.server.world.outcomes import Fault, FaultCode, Outcome
from esplanade.server.world.routes import Point

ACK: Final = np.dtype([("id", "<u4"), ("seq", "<u4")])
"""A person and the latest movement that the avatar has begun."""

MOST_BYTES: Final = 16 * 1024 * 1024
"""No longer body is read."""

MOST_RATE: Final = 16.0
"""Time of no world runs faster."""

_HEAD: Final = struct.Struct("<IIIBxxxIIIf")
_ACTORS_STOOD: Final = 1

_Constants = tuple[bytes, bytes]
_Entered = tuple[int, int, str, _Constants]
_Reshaped = tuple[int, float, float, float, _Constants]
_Fault = tuple[FaultCode, str, dict[str, Any]]
_Rest = tuple[
    list[int],  # left
    list[_Entered],
    list[_Reshaped],
    Tickets,  # joined
    Tickets,  # attached
    list[int],  # detached
    dict[str, bool],  # doors
    dict[int, Point | None],  # pointing
    list[tuple[int, str, int]],  # chat
    dict[int, bytes],  # plans
    list[tuple[int, int, _Fault | None]],  # outcomes
]
_REST: Final = TypeAdapter(_Rest)
_PARTS: Final = 11


class _Further(BaseModel):
    """Events that older programs do not know: a map behind the others, where there are any.

    A program passes over those that only newer ones know.
    """

    gestures: dict[int, int] = Field(default_factory=dict)
    away: dict[int, bool] = Field(default_factory=dict)
    looks: dict[int, KnownLook] = Field(default_factory=dict)
    """Of those among the reshaped who have chosen one."""
    hearers: dict[int, frozenset[int]] = Field(default_factory=dict)
    """Of the lines that not everybody hears, by their places among all."""


def encode_frame(frame: Frame) -> bytes:
    """Return the body of a frame."""
    flags = _ACTORS_STOOD if frame.actors_stood else 0
    counts = len(frame.records), len(frame.steps), len(frame.acks)
    head = _HEAD.pack(frame.tick, frame.people, frame.actors, flags, *counts, frame.rate)
    acks = np.empty(len(frame.acks), dtype=ACK)
    acks["id"] = list(frame.acks)
    acks["seq"] = list(frame.acks.values())
    arrays = frame.records.tobytes() + frame.steps.tobytes() + acks.tobytes()
    packed: bytes = msgpack.packb(_rest_of(frame))
    return head + arrays + packed


def decode_frame(body: bytes) -> Frame:
    """Return the frame that the bytes say.

    Raises
    ------
    FrameError
        They say none.
    """
    if not _HEAD.size <= len(body) <= MOST_BYTES:
        raise FrameError(f"a frame has {_HEAD.size} to {MOST_BYTES} bytes, not {len(body)}")
    tick, people, actors, flags, *counts, rate = _HEAD.unpack_from(body)
    if not 0.0 <= rate <= MOST_RATE:
        raise FrameError(f"time runs 0 to {MOST_RATE:g} times as fast as usual, not {rate}")
    arrays, at = [], _HEAD.size
    for kind, count in zip((RECORD, STEP, ACK), counts, strict=True):
        end = at + count * kind.itemsize
        if end > len(body):
            raise FrameError(f"{count} items of {kind.itemsize} bytes do not fit into the frame")
        arrays.append(np.frombuffer(body, dtype=kind, count=count, offset=at))
        at = end
    records, steps, acks = arrays
    rest, further = _read_rest(body[at:])
    left, entered, reshaped, joined, attached, detached = rest[:6]
    doors, pointing, chat, plans, outcomes = rest[6:]
    return Frame(
        tick=tick,
        people=people,
        actors=actors,
        left=left,
        entered=[Entered(*each) for each in entered],
        joined=joined,
        attached=attached,
        detached=detached,
        acks=dict(zip(acks["id"].tolist(), acks["seq"].tolist(), strict=True)),
        records=records,
        steps=steps,
        events=Events(
            doors=doors,
            pointing=pointing,
            chat=[Line(*each, to=further.hearers.get(k)) for k, each in enumerate(chat)],
            gestures=further.gestures,
            away=further.away,
            plans=plans,
        ),
        reshaped=[Reshaped(*each, further.looks.get(each[0], NO_LOOK)) for each in reshaped],
        outcomes=[
            Outcome(command, at_tick, None if fault is None else Fault(*fault))
            for command, at_tick, fault in outcomes
        ],
        actors_stood=bool(flags & _ACTORS_STOOD),
        rate=rate,
    )


def _rest_of(frame: Frame) -> list[Any]:
    events = frame.events
    rest: list[Any] = [
        frame.left,
        [(each.id, each.kind, each.name, each.constants) for each in frame.entered],
        [
            (each.id, each.radius_m, each.leg_m, each.stature_m, each.constants)
            for each in frame.reshaped
        ],
        frame.joined,
        frame.attached,
        frame.detached,
        dict(events.doors),
        dict(events.pointing),
        [(line.id, line.text, line.number) for line in events.chat],
        dict(events.plans),
        [
            (each.command, each.tick, None if each.fault is None else _fault(each.fault))
            for each in frame.outcomes
        ],
    ]
    looks = {each.id: each.look for each in frame.reshaped if each.look != NO_LOOK}
    hearers = {k: sorted(line.to) for k, line in enumerate(events.chat) if line.to is not None}
    manners = {"gestures": dict(events.gestures), "away": dict(events.away)}
    further = {**manners, "looks": looks, "hearers": hearers}
    if any(further.values()):
        rest.append({name: told for name, told in further.items() if told})
    return rest


def _fault(fault: Fault) -> tuple[str, str, dict[str, Any]]:
    return fault.code.value, fault.text, dict(fault.arguments)


def _read_rest(packed: bytes) -> tuple[_Rest, _Further]:
    try:
        # Keys of maps are avatars' ids as well as names.
        rest = list(msgpack.unpackb(packed, strict_map_key=False))
        further = rest[_PARTS] if len(rest) > _PARTS else {}
        return _REST.validate_python(rest[:_PARTS]), _Further.model_validate(further)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = " / ".join(str(part) for part in first["loc"])
        raise FrameError(f"the events of the frame: {where}: {first['msg']}") from None
    except (ValueError, msgpack.UnpackException, TypeError) as error:
        raise FrameError(f"the events of the frame are not msgpack: {error}") from None
