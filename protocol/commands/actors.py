"""Commands on actors."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from esplanade.protocol.commands.fields import (
    NO_NUL,
    ActorRef,
    Actors,
    BaseCommand,
    Metres,
    Number,
    ParameterName,
    Place,
)

MOST_NEW: Final = 200
"""One command adds no more actors than this."""


class SetBehaviour(BaseCommand):
    """Let actors do something else from now on."""

    op: Literal["set_behaviour"]
    actors: Actors
    behaviour: dict[str, Any] = Field(
        description="One of `behaviours` in /api/v1/schema, by its `kind`."
    )


class SendActor(BaseCommand):
    """Send an actor to a place of the scene or to a point, where it stays."""

    op: Literal["send_actor"]
    actor: ActorRef
    target: Place | tuple[Metres, Metres, Metres]


class HoldActor(BaseCommand):
    """Let an actor stand where it is, making way, or go on with what it did."""

    op: Literal["hold_actor"]
    actor: ActorRef
    held: bool = True


class NewActor(BaseModel):
    """An actor that is to come in."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: ActorRef | None = Field(None, description="None for the next that is free.")
    name: Annotated[str, Field(min_length=1, max_length=32, pattern=NO_NUL)] | None = None
    behaviour: dict[str, Any] = Field(default_factory=lambda: {"kind": "wander"})
    tags: Annotated[tuple[str, ...], Field(max_length=8)] = ()
    overrides: Annotated[dict[ParameterName, Number], Field(max_length=64)] = {}
    place: tuple[Metres, Metres, Metres] | None = Field(
        None, description="Where it comes in; None for a free place."
    )


class AddActors(BaseCommand):
    """Let actors come into the world: all of them, or none."""

    op: Literal["add_actors"]
    actors: Annotated[tuple[NewActor, ...], Field(min_length=1, max_length=MOST_NEW)]


class RemoveActors(BaseCommand):
    """Take actors out of the world: all of them, or none."""

    op: Literal["remove_actors"]
    actors: Actors
