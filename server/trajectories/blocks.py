"""Blocks of what one tick adds to a file of trajectories, and what is written of each."""

import json
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from esplanade.actors import ActorParameters
from esplanade.recordings.samples import Note, Samples
from esplanade.recordings.streams import Stream
from esplanade.server.world.inputs import (
    ActorCommand,
    AddActors,
    ChangeBehaviour,
    HoldActors,
    PlaceActor,
    RemoveActors,
    SendActors,
    SetParameters,
    parts_of,
)

USUAL: Mapping[str, float | int] = ActorParameters().model_dump()


@dataclass(frozen=True, slots=True)
class Block:
    """One tick: samples where they are due, and what has changed with it. Nothing in it changes."""

    tick: int
    frame: int
    samples: Samples | None = None
    avatars: tuple[Mapping[str, Any], ...] = ()
    """Those that came in, or have another body."""
    commands: tuple[ActorCommand, ...] = ()
    """Those that were carried out in the tick."""
    doors: Mapping[str, bool] = field(default_factory=dict)
    parameters: Mapping[Hashable, ActorParameters] = field(default_factory=dict)
    """Of all actors, in the first block."""
    planning_interval: int | None = None
    """Ticks from one planning of an actor to its next, in the first block and where they change."""

    @property
    def size(self) -> int:
        """About how many bytes it keeps."""
        return 512 + (0 if self.samples is None else self.samples.nbytes) + 256 * len(self.avatars)


def write_block(stream: Stream, block: Block) -> None:
    """Write a block: first what holds from its frame on, then its samples.

    Raises
    ------
    WritingError
        The file cannot be written.
    """
    for kind, told in _notes(block):
        text = json.dumps(told, separators=(",", ":"), default=_plain, ensure_ascii=False)
        stream.note(Note(block.frame, block.tick, kind, text))
    if block.samples is not None and len(block.samples):
        stream.add(block.samples)


def _notes(block: Block) -> Iterable[tuple[str, Any]]:
    if block.parameters:
        own = {str(actor): _unusual(values) for actor, values in block.parameters.items()}
        yield "parameters", {"usual": USUAL, "actors": own}
    if block.planning_interval is not None:
        yield "planning", {"interval_ticks": block.planning_interval}
    yield from (("avatar", avatar) for avatar in block.avatars)
    for command in block.commands:
        yield from map(_told, parts_of(command))
    if block.doors:
        yield "doors", block.doors


def _unusual(values: ActorParameters) -> dict[str, float | int]:
    return {name: value for name, value in values.model_dump().items() if value != USUAL[name]}


def _told(command: Any) -> tuple[str, Any]:
    """The changes of a command: parameters by actor, or what actors do."""
    actors = list(command.actors)
    match command:
        case SetParameters(values=values):
            columns = {
                name: np.broadcast_to(np.asarray(value), len(actors)).tolist()
                for name, value in values.items()
            }
            return "parameters", {
                "actors": {
                    actor: {name: column[k] for name, column in columns.items()}
                    for k, actor in enumerate(actors)
                }
            }
        case AddActors(parameters=parameters):
            own = map(_unusual, parameters)
            return "parameters", {"actors": dict(zip(actors, own, strict=True))}
        case RemoveActors():
            told: Any = {"removed": actors}
        case ChangeBehaviour(behaviour=behaviour):
            told = {"actors": actors, "behaviour": behaviour}
        case SendActors(target=target):
            told = {"actors": actors, "sent_to": target}
        case PlaceActor(place=place):
            told = {"actors": actors, "put_at": place}
        case HoldActors(held=held):
            told = {"actors": actors, "held": held}
        case _:
            told = {"actors": actors}
    return "actors", told


def _plain(value: Any) -> Any:
    """Values that JSON does not know."""
    if hasattr(value, "model_dump"):
        return value.model_dump(mode="json")
    return value.tolist() if hasattr(value, "tolist") else str(value)
