"""Commands on people."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from esplanade.protocol.commands.fields import NO_NUL, BaseCommand


class Announce(BaseCommand):
    """Say something to all people."""

    op: Literal["announce"]
    text: Annotated[str, Field(min_length=1, max_length=500, pattern=NO_NUL)]


class Mute(BaseCommand):
    """Let nobody hear a person's chat for a time."""

    op: Literal["mute"]
    person: Annotated[int, Field(ge=1, description="The id of the person's avatar.")]
    seconds: Annotated[float, Field(ge=0.0, le=86_400.0, allow_inf_nan=False)] = 600.0
    text: Annotated[str, Field(min_length=1, max_length=200, pattern=NO_NUL)] = (
        "An operator has muted you for a while: nobody hears what you write."
    )


class Kick(BaseCommand):
    """Send a person out, and say why."""

    op: Literal["kick"]
    person: Annotated[int, Field(ge=1, description="The id of the person's avatar.")]
    text: Annotated[str, Field(min_length=1, max_length=200, pattern=NO_NUL)] = (
        "An operator has asked you to leave."
    )
