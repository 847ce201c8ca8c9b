"""The faults that end a command with one line."""

from typing import ClassVar

from esplanade.commandline import exit_codes


class CommandError(Exception):
    """The command cannot go on; the message says why and what helps."""

    exit_code: ClassVar[int] = exit_codes.FAILED


class UsageError(CommandError):
    """A command that cannot be carried out; the message says why."""

    exit_code: ClassVar[int] = exit_codes.USAGE
