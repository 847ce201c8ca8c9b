"""The parts of `esplanade op group`."""

import json
from argparse import Namespace

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.output import console
from esplanade.operators.asking import asked, change


def list_(options: Namespace) -> int:
    """List all groups."""
    found = asked(options, "/groups")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("group", "purpose", "actors")
    for each in found["groups"]:
        table.add_row(each["group"], each["purpose"] or "tag", " ".join(each["actors"]))
    console().print(table)
    return exit_codes.OK


def set_(options: Namespace) -> int:
    """Put actors into a group."""
    return change(options, "set_group", group=options.name, actors=options.actors)


def remove(options: Namespace) -> int:
    """Take actors out of a group."""
    return change(options, "set_group", group=options.name, actors=options.actors, remove=True)
