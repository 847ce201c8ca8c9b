"""Makes inputs of a tick of facts that are to be true from then on."""

import json
from collections.abc import Callable
from typing import Any

from esplanade.actors import ActorSpec, Scope
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.protocol.commands import Facts
from esplanade.server.console.groups import moved
from esplanade.server.console.state import (
    BEHAVIOUR,
    HELD,
    OPEN,
    PRESENT,
    Effective,
    OperatedState,
    each,
    parameters_of,
    with_facts,
)
from esplanade.server.world.inputs import (
    ActorCommand,
    AddActors,
    Batch,
    ChangeBehaviour,
    HoldActors,
    MoveDoor,
    OneActorCommand,
    RemoveActors,
    SetParameters,
)


def inputs_for(
    facts: Facts, state: OperatedState, number: Callable[[], int]
) -> tuple[list[ActorCommand], list[MoveDoor]]:
    """The inputs that make facts true, each command with a new number.

    Parameters of all actors become one command. Of several commands, and of commands and doors, one
    batch is made, so that all of it becomes true in one tick or nothing.
    """
    commands, doors = _one_by_one(facts, state, number)
    if commands and len(commands) + len(doors) > 1:
        return [Batch(number(), tuple(commands), tuple(doors))], []
    return [*commands], doors


def _one_by_one(
    facts: Facts, state: OperatedState, number: Callable[[], int]
) -> tuple[list[OneActorCommand], list[MoveDoor]]:
    commands: list[OneActorCommand] = []
    overrides = with_facts(state.overrides, facts)
    leaving = _leaving(facts)
    if leaving:
        commands.append(RemoveActors(number(), tuple(leaving)))
    arriving = [
        ActorSpec.model_validate(value)
        for _, field, value in each(facts)
        if field == PRESENT and value is not None
    ]
    if arriving:
        for spec in arriving:
            overrides = overrides.with_values(Scope("own", spec.id), spec.overrides)
        groups = state.groups.taking(facts)
        made = tuple(overrides.parameters(spec.id, groups.names(spec)) for spec in arriving)
        commands.append(AddActors(number(), tuple(arriving), made))
    commands += _parameters(facts, state, leaving, number)
    for value, actors in _alike(facts, BEHAVIOUR):
        behaviour = BEHAVIOUR_SPEC.validate_python(value)
        commands.append(ChangeBehaviour(number(), tuple(actors), behaviour))
    for value, actors in _alike(facts, HELD):
        commands.append(HoldActors(number(), tuple(actors), value))
    doors = [
        MoveDoor(subject.partition(":")[2], value)
        for subject, field, value in each(facts)
        if field == OPEN
    ]
    return commands, doors


def _parameters(
    facts: Facts, state: OperatedState, leaving: list[str], number: Callable[[], int]
) -> list[OneActorCommand]:
    """The command for all parameters that become others, if any do."""
    scopes = parameters_of(facts)
    changed_names = {name for values in scopes.values() for name in values}
    overrides = with_facts(state.overrides, facts)
    if moved(facts):
        changed_names |= {name for values in overrides.values.values() for name in values}
    names = sorted(changed_names)
    now, later = Effective(state.overrides), Effective(overrides)
    groups = state.groups.taking(facts)
    rows = {}
    for spec in state.reached(scopes, facts):
        after = later.values(spec.id, groups.names(spec), names)
        before = now.values(spec.id, state.groups.names(spec), names)
        if after != before and spec.id not in leaving:
            rows[spec.id] = after
    if not rows:
        return []
    columns = [list(column) for column in zip(*rows.values(), strict=True)]
    changed = dict(zip(names, columns, strict=True))
    return [SetParameters(number(), tuple(rows), changed)]


def _leaving(facts: Facts) -> list[str]:
    return [
        subject.partition(":")[2]
        for subject, field, value in each(facts)
        if field == PRESENT and value is None
    ]


def _alike(facts: Facts, wanted: str) -> list[tuple[Any, list[str]]]:
    """The actors that get the same value of a field, by that value."""
    found: dict[str, tuple[Any, list[str]]] = {}
    for subject, field, value in each(facts):
        if field == wanted:
            key = json.dumps(value, sort_keys=True)
            found.setdefault(key, (value, []))[1].append(subject.partition(":")[2])
    return list(found.values())
