"""Commands on presets: values of parameters that have a name."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from esplanade.protocol.commands.conditions import GuardCondition
from esplanade.protocol.commands.fields import BaseCommand, Number, ParameterName, ScopeText

PRESET: Final = r"[a-z0-9][a-z0-9-]{0,31}"
PresetName = Annotated[str, Field(pattern=f"^{PRESET}$", description="Such as `timid`.")]
Version = Annotated[int, Field(ge=1, le=2**31 - 1)]


class ApplyPreset(BaseCommand):
    """Set the values of a preset in a scope."""

    op: Literal["apply_preset"]
    scope: ScopeText
    preset: PresetName
    version: Version | None = Field(None, description="None for the latest.")
    replace: bool = Field(
        False, description="Whether other values of the scope go; otherwise they stay beside."
    )
    guard: GuardCondition | None = None


class SavePreset(BaseCommand):
    """Keep values under a name, as its next version; `note` says what they are good for."""

    op: Literal["save_preset"]
    name: PresetName
    values: Annotated[dict[ParameterName, Number], Field(min_length=1, max_length=64)] | None = None
    from_scope: ScopeText | None = Field(
        None, description="Take the values that are set in this scope."
    )

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.values is None) == (self.from_scope is None):
            raise ValueError("give values or from_scope, and not both")
        return self


class DeletePreset(BaseCommand):
    """Forget what was saved under a name; a preset that came along with the server stays."""

    op: Literal["delete_preset"]
    name: PresetName
