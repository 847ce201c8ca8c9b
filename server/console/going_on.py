"""One change that goes on for a time, and the row of the audit with which it ends."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from esplanade.protocol.commands import Command, CommandFault, SetParameters
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.changes import Change
from esplanade.server.console.planned import Planned
from esplanade.server.console.records import Records

if TYPE_CHECKING:
    from esplanade.server.console.console import Console


@dataclass
class Ongoing:
    """A change that goes on: values that are dragged, or that go evenly to others."""

    by: Identity
    planned: Planned
    change: Change
    tick: int
    """The tick in which it went on last."""
    steps: int = 1
    faults: list[CommandFault] = field(default_factory=list)

    async def end(self, console: "Console", records: Records) -> None:
        """It goes on no more: write down what became of it, and tell."""
        change = self.change
        more = {"before": change.before, "after": change.after, "steps": self.steps}
        await records.outcomes(
            self.by, [self.planned], [change.number], self.tick, self.faults, more=more
        )
        console.tell_change(change)


def is_ramp(command: Command) -> bool:
    """Whether the values of a command come later, a bit in each tick."""
    return isinstance(command, SetParameters) and command.over_s is not None


def goes_on(command: Command) -> bool:
    """Whether a change goes on after its first tick."""
    return isinstance(command, SetParameters) and (command.stream or command.over_s is not None)
