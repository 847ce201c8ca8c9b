"""The appearance of an actor as data: clothes, hair and skin."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field


class Appearance(BaseModel):
    """The clothes, hair and skin of an actor, by the numbers of the protocol's looks.

    A part that is 0 is not chosen: it follows from the number of the actor's avatar. How tall an
    actor is follows from its parameter `height_m`.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    shirt: Annotated[int, Field(ge=0, le=12, description="Colour of the shirt.")] = 0
    trousers: Annotated[int, Field(ge=0, le=8, description="Colour of the trousers.")] = 0
    hair: Annotated[int, Field(ge=0, le=5, description="Fashion of the hair.")] = 0
    hair_colour: Annotated[int, Field(ge=0, le=8, description="Colour of the hair.")] = 0
    skin: Annotated[int, Field(ge=0, le=8, description="Colour of the skin.")] = 0
