"""Plans commands: checks rights and conditions, and says which facts each of them changes."""

from collections.abc import Callable, Sequence
from typing import Any

from esplanade.protocol.commands import (
    ApplyPreset,
    ClearParameters,
    Command,
    CommandFault,
    Facts,
    Mark,
    Revert,
    SetParameters,
)
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import COMMANDS, may
from esplanade.server.console.changes import Change, Changes
from esplanade.server.console.facts import together
from esplanade.server.console.figures import Figures
from esplanade.server.console.groups import GROUP
from esplanade.server.console.guards import Guards
from esplanade.server.console.intents import intended
from esplanade.server.console.moderation_intents import (
    KINDS,
    MODERATING,
    REVERTIBLE,
    ModerationIntents,
)
from esplanade.server.console.operated_intents import (
    OPERATED,
    check_guard,
    operated_facts,
    ops_within,
)
from esplanade.server.console.planned import Planned
from esplanade.server.console.presets import PRESET
from esplanade.server.console.recording import RECORDED
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.schedules import SCHEDULE
from esplanade.server.console.state import (
    BEHAVIOUR,
    FACTOR,
    HELD,
    OPEN,
    PAUSED,
    PRESENT,
    OperatedState,
    each,
)


class CommandPlans:
    """Plans lists of commands against the facts of now. Nothing is changed by it."""

    def __init__(
        self,
        state: OperatedState,
        changes: Changes,
        moderation: ModerationIntents,
        figures: Figures,
        guards: Guards,
        check_room: Callable[[SetParameters], None],
        clock_us: Callable[[], int],
    ) -> None:
        """`check_room` refuses a ramp or a dragged value if too many are under way."""
        self._state = state
        self._changes = changes
        self._moderation = moderation
        self._figures = figures
        self._guards = guards
        self._check_room = check_room
        self._clock_us = clock_us

    def plan(self, by: Identity, commands: Sequence[Command]) -> list[Planned]:
        """The facts that each command changes; later commands see those of earlier ones.

        Raises
        ------
        RefusedError
            Some cannot be had; all faults are told, each below its command's place in the list.
        """
        planned: list[Planned] = []
        faults: list[CommandFault] = []
        for index, command in enumerate(commands):
            pending = together([one.after for one in planned])
            try:
                planned.append(self._plan_one(by, command, pending))
            except RefusedError as error:
                faults += error.within(index).faults
        if faults:
            raise RefusedError(faults)
        return planned

    def _plan_one(self, by: Identity, command: Command, pending: Facts) -> Planned:
        if isinstance(command, Revert):
            return self._plan_revert(by, command, pending)
        person = None
        if isinstance(command, MODERATING):
            wanted = self._moderation.wanted(command, pending)
            facts, person = wanted.facts, wanted.person
            if not isinstance(command, REVERTIBLE):
                return Planned(command, {}, facts, person=person)
        elif isinstance(command, Mark):
            return Planned(command, {}, {})
        elif isinstance(command, OPERATED):
            self._check_conditions(command)
            facts = operated_facts(command, by, self._state, pending, self._clock_us())
        else:
            self._check_conditions(command)
            facts = intended(command, self._state, pending)
        if isinstance(command, SetParameters | ClearParameters):
            self._changes.check_revision(command.if_revision, facts, self._state)
        return Planned(command, self._before(facts, pending), facts, person=person)

    def _before(self, facts: Facts, pending: Facts) -> Facts:
        """The values that hold where facts are to be, after the commands that come before."""
        before = self._state.now(facts)
        for subject, fields in pending.items():
            for field in fields.keys() & before.get(subject, {}).keys():
                before[subject][field] = fields[field]
        return before

    def _plan_revert(self, by: Identity, command: Revert, pending: Facts) -> Planned:
        change = self._changes.found(command.change, by.account)
        for op in _needed_for(change):
            check_right(by, op)
        if not change.after:
            text = f"change {change.number} has changed nothing that could be taken back"
            raise RefusedError.of("unknown_change", text, "change", change=change.number)
        self._changes.check_untouched(change, self._state, pending)
        return Planned(command, change.after, change.before, change.number)

    def _check_conditions(self, command: Command) -> None:
        """Check the guard of a command, and what goes on after its first tick."""
        check_guard(command, self._figures)
        if isinstance(command, SetParameters | ApplyPreset) and command.guard is not None:
            self._guards.check_room()
        if isinstance(command, SetParameters):
            self._check_room(command)


def check_list(by: Identity, commands: Sequence[Command]) -> None:
    """Check the rights for a list of commands, and that it is one thing: a dry run or none.

    Raises
    ------
    RefusedError
        A right is missing, or only some are dry runs.
    """
    for index, command in enumerate(commands):
        check_right(by, command.op, index)
    if len({command.dry_run for command in commands}) > 1:
        text = "a list is carried out as a whole, or checked as a whole"
        raise RefusedError.of("mixed", text, 0, "dry_run")


def check_right(by: Identity, op: str, *path: int) -> None:
    """Check that somebody has the right that a command needs.

    Raises
    ------
    RefusedError
        They have not.
    """
    if may(by.rights, op):
        return
    needed = COMMANDS[op].value
    raise RefusedError.of(
        "forbidden", f"{op} needs the right {needed}, which you do not have", *path, right=needed
    )


def _needed_for(change: Change) -> set[str]:
    """The commands whose rights are needed to take a change back."""
    return {op for fact in each(change.before) for op in _ops_of(*fact)}


def _ops_of(subject: str, field: str, value: Any) -> set[str]:
    """The commands that make such a fact."""
    if subject.partition(":")[0] in KINDS:
        return {"unban"}
    if field.startswith(GROUP):
        return {"set_group"}
    needed = {_OPS.get(field, "set_parameters")}
    if field == SCHEDULE and value is not None:
        needed |= ops_within(value["commands"])
    return needed


_OPS = {
    BEHAVIOUR: "set_behaviour",
    HELD: "hold_actor",
    OPEN: "move_door",
    PRESENT: "add_actors",
    FACTOR: "pace",
    PAUSED: "pace",
    RECORDED: "record",
    PRESET: "save_preset",
    SCHEDULE: "schedule",
}
"""The command that makes a fact, by its field; fields that are not here are parameters."""
