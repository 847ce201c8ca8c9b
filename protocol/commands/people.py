"""Commands on people."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from esplanade.protocol.commands.fields import NO_NUL, ActorRef, BaseCommand, Metres

Person = Annotated[
    int,
    Field(
        ge=1,
        le=0xFFFF_FFFF,
        description="The id of the person's avatar, also of one who has just left.",
    ),
]
Said = Annotated[str, Field(min_length=1, max_length=200, pattern=NO_NUL)]
"""Said to one person."""
Polygon = Annotated[tuple[tuple[Metres, Metres], ...], Field(min_length=3, max_length=64)]
_TEXT = frozenset({"text"})


class Announce(BaseCommand):
    """Say something to all people, or to those on a storey, in a polygon, or near an actor."""

    op: Literal["announce"]
    text: Annotated[str, Field(min_length=1, max_length=500, pattern=NO_NUL)]
    storey_m: Metres | None = Field(
        None, description="Only to people on the storey at this height."
    )
    polygon: Polygon | None = Field(None, description="Only to people inside: [[x, y], ...].")
    near_actor: ActorRef | None = Field(None, description="Only to people near this actor.")
    radius_m: Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False)] = 10.0

    @model_validator(mode="after")
    def _one_place(self) -> Announce:
        if self.near_actor is not None and (self.polygon or self.storey_m is not None):
            raise ValueError("near_actor goes with neither polygon nor storey_m")
        return self


class Warn(BaseCommand):
    """Say something to one person, as a warning."""

    op: Literal["warn"]
    private: ClassVar[frozenset[str]] = _TEXT
    person: Person
    text: Said


class Mute(BaseCommand):
    """Let nobody hear a person's chat for a time."""

    op: Literal["mute"]
    private: ClassVar[frozenset[str]] = _TEXT
    person: Person
    seconds: Annotated[float, Field(ge=0.0, le=86_400.0, allow_inf_nan=False)] = 600.0
    text: Said = "An operator has muted you for a while: nobody hears what you write."


class Kick(BaseCommand):
    """Send a person out, and say why."""

    op: Literal["kick"]
    private: ClassVar[frozenset[str]] = _TEXT
    person: Person
    text: Said = "An operator has asked you to leave."


class WalkOut(BaseCommand):
    """Let a person's avatar walk to a place of arrival, where the person leaves."""

    op: Literal["walk_out"]
    private: ClassVar[frozenset[str]] = _TEXT
    person: Person
    text: Said = "An operator has asked you to leave; your avatar walks to the way out."


class Ban(BaseCommand):
    """Let somebody in no more: a person who is here, or whoever has a name, address or token."""

    op: Literal["ban"]
    private: ClassVar[frozenset[str]] = frozenset(
        {"text", "name_pattern", "address", "token_digest"}
    )
    person: Person | None = None
    by: Annotated[
        tuple[Literal["token", "name", "address"], ...], Field(min_length=1, max_length=3)
    ] = Field(("token", "name"), description="How `person` is known again.")
    token_digest: Annotated[str, Field(pattern="^[0-9a-f]{64}$")] | None = Field(
        None, description="SHA-256 of a resume token, hexadecimal."
    )
    name_pattern: Annotated[str, Field(min_length=1, max_length=64, pattern=NO_NUL)] | None = Field(
        None, description="A name, and all that look alike; `*` stands for any characters."
    )
    address: Annotated[str, Field(min_length=2, max_length=64)] | None = Field(
        None, description="An address, or a range such as 192.0.2.0/24."
    )
    until_s: Annotated[float, Field(ge=0.0, le=1e11, allow_inf_nan=False)] | None = Field(
        None, description="When it ends, seconds since 1970; null for no end."
    )
    text: Said = "An operator has asked you to stay away for now."

    @model_validator(mode="after")
    def _somebody(self) -> Ban:
        given = (self.person, self.token_digest, self.name_pattern, self.address)
        if all(one is None for one in given):
            raise ValueError("give one of person, token_digest, name_pattern and address")
        return self


class Unban(BaseCommand):
    """Let a ban hold no more."""

    op: Literal["unban"]
    ban: Annotated[int, Field(ge=1, le=2**53, description="The ban's number.")]


class HideLine(BaseCommand):
    """Take a line of chat away from everybody who has it."""

    op: Literal["hide_line"]
    line: Annotated[int, Field(ge=1, le=2**53 - 1, description="The line's number.")]


class SlowMode(BaseCommand):
    """Let each person say one line in so many seconds; 0 ends it."""

    op: Literal["slow_mode"]
    seconds: Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)]


class SetWordFilter(BaseCommand):
    """Name the words that are not said here, in place of those before; none ends it."""

    op: Literal["word_filter"]
    words: Annotated[
        tuple[Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[^\x00\s]+$")], ...],
        Field(max_length=1000),
    ]
    action: Literal["mask", "refuse"] = Field(
        "mask", description="Whether a word is masked, or a line with it refused."
    )


class QuietZone(BaseCommand):
    """Let nobody be heard who stands in a polygon, or take such a zone away."""

    op: Literal["quiet_zone"]
    name: Annotated[str, Field(min_length=1, max_length=64, pattern=NO_NUL)]
    polygon: Polygon | None = None
    storey_m: Metres | None = Field(None, description="The height of its storey; null for all.")
    remove: bool = False

    @model_validator(mode="after")
    def _either(self) -> QuietZone:
        if self.remove == (self.polygon is not None):
            raise ValueError("give a polygon, or remove: true")
        return self


class SettleReport(BaseCommand):
    """Note that a report is done with; `note` says how."""

    op: Literal["settle_report"]
    report: Annotated[int, Field(ge=1, le=2**53, description="The report's number.")]
