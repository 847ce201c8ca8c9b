"""Inputs as plain data, from which another process makes them again.

What was derived beside the ticks is not in it: it follows from the ground as it is in that tick, so
that a few numbers say what is to be derived once more.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from pydantic import TypeAdapter

from esplanade.actors.potential_pool import key_of, plain_key, potential_of
from esplanade.server.world import inputs as live
from esplanade.server.world.inputs import (
    ActorsDerived,
    Batch,
    DoorDerived,
    Input,
    PotentialDerived,
    SetParameters,
    SteerMany,
)
from esplanade.server.world.routes import Point

if TYPE_CHECKING:
    from esplanade.server.world.zone import Zone

Numbers = float | int | list[float] | list[int]
Key = list[Any]
"""A goal, as `plain_key` gives it."""


@dataclass(frozen=True, slots=True)
class RecordedSteers:
    """A `SteerMany`."""

    ids: tuple[int, ...]
    seqs: tuple[int, ...]
    directions_rad: list[float]
    speeds_mps: list[float]


@dataclass(frozen=True, slots=True)
class RecordedParameters:
    """A `SetParameters`."""

    command: int
    actors: tuple[str, ...]
    values: dict[str, Numbers]


@dataclass(frozen=True, slots=True)
class RecordedBatch:
    """A `Batch`; each of its commands as plain data."""

    command: int
    commands: list[dict[str, Any]]
    doors: tuple[live.MoveDoor, ...]


@dataclass(frozen=True, slots=True)
class RecordedDoor:
    """A `DoorDerived`: the door may move now."""

    name: str
    is_open: bool


@dataclass(frozen=True, slots=True)
class RecordedPotential:
    """A `PotentialDerived`: from now on actors go by the ground as it is."""

    goal: Key
    changes: int


@dataclass(frozen=True, slots=True)
class RecordedDerivation:
    """An `ActorsDerived`, with the goals of the potentials that it had."""

    command: int
    goals: list[Key]
    places: tuple[Point, ...]
    fault: str | None


AS_THEY_ARE: Final[dict[str, type[Any]]] = {
    "join": live.Join,
    "attach": live.Attach,
    "detach": live.Detach,
    "leave": live.Leave,
    "stand": live.Stand,
    "steer": live.Steer,
    "follow": live.Follow,
    "people_placed": live.PeoplePlaced,
    "move_door": live.MoveDoor,
    "say": live.Say,
    "watch": live.Watch,
    "set_away": live.SetAway,
    "make_gesture": live.MakeGesture,
    "set_look": live.SetLook,
    "add_actors": live.AddActors,
    "remove_actors": live.RemoveActors,
    "change_behaviour": live.ChangeBehaviour,
    "send_actors": live.SendActors,
    "place_actor": live.PlaceActor,
    "hold_actors": live.HoldActors,
    "ids_reserved": live.IdsReserved,
    "actors_stood": live.ActorsStood,
    "plan_every": live.PlanEvery,
    "steer_actors": live.SteerActors,
    "still": live.Still,
}
"""Inputs that are plain data as they are, by the kinds that files name."""
IN_OTHER_WORDS: Final[dict[str, type[Any]]] = {
    "steer_many": RecordedSteers,
    "set_parameters": RecordedParameters,
    "batch": RecordedBatch,
    "door_derived": RecordedDoor,
    "potential_derived": RecordedPotential,
    "actors_derived": RecordedDerivation,
}
"""Inputs that hold arrays, and what stands for them."""
_KINDS: Final = {made: kind for kind, made in (AS_THEY_ARE | IN_OTHER_WORDS).items()}


def recorded(item: Input) -> dict[str, Any]:
    """An input as plain data, for JSON or msgpack: its `kind` and its fields.

    Raises
    ------
    KeyError
        There is no kind of input like that.
    """
    said = _in_words(item)
    kind = _KINDS[type(said)]
    plain: dict[str, Any] = _adapter(kind).dump_python(said, mode="json")
    return {"kind": kind, **plain}


def input_of(plain: Mapping[str, Any], zone: "Zone") -> Input:
    """The input of the next tick of a zone of which that was made; it derives what is derived.

    Raises
    ------
    ValueError
        It is no such data; pydantic's message says where.
    KeyError
        There is no door of that name.
    """
    said = _said(plain)
    match said:
        case RecordedDoor():
            return DoorDerived(zone.doors.prepare(said.name, said.is_open))
        case RecordedPotential():
            return PotentialDerived(zone.derived_again(key_of(said.goal), said.changes))
        case RecordedDerivation():
            return _derived(said, zone)
    return _in_place(said)


def plain_command(plain: Mapping[str, Any]) -> Input:
    """The input of which `recorded` made that, one for which nothing is derived.

    Raises
    ------
    ValueError
        It is no such data; pydantic's message says where.
    """
    return _in_place(_said(plain))


def schema() -> dict[str, Any]:
    """The JSON schema of all inputs as plain data."""
    kinds: list[tuple[str, Literal["serialization"], TypeAdapter[Any]]] = [
        (kind, "serialization", _adapter(kind)) for kind in AS_THEY_ARE | IN_OTHER_WORDS
    ]
    of_kinds, described = TypeAdapter.json_schemas(kinds)
    one_of = [{"title": kind, **each} for (kind, _), each in of_kinds.items()]
    return {**described, "anyOf": one_of}


@cache
def _adapter(kind: str) -> TypeAdapter[Any]:
    return TypeAdapter((AS_THEY_ARE | IN_OTHER_WORDS)[kind])


def _said(plain: Mapping[str, Any]) -> Any:
    fields = dict(plain)
    kind = fields.pop("kind", None)
    if kind not in AS_THEY_ARE and kind not in IN_OTHER_WORDS:
        raise ValueError(f"there is no kind of input {kind!r}")
    return _adapter(kind).validate_python(fields)


def _in_place(said: Any) -> Input:
    match said:
        case RecordedSteers():
            directions, speeds = np.array(said.directions_rad), np.array(said.speeds_mps)
            if not len(said.ids) == len(said.seqs) == len(directions) == len(speeds):
                raise ValueError("as many people steer as there are directions and speeds")
            return SteerMany(said.ids, said.seqs, directions, speeds)
        case RecordedParameters():
            return SetParameters(said.command, said.actors, said.values)
        case RecordedBatch():
            parts: Any = tuple(plain_command(each) for each in said.commands)
            return Batch(said.command, parts, said.doors)
    made: Input = said
    return made


def _in_words(item: Input) -> Any:
    said: Any = item
    match item:
        case SteerMany():
            directions, speeds = item.directions_rad.tolist(), item.speeds_mps.tolist()
            said = RecordedSteers(item.ids, item.seqs, directions, speeds)
        case SetParameters():
            values = {name: np.asarray(value).tolist() for name, value in item.values.items()}
            said = RecordedParameters(item.command, item.actors, values)
        case Batch():
            parts = [recorded(each) for each in item.commands]
            said = RecordedBatch(item.command, parts, item.doors)
        case DoorDerived():
            said = RecordedDoor(item.change.name, item.change.is_open)
        case PotentialDerived():
            said = RecordedPotential(list(plain_key(item.potential.goal)), item.potential.changes)
        case ActorsDerived():
            goals = [list(plain_key(key)) for key in item.potentials]
            said = RecordedDerivation(item.command, goals, item.places, item.fault)
    return said


def _derived(said: RecordedDerivation, zone: "Zone") -> ActorsDerived:
    """Derive on the ground as it is what a command had waited for."""
    fork = zone.grid.fork()
    keys: Any = [key_of(goal) for goal in said.goals]
    for key in keys:
        fork.row_of(key[3])
    potentials = {key: potential_of(fork, key) for key in keys}
    return ActorsDerived(said.command, None, potentials, said.places, said.fault)
