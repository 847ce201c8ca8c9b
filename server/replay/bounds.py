"""The part of a recording that options name."""

import sys
from argparse import Namespace

from esplanade.commandline.errors import UsageError
from esplanade.server.recording.reader import Recording


def bounds(recording: Recording, options: Namespace) -> tuple[int, int]:
    """The ticks after which the part begins, and with which it ends.

    Raises
    ------
    UsageError
        It begins after the end of the recording.
    """
    tick_s, first = recording.head.built.tick_s, recording.first_tick
    begin = first + round((options.from_s or 0.0) / tick_s)
    end = sys.maxsize if options.to_s is None else first + round(options.to_s / tick_s)
    if (
        options.from_s is not None
        and recording.last_tick is not None
        and begin >= recording.last_tick
    ):
        raise too_late(recording, options, recording.last_tick)
    return begin, end


def too_late(recording: Recording, options: Namespace, last_tick: int) -> UsageError:
    """The fault of a part that begins after the last tick."""
    length_s = (last_tick - recording.first_tick) * recording.head.built.tick_s
    return UsageError(
        f"{options.file}: --from {options.from_s:g} s: the recording has {length_s:g} s"
    )
