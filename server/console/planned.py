"""A command that was planned: the facts that it changes, before and after."""

from dataclasses import dataclass

from esplanade.protocol.commands import Command, Facts


@dataclass(frozen=True)
class Planned:
    """A command, with the facts that it changes."""

    command: Command
    before: Facts
    after: Facts
    reverts: int | None = None
    """The number of the change that it takes back, if it takes one back."""
    person: str | None = None
    """The name of the person whom it is about."""
