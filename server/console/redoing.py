"""Brings a world that goes on to where the audit says that it was."""

import asyncio
from collections.abc import Callable
from typing import Any

import structlog

from esplanade.actors import ActorSpec
from esplanade.protocol.commands import Facts
from esplanade.server.console.audit_tail import Tail
from esplanade.server.console.console import Console
from esplanade.server.console.inputs import inputs_for
from esplanade.server.console.pacing import change_pace
from esplanade.server.console.state import BEHAVIOUR, PACE, PRESENT, STEPPED, OperatedState
from esplanade.server.world.inputs import ActorCommand, MoveDoor, SetParameters
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


def redo(console: Console, tail: Tail) -> None:
    """Redo what was acknowledged after the checkpoint, and roll back what was not.

    It is done before the first tick, and takes a while: what commands wait for is derived here. A
    command that cannot be done again is logged, and the world goes on without it.
    """
    zone, state = console.zone, console.state
    facts = _still_wanted(tail.facts, state)
    inputs, doors = inputs_for(facts, state, console.new_number)
    _carry_out(zone, [*inputs, *doors])
    state.take(facts)
    _carry_out(zone, _parameters_as_set(state, console.new_number))


def remember(console: Console, tail: Tail) -> None:
    """Know the pace, the changes that can be taken back, and who is muted; on the zone's loop."""
    pace = {name: value for name, value in tail.facts.get(PACE, {}).items() if name != STEPPED}
    if pace:
        change_pace(console.pace, pace, asyncio.get_running_loop().time())
    for person, seconds in tail.muted_s.items():
        console.moderation.mute(person, seconds, "")
    for change in tail.changes:
        console.changes.add(change)
    console.settled = max(console.settled, tail.settled)


def _carry_out(zone: Zone, inputs: list[ActorCommand | MoveDoor]) -> None:
    for outcome in zone.redo(inputs):
        if outcome.fault is not None:
            log.error("a command cannot be done again", fault=outcome.fault.text)


def _still_wanted(facts: Facts, state: OperatedState) -> Facts:
    """The facts that are not so yet, about what there is."""
    wanted: Facts = {}
    for subject, fields in facts.items():
        kind, _, name = subject.partition(":")
        if kind == "actor":
            found = _of_actor(fields, state, subject, is_there=name in state.zone.actors)
        elif kind in {"world", "group"} or (
            kind == "door" and name in state.zone.doors.states()
        ):  # what is saved and scheduled has rows of its own
            found = dict(fields)
        else:
            found = {}
        if found:
            wanted[subject] = found
    return wanted


def _of_actor(
    fields: dict[str, Any], state: OperatedState, subject: str, *, is_there: bool
) -> dict[str, Any]:
    found = dict(fields)
    if PRESENT in found:
        spec = found[PRESENT]
        if spec is None:
            return {PRESENT: None} if is_there else {}
        if is_there:  # it came before the checkpoint was taken
            del found[PRESENT]
            found = {**ActorSpec.model_validate(spec).overrides, **found}
    elif not is_there:
        return {}
    if BEHAVIOUR in found and found[BEHAVIOUR] == state.fact(subject, BEHAVIOUR):
        del found[BEHAVIOUR]
    return found


def _parameters_as_set(
    state: OperatedState, number: Callable[[], int]
) -> list[ActorCommand | MoveDoor]:
    """The command that makes all parameters what is set, if one of them is not."""
    differing: dict[str, dict[str, Any]] = {}
    groups = state.groups
    for spec in state.zone.actors.values():
        try:
            wanted = state.overrides.parameters(spec.id, groups.names(spec)).model_dump()
        except ValueError as error:
            log.error("parameters do not go together", actor=spec.id, fault=str(error))  # noqa: TRY400
            continue
        now = state.zone.parameters(spec.id).model_dump()
        if wanted != now:
            differing[spec.id] = wanted
    if not differing:
        return []
    names = next(iter(differing.values()))
    columns = {name: [each[name] for each in differing.values()] for name in names}
    return [SetParameters(number(), tuple(differing), columns)]
