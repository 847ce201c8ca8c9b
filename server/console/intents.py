"""Turns commands into the facts that they want, checked as far as data alone allow."""

import itertools
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Final

from pydantic import TypeAdapter, ValidationError

from esplanade.actors import ActorParameters, ActorSpec
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC, BehaviourSpec
from esplanade.actors.overrides import DEFAULTS
from esplanade.protocol.commands import (
    ZONE,
    AddActors,
    ClearParameters,
    Command,
    CommandFault,
    Facts,
    HoldActor,
    MoveDoor,
    NewActor,
    Pace,
    Record,
    RemoveActors,
    SendActor,
    SetBehaviour,
    SetParameters,
)
from esplanade.server.console.groups import GROUP
from esplanade.server.console.recording import RECORDED, RECORDING
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import (
    BEHAVIOUR,
    FACTOR,
    HELD,
    OPEN,
    PACE,
    PAUSED,
    PRESENT,
    STEPPED,
    OperatedState,
    scope_of,
    with_facts,
)
from esplanade.server.console.waves import leaving, of_wave

_FIELDS: Final[Mapping[str, TypeAdapter[Any]]] = {
    name: TypeAdapter(Annotated[field.annotation, *field.metadata])  # type: ignore[arg-type]
    for name, field in ActorParameters.model_fields.items()
}


def intended(  # noqa: C901, PLR0911, PLR0912 (one for each command)
    command: Command, state: OperatedState, pending: Facts
) -> Facts:
    """Return the facts that a command wants; `pending` are those of commands before it.

    Raises
    ------
    RefusedError
        It cannot be had.
    """
    match command:
        case SetParameters():
            return {command.scope: checked_values(command.values, "values")}
        case ClearParameters():
            return {command.scope: _cleared(command, state)}
        case SetBehaviour():
            spec = _behaviour(command.behaviour, "behaviour")
            return _of_actors(command.actors, BEHAVIOUR, spec, state, "actors")
        case SendActor():
            going = {"kind": "go_to", "target": command.target}
            spec = _behaviour(going, "target")
            return _of_actors((command.actor,), BEHAVIOUR, spec, state, "actor")
        case HoldActor():
            return _of_actors((command.actor,), HELD, command.held, state, "actor")
        case RemoveActors():
            leavers = leaving(command, state)
            gone = _of_actors(leavers, PRESENT, None, state, "actors")
            for actor in leavers:
                gone[f"actor:{actor}"] |= {
                    f"{GROUP}{each}": None for each in state.groups.of(actor)
                }
            return gone
        case AddActors():
            return _newcomers(command, state, pending)
        case MoveDoor():
            if command.door not in state.zone.doors.states():
                text = f"the scene has no door {command.door!r}"
                raise RefusedError.of("unknown_door", text, "door", door=command.door)
            return {f"door:{command.door}": {OPEN: command.open}}
        case Pace():
            return _pace(command, state, pending)
        case Record():
            return _record(command, state)
        case _:
            raise AssertionError(f"{command.op} wants nothing of the zone itself")


def _record(command: Record, state: OperatedState) -> Facts:
    if state.recorder is None:
        text = "the server has no folder for recordings: start it with --record DIR"
        raise RefusedError.of("no_recordings", text, "on")
    return {RECORDING: {RECORDED: command.on}}


def _pace(command: Pace, state: OperatedState, pending: Facts) -> Facts:
    if command.factor is not None:
        return {PACE: {FACTOR: command.factor}}
    if command.pause is not None:
        return {PACE: {PAUSED: command.pause}}
    if not pending.get(PACE, {}).get(PAUSED, state.fact(PACE, PAUSED)):
        text = "only a world that is paused goes on tick by tick"
        raise RefusedError.of("not_paused", text, "step")
    return {PACE: {STEPPED: command.step}}


def checked_values(values: Mapping[str, float], *path: str) -> dict[str, Any]:
    """Values of parameters, whole where they must be.

    Raises
    ------
    RefusedError
        A name is unknown, or a value out of its range; all of them are told.
    """
    found: dict[str, Any] = {}
    faults = []
    for name, value in values.items():
        if name not in _FIELDS:
            text = f"{name!r} is no parameter of actors"
            faults.append(CommandFault(code="values", text=text, path=[*path, name]))
            continue
        try:
            found[name] = _FIELDS[name].validate_python(value)
        except ValidationError as error:
            text = f"{name}: {error.errors()[0]['msg']}"
            faults.append(CommandFault(code="values", text=text, path=[*path, name]))
    if faults:
        raise RefusedError(faults)
    return found


def _cleared(command: ClearParameters, state: OperatedState) -> dict[str, Any]:
    unknown = [name for name in command.names if name not in DEFAULTS]
    if unknown:
        index, text = command.names.index(unknown[0]), f"{unknown[0]!r} is no parameter of actors"
        raise RefusedError.of("values", text, "names", index)
    return dict.fromkeys(command.names or state.overrides.of(scope_of(command.scope)))


def _of_actors(
    actors: tuple[str, ...], field: str, value: Any, state: OperatedState, place: str
) -> Facts:
    faults = [
        CommandFault(
            code="unknown_actor",
            text=f"there is no actor {actor}",
            path=[place, index] if place == "actors" else [place],
            arguments={"actor": actor},
        )
        for index, actor in enumerate(actors)
        if actor not in state.zone.actors
    ]
    if faults:
        raise RefusedError(faults)
    return {f"actor:{actor}": {field: value} for actor in actors}


def _behaviour(given: Mapping[str, Any], *path: str | int) -> Any:
    try:
        spec: BehaviourSpec = BEHAVIOUR_SPEC.validate_python(given)
    except ValidationError as error:
        raise _of_errors(error, "behaviour", *path) from None
    return spec.model_dump(mode="json")


def _newcomers(command: AddActors, state: OperatedState, pending: Facts) -> Facts:
    wanted: Facts = {}
    overrides = with_facts(state.overrides, pending)
    free = _free_ids(state, pending, wanted)
    for index, new in enumerate(of_wave(command, state, pending)):
        own = _own_values(new, index)
        given = new.id or next(free)
        subject = f"actor:{given}"
        try:
            spec = ActorSpec(
                id=given,
                name=new.name or given.partition("/")[2],
                behaviour=new.behaviour,
                tags=new.tags,
                overrides=own,
                look=new.look,
                place=new.place,
                near=command.count is not None and new.place is not None,
            )
            overrides.with_values(scope_of(subject), own).parameters(spec.id, spec.tags)
        except ValidationError as error:
            raise _of_errors(error, "values", "actors", index) from None
        if subject in wanted or state.fact(subject, PRESENT) is not None:
            text = f"there already is an actor {given}"
            raise RefusedError.of("taken", text, "actors", index, "id", actor=given)
        wanted[subject] = {PRESENT: spec.model_dump(mode="json")}
    return wanted


def _own_values(new: NewActor, index: int) -> dict[str, Any]:
    try:
        return checked_values(new.overrides, "overrides")
    except RefusedError as error:
        raise error.within("actors", index) from None


def _free_ids(state: OperatedState, pending: Facts, wanted: Facts) -> Iterator[str]:
    for number in itertools.count(len(state.zone.actors) + 1):
        found = f"{ZONE}/actor-{number}"
        subject = f"actor:{found}"
        if found not in state.zone.actors and subject not in pending and subject not in wanted:
            yield found


def _of_errors(error: ValidationError, code: str, *path: str | int) -> RefusedError:
    return RefusedError(
        [
            CommandFault(code=code, text=each["msg"], path=[*path, *each["loc"]])
            for each in error.errors()
        ]
    )
