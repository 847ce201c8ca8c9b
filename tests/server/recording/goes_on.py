"""A process that lets zones go on from their exact states, and says how each tick ended.

It reads jobs of msgpack from its input, one after the other, and answers each with digests.
"""

import struct
import sys
from typing import IO, Any

import msgpack

from esplanade.server.checkpoint.format import parts_of
from esplanade.server.recording.digests import digests
from esplanade.server.world.recorded_inputs import input_of
from tests.server.populated import Populated


def write(stream: IO[bytes], message: Any) -> None:
    packed: bytes = msgpack.packb(message)
    stream.write(struct.pack("<I", len(packed)) + packed)
    stream.flush()


def read(stream: IO[bytes]) -> Any:
    head = stream.read(4)
    return msgpack.unpackb(stream.read(struct.unpack("<I", head)[0])) if len(head) == 4 else None


def told(world: Populated) -> dict[str, str]:
    """The digests of a zone after a tick, and of all that is told of it."""
    return digests(world.zone.save_exactly())


def goes_on(state: bytes, ticks: list[list[dict[str, Any]]]) -> list[dict[str, str]]:
    world = Populated([], room_for=3)
    world.zone.load_exactly(parts_of(state))
    found = [told(world)]
    for plain in ticks:
        zone = world.zone
        zone.begin([input_of(each, zone) for each in plain])
        zone.finish(zone.think())
        found.append(told(world))
    world.population.close()
    return found


if __name__ == "__main__":
    while (job := read(sys.stdin.buffer)) is not None:
        write(sys.stdout.buffer, goes_on(*job))
