"""Seconds of a zone, as they are handed over to the thread that writes a recording."""

import zlib
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input


class Tick(NamedTuple):
    """A tick that has ended. Nothing in it changes any more."""

    frame: Frame
    inputs: Sequence[Input]
    touching: npt.NDArray[np.int64]
    """Pairs of an actor and another body, as in `Contacts.touching`."""


class Second(NamedTuple):
    """The ticks of a second of a zone, and its exact state after them."""

    ticks: Sequence[Tick]
    last_tick: int
    at_ns: int
    """When the last of them ended, by the wall clock, nanoseconds since 1970."""
    state: Mapping[str, Any]


def check_of(frame: Frame) -> int:
    """A checksum of what a tick tells of avatars, of 16 bits: it names a tick that differs."""
    found = zlib.crc32(frame.records.tobytes())
    found = zlib.crc32(frame.steps.tobytes(), found)
    return zlib.crc32(repr(frame.left).encode(), found) & 0xFFFF
