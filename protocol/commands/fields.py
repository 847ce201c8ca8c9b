"""Types of the fields that commands have in common."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

ZONE: Final = "main"
"""The zone of an actor whose id names none."""
ACTOR: Final = r"[a-z0-9][a-z0-9-]{0,31}/[a-z0-9][a-z0-9._-]{0,47}"
TAG: Final = r"[a-z0-9][a-z0-9-]{0,31}"


def full_id(text: object) -> object:
    """An actor's id with its zone; a name alone means one of the zone `main`."""
    return f"{ZONE}/{text}" if isinstance(text, str) and "/" not in text else text


def _full_scope(text: object) -> object:
    if isinstance(text, str) and text.startswith("actor:"):
        return f"actor:{full_id(text.removeprefix('actor:'))}"
    return text


ActorRef = Annotated[
    str,
    BeforeValidator(full_id),
    Field(pattern=f"^{ACTOR}$", description="An actor: `main/actor-3`, or `actor-3` for short."),
]
ScopeText = Annotated[
    str,
    BeforeValidator(_full_scope),
    Field(
        pattern=f"^(world|group:{TAG}(:{TAG})?|actor:{ACTOR})$",
        description="Where values hold: `world`, `group:TAG`, `group:PURPOSE:NAME` or `actor:ID`.",
    ),
]


def all_different(actors: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(actors)) < len(actors):
        raise ValueError("an actor is named twice")
    return actors


Actors = Annotated[
    tuple[ActorRef, ...], Field(min_length=1, max_length=500), AfterValidator(all_different)
]
NO_NUL: Final = r"^[^\x00]*$"
"""Databases keep no text with a null character in it."""
ParameterName = Annotated[str, Field(min_length=1, max_length=64)]
Number = Annotated[float, Field(allow_inf_nan=False)]
Metres = Annotated[float, Field(allow_inf_nan=False, ge=-100_000.0, le=100_000.0)]
Place = Annotated[str, Field(min_length=1, max_length=64, pattern=NO_NUL)]


class BaseCommand(BaseModel):
    """The fields of every command."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    private: ClassVar[frozenset[str]] = frozenset()
    """Fields that may speak of a person: the audit keeps them where they can be forgotten."""

    dry_run: bool = Field(False, description="Check it, and tell its price; change nothing.")
    note: Annotated[str, Field(max_length=500, pattern=NO_NUL)] | None = Field(
        None, description="Why: it is kept in the audit."
    )
