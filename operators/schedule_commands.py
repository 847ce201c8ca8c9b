"""The parts of `esplanade op schedule`."""

import json
from argparse import Namespace
from typing import Any

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console
from esplanade.files.text import read_text
from esplanade.operators.asking import asked, change, scope_of
from esplanade.operators.times import at_time


def list_(options: Namespace) -> int:
    """List schedules and guards."""
    found = asked(options, "/schedules")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("schedule", "state", "when", "by", "commands", "changes", "faults")
    for each in found["schedules"]:
        commands = ", ".join(command["op"] for command in each["commands"])
        numbers = " ".join(map(str, each["changes"]))
        words = (each["id"], each["state"], _when(each), each["by"] or "", commands, numbers)
        table.add_row(*words, _faults(each))
    console().print(table)
    table = Table("guard", "state", "takes back if", "by", "changes", "faults")
    for each in found["guards"]:
        numbers = " ".join(map(str, each["changes"]))
        watched = _condition(each["condition"])
        table.add_row(each["id"], each["state"], watched, each["by"] or "", numbers, _faults(each))
    console().print(table)
    table = Table("figure", "now", "unit", "meaning")
    for each in found["figures"]:
        value = "" if each["value"] is None else f"{each['value']:g}"
        table.add_row(each["name"], value, each["unit"], each["text"])
    console().print(table)
    return exit_codes.OK


def add(options: Namespace) -> int:
    """Have commands carried out later."""
    return change(
        options,
        "schedule",
        commands=_commands(options),
        when=_occasion(options),
        again_after_s=options.again,
        guard=options.guard,
    )


def cancel(options: Namespace) -> int:
    """Let a schedule do nothing any more."""
    return change(options, "cancel_schedule", id=options.id)


def _commands(options: Namespace) -> list[dict[str, Any]]:
    commands: list[dict[str, Any]] = []
    scope = scope_of(options)
    if options.preset:
        commands.append({"op": "apply_preset", "scope": scope, "preset": options.preset})
    if options.values:
        values = dict(options.values)
        commands.append({"op": "set_parameters", "scope": scope, "values": values})
    if options.commands is not None:
        try:
            found = json.loads(read_text(options.commands))
        except ValueError as error:
            raise UsageError(f"--commands: {error}") from None
        commands += found if isinstance(found, list) else [found]
    if not commands:
        raise UsageError("give NAME=VALUE, --preset or --commands: what is to be done")
    return commands


def _occasion(options: Namespace) -> dict[str, Any]:
    if options.after is not None:
        return {"after_s": options.after}
    if options.at is not None:
        return {"at_time": options.at}
    if options.at_tick is not None:
        return {"at_tick": options.at_tick}
    return {"figure": options.when}


def _when(schedule: dict[str, Any]) -> str:
    if schedule["due_us"] is not None:
        return at_time(schedule["due_us"])
    if schedule["due_tick"] is not None:
        return f"tick {schedule['due_tick']}"
    return _condition(schedule["when"]["figure"])


def _condition(condition: dict[str, Any]) -> str:
    above = condition.get("above")
    sign, limit = ("<", condition["below"]) if above is None else (">", above)
    return f"{condition['name']} {sign} {limit:g} for {condition['for_s']:g} s"


def _faults(item: dict[str, Any]) -> str:
    return "; ".join(fault["text"] for fault in item["faults"])
