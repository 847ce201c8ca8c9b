"""From the words of a command line to an exit code."""

import gc
import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any

from esplanade.commandline import exit_codes, interrupts
from esplanade.commandline.errors import CommandError
from esplanade.commandline.parser import Parser


def run(parser: Parser, words: Sequence[str]) -> int:
    """Read the options, import what does the command, and do it; returns the exit code.

    Raises
    ------
    SystemExit
        Help was asked for, or the options are wrong; what there is to say has been said.
    """
    options = parser.parse_args(words)
    options.words = list(words)
    try:
        command: Callable[[Namespace], int] = imported(options.run)
        with interrupts.raised():
            return command(options)
    except CommandError as error:
        for line in str(error).splitlines():
            sys.stderr.write(f"{options.prog}: {line}\n")
        return error.exit_code
    except KeyboardInterrupt:
        return exit_codes.INTERRUPTED


def imported(name: str) -> Any:
    """The object that a name like "package.module:name" refers to.

    Modules stay: to look through them for garbage would be an eighth of the time that they take.
    """
    module, _, attribute = name.partition(":")
    collects = gc.isenabled()
    gc.disable()
    try:
        return getattr(import_module(module), attribute)
    finally:
        if collects:
            gc.enable()
