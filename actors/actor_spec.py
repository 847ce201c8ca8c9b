"""An actor as data: what a roster or an operator says of one."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import BaseModel, ConfigDict, Field, field_validator

from esplanade.actors.appearance import Appearance
from esplanade.actors.behaviour_spec import ActorId, BehaviourSpec, Point, WanderSpec
from esplanade.actors.overrides import WORLD, Overrides

ZONE: Final = "main"
"""The zone that there is; each zone has a name of its own."""
Tag = Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$")]


def actor_id(name: str, zone: str = ZONE) -> str:
    """The id of an actor of a zone."""
    return f"{zone}/{name}"


class ActorSpec(BaseModel):
    """One actor: what it is called, what it does, the groups it belongs to, and its own values."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: ActorId
    name: Annotated[str, Field(min_length=1, max_length=32, description="What others see.")]
    behaviour: BehaviourSpec = WanderSpec()
    tags: Annotated[
        tuple[Tag, ...], Field(max_length=8, description="Groups; the last prevails over others.")
    ] = ()
    overrides: Annotated[
        dict[str, float | int], Field(description="Its own parameters, those that are not usual.")
    ] = {}
    look: Annotated[Appearance, Field(description="What it wears.")] = Appearance()
    place: Point | None = None
    """Where it comes in; None for a free place, chosen with the seed."""
    near: Annotated[
        bool, Field(description="Whether it comes in beside those who stand at that place.")
    ] = False

    @field_validator("overrides")
    @classmethod
    def _known(cls, overrides: dict[str, float | int]) -> dict[str, float | int]:
        try:
            Overrides().with_values(WORLD, overrides)
        except KeyError as error:
            raise ValueError(error.args[0]) from None
        return overrides
