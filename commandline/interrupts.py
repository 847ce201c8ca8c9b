"""Ctrl-C: until a command works, and after, it ends the process quietly.

While a command works, Ctrl-C is a `KeyboardInterrupt`, so that it can tidy up. Before, modules are
being imported: an exception in the midst of that is printed by whatever was importing.
"""

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from esplanade.commandline import exit_codes


def end_quietly() -> None:
    """From now on Ctrl-C ends the process at once, unless whoever started it ignores Ctrl-C."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _end)


@contextmanager
def raised() -> Iterator[None]:
    """In here Ctrl-C is a `KeyboardInterrupt`, where it would have ended the process."""
    if signal.getsignal(signal.SIGINT) is not _end:
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, _end)


def _end(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 (a handler's signature)
    os._exit(exit_codes.INTERRUPTED)
