"""Commands on parameters, and taking changes back."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from esplanade.protocol.commands.conditions import GuardCondition
from esplanade.protocol.commands.fields import BaseCommand, Number, ParameterName, ScopeText


class SetParameters(BaseCommand):
    """Set values in a scope, beside those that are there."""

    op: Literal["set_parameters"]
    scope: ScopeText
    values: Annotated[dict[ParameterName, Number], Field(min_length=1, max_length=64)]
    if_revision: int | None = Field(
        None,
        ge=0,
        description="Refuse it if one of these parameters was set or cleared after that revision.",
    )
    over_s: Annotated[float, Field(gt=0.0, le=3600.0, allow_inf_nan=False)] | None = Field(
        None, description="Go there evenly over this time, from the values that hold now."
    )
    guard: GuardCondition | None = None
    stream: bool = Field(
        False,
        description="One of many values of a slider that is dragged: those that come within two "
        "seconds of each other are one change, with the values before the first and after the "
        "last.",
    )

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if self.stream and (self.over_s is not None or self.guard is not None):
            raise ValueError("a stream has no over_s and no guard")
        return self


class ClearParameters(BaseCommand):
    """Take values of a scope away, so that those of wider scopes show again."""

    op: Literal["clear_parameters"]
    scope: ScopeText
    names: Annotated[tuple[ParameterName, ...], Field(max_length=64)] = Field(
        (), description="None of them means all that the scope has."
    )
    if_revision: int | None = Field(None, ge=0)


class Revert(BaseCommand):
    """Take a change back: a new change, whose values are those from before it.

    It is refused if somebody has changed one of them since.
    """

    op: Literal["revert"]
    change: Annotated[int, Field(ge=1)] | Literal["latest", "undone", "latest_of_all"] = Field(
        "latest",
        description="The change's number; `latest` is your own latest that is not taken back, "
        "`undone` the one that you took back last, which it makes anew, `latest_of_all` the latest "
        "that anybody has made.",
    )
