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
from esplanade.protocol.commands.conditions import FigureCondition, GuardCondition
from esplanade.protocol.commands.fields import NO_NUL, ZONE, full_id
from esplanade.protocol.commands.groups import SetGroup
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
from esplanade.protocol.commands.presets import ApplyPreset, DeletePreset, SavePreset
from esplanade.protocol.commands.schedules import CancelSchedule, Mark, ScheduleCommands
from esplanade.protocol.commands.world import MoveDoor, Pace, Record

__all__ = [
    "COMMAND",
    "MOST_COMMANDS",
    "NO_NUL",
    "ZONE",
    "AddActors",
    "Announce",
    "Answer",
    "ApplyPreset",
    "Ban",
    "CancelSchedule",
    "ClearParameters",
    "Command",
    "CommandFault",
    "Commands",
    "DeletePreset",
    "Facts",
    "FigureCondition",
    "GuardCondition",
    "HideLine",
    "HoldActor",
    "Kick",
    "Mark",
    "MoveDoor",
    "Mute",
    "NewActor",
    "Pace",
    "Price",
    "QuietZone",
    "Record",
    "RemoveActors",
    "Revert",
    "SavePreset",
    "ScheduleCommands",
    "SendActor",
    "SetBehaviour",
    "SetGroup",
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
    | Pace
    | Record
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
    | Revert
    | ApplyPreset
    | SavePreset
    | DeletePreset
    | SetGroup
    | ScheduleCommands
    | CancelSchedule
    | Mark,
    Field(discriminator="op"),
]
COMMAND: TypeAdapter[Command] = TypeAdapter(Command)
"""Reads and checks one."""
Commands = Annotated[list[Command], Field(min_length=1, max_length=MOST_COMMANDS)]
