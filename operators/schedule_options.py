"""The options of `esplanade op schedule`."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, Span, Text, Whole
from esplanade.operators.parts import (
    add_family,
    add_json,
    add_note,
    add_part,
    add_scope,
    assignment,
)
from esplanade.operators.scopes import condition, guard


def add_schedule_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    schedules = add_family(
        commands, "schedule", "Schedules: commands that the server carries out later, by itself."
    )
    listed = add_part(
        schedules,
        "schedule_commands:list_",
        "list",
        "List schedules, guards, and the figures that conditions may name.",
    )
    add_json(listed)
    cancel = add_part(
        schedules, "schedule_commands:cancel", "cancel", "Let a schedule do nothing any more."
    )
    cancel.add_argument("id", metavar="ID", type=Text(), help="such as s12")
    add_note(cancel)
    return [_add(schedules), listed, cancel]


def _add(schedules: "SubParsers[Parser]") -> Parser:
    made = add_part(
        schedules,
        "schedule_commands:add",
        "add",
        "Set values or apply a preset later, or carry out commands from a file.",
        "schedule add --in 10m --preset rush-hour --again 30m",
        "schedule add --at 18:00 speed_mps=1.1 --group kind:hurried",
        "schedule add --when 'people>40/30s' --preset courteous",
        "schedule add --at-tick 120000 --commands list.json",
        more="The server does it with the rights that your account has then. What it missed while\n"
        "it did not run is told by `schedule list`, and not made up for. Times are in UTC.",
    )
    made.add_argument(
        "values", metavar="NAME=VALUE", nargs="*", type=assignment, help="such as risk_weight=12"
    )
    made.add_argument("--preset", metavar="NAME", type=Text(), help="a preset to apply")
    made.add_argument(
        "--commands", metavar="FILE", type=InputFile(), help="a list of commands, as JSON"
    )
    add_scope(made)
    when = made.add_mutually_exclusive_group(required=True)
    when.add_argument("--in", dest="after", metavar="SPAN", type=Span(), help="after this time")
    when.add_argument(
        "--at", metavar="TIME", type=Text(), help="18:30, or a moment as 2026-05-01T18:00:00Z"
    )
    when.add_argument("--at-tick", metavar="N", type=Whole(1), help="from this tick on")
    when.add_argument(
        "--when",
        metavar="CONDITION",
        type=condition,
        help="when a figure is beyond a limit, such as people>40 or contacts_per_minute>3/10s",
    )
    made.add_argument("--again", metavar="SPAN", type=Span(), help="take it back after this time")
    made.add_argument(
        "--guard", metavar="CONDITION", type=guard, help="take it back if this holds afterwards"
    )
    add_note(made)
    return made
