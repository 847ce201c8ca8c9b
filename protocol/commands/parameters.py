"""Commands on parameters, and taking changes back."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

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
    change: Annotated[int, Field(ge=1)] | Literal["latest", "undone"] = Field(
        "latest",
        description="The change's number; `latest` is your own latest that is not taken back, "
        "`undone` the one that you took back last, which it makes anew.",
    )
