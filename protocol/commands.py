"""Commands of operators, the same for every way in: HTTP, the command line, Python, the audit."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, TypeAdapter

ZONE: Final = "main"
"""The zone of an actor whose id names none."""
MOST_COMMANDS: Final = 64
"""A list has no more commands than this."""
MOST_NEW: Final = 200
"""One command adds no more actors than this."""
_ACTOR: Final = r"[a-z0-9][a-z0-9-]{0,31}/[a-z0-9][a-z0-9._-]{0,47}"
_TAG: Final = r"[a-z0-9][a-z0-9-]{0,31}"


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
    Field(pattern=f"^{_ACTOR}$", description="An actor: `main/actor-3`, or `actor-3` for short."),
]
ScopeText = Annotated[
    str,
    BeforeValidator(_full_scope),
    Field(
        pattern=f"^(world|group:{_TAG}|actor:{_ACTOR})$",
        description="Where values hold: `world`, `group:TAG` or `actor:ID`.",
    ),
]


def _all_different(actors: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(actors)) < len(actors):
        raise ValueError("an actor is named twice")
    return actors


Actors = Annotated[
    tuple[ActorRef, ...], Field(min_length=1, max_length=500), AfterValidator(_all_different)
]
NO_NUL: Final = r"^[^\x00]*$"
"""Databases keep no text with a null character in it."""
ParameterName = Annotated[str, Field(min_length=1, max_length=64)]
Number = Annotated[float, Field(allow_inf_nan=False)]
Metres = Annotated[float, Field(allow_inf_nan=False, ge=-100_000.0, le=100_000.0)]
Place = Annotated[str, Field(min_length=1, max_length=64, pattern=NO_NUL)]


class _Command(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")

    dry_run: bool = Field(False, description="Check it, and tell its price; change nothing.")
    note: Annotated[str, Field(max_length=500, pattern=NO_NUL)] | None = Field(
        None, description="Why: it is kept in the audit."
    )


class SetParameters(_Command):
    """Set values in a scope, beside those that are there."""

    op: Literal["set_parameters"]
    scope: ScopeText
    values: Annotated[dict[ParameterName, Number], Field(min_length=1, max_length=64)]
    if_revision: int | None = Field(
        None,
        ge=0,
        description="Refuse it if one of these parameters was set or cleared after that revision.",
    )


class ClearParameters(_Command):
    """Take values of a scope away, so that those of wider scopes show again."""

    op: Literal["clear_parameters"]
    scope: ScopeText
    names: Annotated[tuple[ParameterName, ...], Field(max_length=64)] = Field(
        (), description="None of them means all that the scope has."
    )
    if_revision: int | None = Field(None, ge=0)


class SetBehaviour(_Command):
    """Let actors do something else from now on."""

    op: Literal["set_behaviour"]
    actors: Actors
    behaviour: dict[str, Any] = Field(
        description="One of `behaviours` in /api/v1/schema, by its `kind`."
    )


class SendActor(_Command):
    """Send an actor to a place of the scene or to a point, where it stays."""

    op: Literal["send_actor"]
    actor: ActorRef
    target: Place | tuple[Metres, Metres, Metres]


class HoldActor(_Command):
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


class AddActors(_Command):
    """Let actors come into the world: all of them, or none."""

    op: Literal["add_actors"]
    actors: Annotated[tuple[NewActor, ...], Field(min_length=1, max_length=MOST_NEW)]


class RemoveActors(_Command):
    """Take actors out of the world: all of them, or none."""

    op: Literal["remove_actors"]
    actors: Actors


class MoveDoor(_Command):
    """Open or close a door, once nobody stands in its way."""

    op: Literal["move_door"]
    door: Place
    open: bool


class Revert(_Command):
    """Take a change back: a new change, whose values are those from before it.

    It is refused if somebody has changed one of them since.
    """

    op: Literal["revert"]
    change: Annotated[int, Field(ge=1)] | Literal["latest", "undone"] = Field(
        "latest",
        description="The change's number; `latest` is your own latest that is not taken back, "
        "`undone` the one that you took back last, which it makes anew.",
    )


class Announce(_Command):
    """Say something to all people."""

    op: Literal["announce"]
    text: Annotated[str, Field(min_length=1, max_length=500, pattern=NO_NUL)]


class Mute(_Command):
    """Let nobody hear a person's chat for a time."""

    op: Literal["mute"]
    person: Annotated[int, Field(ge=1, description="The id of the person's avatar.")]
    seconds: Annotated[float, Field(ge=0.0, le=86_400.0, allow_inf_nan=False)] = 600.0
    text: Annotated[str, Field(min_length=1, max_length=200, pattern=NO_NUL)] = (
        "An operator has muted you for a while: nobody hears what you write."
    )


class Kick(_Command):
    """Send a person out, and say why."""

    op: Literal["kick"]
    person: Annotated[int, Field(ge=1, description="The id of the person's avatar.")]
    text: Annotated[str, Field(min_length=1, max_length=200, pattern=NO_NUL)] = (
        "An operator has asked you to leave."
    )


Command = Annotated[
    SetParameters
    | ClearParameters
    | SetBehaviour
    | SendActor
    | HoldActor
    | AddActors
    | RemoveActors
    | MoveDoor
    | Announce
    | Mute
    | Kick
    | Revert,
    Field(discriminator="op"),
]
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)
"""Reads and checks one."""
Commands = Annotated[list[Command], Field(min_length=1, max_length=MOST_COMMANDS)]

Facts = dict[str, dict[str, Any]]
"""Fields of subjects: `{"world": {"risk_weight": 12}, "door:lobby": {"open": true}}`. None stands
for what is not set, or not there."""


Price = Literal["tick", "prepared"]
"""Whether a command is done in a tick, or something has to be prepared before."""


class CommandFault(BaseModel):
    """Why nothing was done; `text` says it to people, the rest to programs."""

    code: str
    text: str
    path: list[str | int] = Field([], description="Where in the command, or the list of commands.")
    arguments: dict[str, Any] = {}


class Answer(BaseModel):
    """The answer to a command: the change that it made, and its tick."""

    op: str
    command: int | None = Field(
        None, description="Its number, which is that of its row in the audit; None without one."
    )
    tick: int | None = Field(None, description="The tick in which it took effect.")
    revision: int = Field(description="The number of the latest change that was made.")
    before: Facts = {}
    after: Facts = {}
    price: Price = Field(
        "tick", description="Whether it is done in a tick, or something has to be prepared before."
    )
    shadowed: dict[str, int] = Field(
        {}, description="How many narrower scopes have a value of their own, by parameter."
    )
    faults: list[CommandFault] = []
