"""Commands on actors."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from esplanade.protocol.commands.fields import (
    NO_NUL,
    TAG,
    ActorRef,
    Actors,
    BaseCommand,
    Metres,
    Number,
    ParameterName,
    Place,
    all_different,
)
from esplanade.protocol.commands.presets import PresetName

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
    look: dict[str, int] = Field(
        {}, max_length=8, description="What it wears, by the parts of the protocol's looks."
    )
    place: tuple[Metres, Metres, Metres] | None = Field(
        None, description="Where it comes in; None for a free place."
    )


class AddActors(BaseCommand):
    """Let actors come into the world, each as it is described, or a wave of many alike.

    All of them come, or none.
    """

    op: Literal["add_actors"]
    actors: Annotated[tuple[NewActor, ...], Field(max_length=MOST_NEW)] = ()
    count: Annotated[int, Field(ge=1, le=MOST_NEW)] | None = Field(
        None, description="A wave of so many, which are called after their numbers."
    )
    behaviour: dict[str, Any] = Field(
        default_factory=lambda: {"kind": "wander"}, description="Of everybody in a wave."
    )
    preset: PresetName | None = Field(
        None, description="Everybody in a wave has the values of this preset as its own."
    )
    overrides: Annotated[dict[ParameterName, Number], Field(max_length=64)] = Field(
        {}, description="The same; they go before those of the preset."
    )
    tags: Annotated[tuple[str, ...], Field(max_length=8)] = ()
    near: Place | tuple[Metres, Metres, Metres] | None = Field(
        None, description="A wave comes in around this place of the scene, or this point."
    )

    @model_validator(mode="after")
    def _one_or_the_other(self) -> AddActors:
        fields = type(self).model_fields
        of_a_wave = any(
            getattr(self, name) != fields[name].get_default(call_default_factory=True)
            for name in ("count", "behaviour", "preset", "overrides", "tags", "near")
        )
        if self.actors and of_a_wave:  # what is written down has defaults too
            raise ValueError("give actors, or count and what all of a wave have, not both")
        if not self.actors and self.count is None:
            raise ValueError("give actors or count")
        return self


class RemoveActors(BaseCommand):
    """Take actors out of the world: those that are named, or all with a tag; all, or none."""

    op: Literal["remove_actors"]
    actors: Annotated[
        tuple[ActorRef, ...], Field(max_length=500), AfterValidator(all_different)
    ] = ()
    tag: Annotated[str, Field(pattern=f"^{TAG}$")] | None = Field(
        None, description="All actors that have this tag."
    )

    @model_validator(mode="after")
    def _one_or_the_other(self) -> RemoveActors:
        if bool(self.actors) == (self.tag is not None):
            raise ValueError("give actors or tag")
        return self
