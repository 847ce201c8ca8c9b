"""Commands of operators, the same for every way in: HTTP, the command line, Python, the audit."""

from typing import Annotated, Final

from pydantic import Field, TypeAdapter

from esplanade.protocol.commands.actors import (
    AddActors,
    HoldActor,
    NewActor,
    RemoveActors,
    SendActor,
    SetBehaviour,
)
from esplanade.protocol.commands.answers import Answer, CommandFault, Facts, Price
from esplanade.protocol.commands.fields import NO_NUL, ZONE, full_id
from esplanade.protocol.commands.parameters import ClearParameters, Revert, SetParameters
from esplanade.protocol.commands.people import (
    Announce,
    Ban,
    HideLine,
    Kick,
    Mute,
    QuietZone,
    SettleReport,
    SetWordFilter,
    SlowMode,
    Unban,
    WalkOut,
    Warn,
)
from esplanade.protocol.commands.world import MoveDoor

__all__ = [
    "COMMAND",
    "MOST_COMMANDS",
    "NO_NUL",
    "ZONE",
    "AddActors",
    "Announce",
    "Answer",
    "Ban",
    "ClearParameters",
    "Command",
    "CommandFault",
    "Commands",
    "Facts",
    "HideLine",
    "HoldActor",
    "Kick",
    "MoveDoor",
    "Mute",
    "NewActor",
    "Price",
    "QuietZone",
    "RemoveActors",
    "Revert",
    "SendActor",
    "SetBehaviour",
    "SetParameters",
    "SetWordFilter",
    "SettleReport",
    "SlowMode",
    "Unban",
    "WalkOut",
    "Warn",
    "full_id",
]

MOST_COMMANDS: Final = 64
"""A list has no more commands than this."""

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
    | Ban
    | HideLine
    | Kick
    | Mute
    | QuietZone
    | SetWordFilter
    | SettleReport
    | SlowMode
    | Unban
    | WalkOut
    | Warn
    | Revert,
    Field(discriminator="op"),
]
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)
"""Reads and checks one."""
Commands = Annotated[list[Command], Field(min_length=1, max_length=MOST_COMMANDS)]
