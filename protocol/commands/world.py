"""Commands on the world that all share."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from esplanade.protocol.commands.fields import BaseCommand, Place


class MoveDoor(BaseCommand):
    """Open or close a door, once nobody stands in its way."""

    op: Literal["move_door"]
    door: Place
    open: bool


class Pace(BaseCommand):
    """Let the time of the world run slower or faster, stand, or go on by some ticks."""

    op: Literal["pace"]
    factor: Annotated[float, Field(ge=0.1, le=4.0, allow_inf_nan=False)] | None = Field(
        None, description="Seconds of the world in a second; 1 is usual."
    )
    pause: bool | None = Field(None, description="Let time stand for everybody, or run again.")
    step: Annotated[int, Field(ge=1, le=100)] | None = Field(
        None, description="Ticks by which a world that is paused goes on."
    )

    @model_validator(mode="after")
    def _one_of_them(self) -> Pace:
        if sum(value is not None for value in (self.factor, self.pause, self.step)) != 1:
            raise ValueError("give one of factor, pause and step")
        return self


class Record(BaseCommand):
    """Begin to record the world, or end its recording."""

    op: Literal["record"]
    on: bool = Field(description="Whether the world is recorded from now on.")
