"""The parts of `esplanade op` about parameters: `get`, `set`, `clear`, `undo`, `redo`."""

import json
from argparse import Namespace
from typing import Any

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.output import console
from esplanade.operators.asking import asked, change, scope_of


def get_(options: Namespace) -> int:
    """Show one actor, or all."""
    found = asked(options, f"/actors/{options.actor}" if options.actor else "/actors")
    if options.json:
        print(json.dumps(found, indent=1))
    elif options.actor:
        _show_actor(found)
    else:
        table = Table("actor", "name", "behaviour", "tags", "groups", "does", "x", "y", "z")
        for each in found["actors"]:
            place = [f"{value:.2f}" for value in each.get("position", ())]
            does = "held" if each["held"] else each.get("reason", "")
            groups = " ".join(f"{purpose}:{name}" for purpose, name in each["groups"].items())
            words = (each["id"], each["name"], each["behaviour"], " ".join(each["tags"]), groups)
            table.add_row(*words, does, *place)
        console().print(table)
    return exit_codes.OK


def set_(options: Namespace) -> int:
    """Set parameters."""
    return change(
        options,
        "set_parameters",
        scope=scope_of(options),
        values=dict(options.values),
        if_revision=options.if_revision,
        over_s=options.over,
        guard=options.guard,
    )


def clear_(options: Namespace) -> int:
    """Take values of a scope away."""
    return change(options, "clear_parameters", scope=scope_of(options), names=options.names)


def undo_(options: Namespace) -> int:
    """Take a change back."""
    latest = "latest_of_all" if options.anybody else "latest"
    return change(options, "revert", change=options.change or latest)


def redo_(options: Namespace) -> int:
    """Make anew what was taken back."""
    return change(options, "revert", change="undone")


def _show_actor(found: dict[str, Any]) -> None:
    print(f"{found['id']} {found['name']}: {found['behaviour']['kind']}, {found.get('reason', '')}")
    table = Table("parameter", "value", "from")
    for name, source in found["parameters"].items():
        level = source["level"]
        table.add_row(name, f"{source['value']:g}", source["group"] or level)
    console().print(table)
