"""Conditions on figures of a world, and guards that take a change back when one holds."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from esplanade.protocol.commands.fields import Number

FigureName = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[a-z0-9_.:-]+$")]


class FigureCondition(BaseModel):
    """A figure is above a limit, or below one, for some seconds on end."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: FigureName
    above: Number | None = None
    below: Number | None = None
    for_s: Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)] = 0.0

    @model_validator(mode="after")
    def _one_limit(self) -> Self:
        if (self.above is None) == (self.below is None):
            raise ValueError("give above or below, and not both")
        return self

    def __str__(self) -> str:
        side, limit = ("below", self.below) if self.above is None else ("above", self.above)
        return f"{self.name} {side} {limit:g} for {self.for_s:g} s"


class GuardCondition(BaseModel):
    """Take the change back if a figure is beyond a limit for some seconds on end."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    figure: FigureName
    above: Number | None = None
    below: Number | None = None
    for_s: Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)] = 0.0
    within_s: Annotated[
        float,
        Field(gt=0.0, le=7 * 86_400.0, description="Watch for this time after the change."),
    ] = 3600.0

    @model_validator(mode="after")
    def _one_limit(self) -> Self:
        _ = self.condition
        return self

    @property
    def condition(self) -> FigureCondition:
        """The condition under which the change is taken back."""
        return FigureCondition(
            name=self.figure, above=self.above, below=self.below, for_s=self.for_s
        )
