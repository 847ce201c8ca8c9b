"""Ctrl-C: until a command works, and after, it ends the process quietly.

While a command works, Ctrl-C is a `KeyboardInterrupt`, so that it can tidy up. Before, modules are
being imported: an exception in the midst of that is printed by whatever was importing.
"""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import NoReturn

from esplanade.commandline import exit_codes


def end_quietly() -> None:
    """Let Ctrl-C end the process at once, unless the process was started to ignore Ctrl-C."""
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _end)


def end() -> NoReturn:
    """End the process here, as one that Ctrl-C has ended.

    A `KeyboardInterrupt` that has gone through `exec` makes Python kill itself by a signal at its
    end, whatever exit code there is; and threads that work on would be waited for.
    """
    with suppress(OSError, ValueError):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(exit_codes.INTERRUPTED)


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
