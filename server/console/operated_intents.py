"""Turns commands on presets, groups and schedules into the facts that they want."""

from collections.abc import Mapping
from typing import Any, Final

from pydantic import ValidationError

from esplanade.actors import ActorParameters
from esplanade.actors.overrides import DEFAULTS
from esplanade.protocol.commands import (
    COMMAND,
    ApplyPreset,
    CancelSchedule,
    Command,
    CommandFault,
    DeletePreset,
    Facts,
    Revert,
    SavePreset,
    ScheduleCommands,
    SetGroup,
    SetParameters,
)
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import COMMANDS, as_text, may
from esplanade.server.console.figures import Figures
from esplanade.server.console.groups import GROUP
from esplanade.server.console.intents import checked_values
from esplanade.server.console.presets import PRESET, Preset
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.schedules import SCHEDULE, Schedule, due_of
from esplanade.server.console.state import OperatedState, parameters_of, scope_of

OPERATED: Final = (
    ApplyPreset,
    SavePreset,
    DeletePreset,
    SetGroup,
    ScheduleCommands,
    CancelSchedule,
)
"""The commands that `operated_facts` understands."""
_NOT_LATER: Final = (ScheduleCommands, CancelSchedule, Revert)


def operated_facts(
    command: Command, by: Identity, state: OperatedState, pending: Facts, now_us: int
) -> Facts:
    """Return the facts that a command of `OPERATED` wants; `pending` are those before it.

    Raises
    ------
    RefusedError
        It cannot be had.
    """
    match command:
        case ApplyPreset():
            return _applied(command, state, pending)
        case SavePreset():
            return _saved(command, by, state, pending, now_us)
        case DeletePreset():
            return state.presets.deleting(command.name)
        case SetGroup():
            return _grouped(command, state)
        case CancelSchedule():
            if state.fact(f"schedule:{command.id}", SCHEDULE) is None:
                text = f"there is no schedule {command.id} that still waits"
                raise RefusedError.of("unknown_schedule", text, "id", id=command.id)
            return {f"schedule:{command.id}": {SCHEDULE: None}}
        case ScheduleCommands():
            return _scheduled(command, by, state, pending, now_us)
        case _:
            raise AssertionError(f"{command.op} is about nothing that is kept")


def check_guard(command: Command, figures: Figures) -> None:
    """See that the figures of a command's guard and of its occasion are known.

    Raises
    ------
    RefusedError
        One is not.
    """
    if isinstance(command, SetParameters | ApplyPreset | ScheduleCommands) and command.guard:
        figures.check(command.guard.figure, "guard", "figure")
    if isinstance(command, ScheduleCommands) and command.when.figure is not None:
        figures.check(command.when.figure.name, "when", "figure", "name")


def ops_within(commands: list[dict[str, Any]]) -> set[str]:
    """The names of the commands of a schedule."""
    return {str(each.get("op")) for each in commands}


def _applied(command: ApplyPreset, state: OperatedState, pending: Facts) -> Facts:
    saved = pending.get(f"preset:{command.preset}", {}).get(PRESET)
    if saved is not None and command.version in {None, saved["version"]}:
        preset = Preset(**saved)
    else:
        try:
            preset = state.presets.found(command.preset, command.version)
        except RefusedError as error:
            raise error.within("preset") from None
    values = checked_values(preset.values, "preset")
    if command.replace:
        there = {**state.overrides.of(scope_of(command.scope)), **pending.get(command.scope, {})}
        values = {**dict.fromkeys(name for name in there if name in DEFAULTS), **values}
    return {command.scope: values}


def _saved(
    command: SavePreset, by: Identity, state: OperatedState, pending: Facts, now_us: int
) -> Facts:
    if command.values is not None:
        values = checked_values(command.values, "values")
    else:
        scope = scope_of(str(command.from_scope))
        later = parameters_of(pending).get(scope, {})
        found = {**state.overrides.of(scope), **later}
        values = {name: value for name, value in found.items() if value is not None}
        if not values:
            text = f"nothing is set in {command.from_scope}"
            raise RefusedError.of("values", text, "from_scope")
    try:
        ActorParameters(**values)
    except ValidationError as error:
        text = f"beside the usual values: {error.errors()[0]['msg']}"
        raise RefusedError.of("values", text, "values") from None
    if f"preset:{command.name}" in pending:
        text = f"preset {command.name} is changed twice in one list"
        raise RefusedError.of("taken", text, "name", preset=command.name)
    return state.presets.saving(command.name, values, command.note, by.account, now_us)


def _grouped(command: SetGroup, state: OperatedState) -> Facts:
    purpose, _, name = command.group.partition(":")
    faults = []
    for index, actor in enumerate(command.actors):
        code, text = "", ""
        if actor not in state.zone.actors:
            code, text = "unknown_actor", f"there is no actor {actor}"
        elif command.remove and state.groups.of(actor).get(purpose) != name:
            code, text = "not_in_group", f"{actor} is not in {command.group}"
        if code:
            place: list[str | int] = ["actors", index]
            arguments = {"actor": actor, "group": command.group}
            faults.append(CommandFault(code=code, text=text, path=place, arguments=arguments))
    if faults:
        raise RefusedError(faults)
    value = None if command.remove else name
    return {f"actor:{actor}": {f"{GROUP}{purpose}": value} for actor in command.actors}


def _scheduled(
    command: ScheduleCommands, by: Identity, state: OperatedState, pending: Facts, now_us: int
) -> Facts:
    for index, each in enumerate(command.commands):
        _check_later(each, by, index)
    due_tick, due_us = due_of(command.when, now_us)
    if (due_tick is not None and due_tick <= state.zone.tick) or (
        due_us is not None and due_us < now_us
    ):
        raise RefusedError.of("passed", "that moment has passed already", "when")
    taken = sum(subject.startswith("schedule:") for subject in pending)
    schedule = Schedule(
        id=state.schedules.new_id(taken),
        commands=command.commands,
        when=command.when.model_dump(mode="json", exclude_none=True),
        again_after_s=command.again_after_s,
        guard=None if command.guard is None else command.guard.model_dump(mode="json"),
        by=by.account,
        rights=as_text(by.rights),
        note=command.note,
        at_us=now_us,
        due_tick=due_tick,
        due_us=due_us,
    )
    return {f"schedule:{schedule.id}": {SCHEDULE: schedule.definition()}}


def _check_later(given: Mapping[str, Any], by: Identity, index: int) -> None:
    try:
        command = COMMAND.validate_python(given)
    except ValidationError as error:
        raise RefusedError(
            [
                CommandFault(
                    code="invalid",
                    text=fault["msg"],
                    path=["commands", index, *fault["loc"][1:]],
                )
                for fault in error.errors()
            ]
        ) from None
    if isinstance(command, _NOT_LATER) or command.dry_run:
        text = f"{command.op} cannot be put off"
        if command.dry_run:
            text = "a dry run cannot be put off"
        raise RefusedError.of("not_later", text, "commands", index)
    if hasattr(command, "person"):
        text = f"{command.op} is about a person, who may be somebody else by then"
        raise RefusedError.of("not_later", text, "commands", index)
    if not may(by.rights, command.op):
        needed = COMMANDS[command.op].value
        text = f"{command.op} needs the right {needed}, which you do not have"
        raise RefusedError.of("forbidden", text, "commands", index, right=needed)
