"""The parts of `esplanade op` that ask a server that runs: `get`, `set`, `undo` and others."""

import json
from argparse import Namespace
from typing import Any

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError
from esplanade.commandline.output import console
from esplanade.operators.client import scope_text
from esplanade.operators.errors import OperatorError
from esplanade.operators.http import ask


def get_(options: Namespace) -> int:
    """Show one actor, or all."""
    found = _asked(options, f"/actors/{options.actor}" if options.actor else "/actors")
    if options.json:
        print(json.dumps(found, indent=1))
    elif options.actor:
        _show_actor(found)
    else:
        table = Table("actor", "name", "behaviour", "tags", "does", "x", "y", "z")
        for each in found["actors"]:
            place = [f"{value:.2f}" for value in each.get("position", ())]
            does = "held" if each["held"] else each.get("reason", "")
            words = (each["id"], each["name"], each["behaviour"], " ".join(each["tags"]), does)
            table.add_row(*words, *place)
        console().print(table)
    return exit_codes.OK


def set_(options: Namespace) -> int:
    """Set parameters."""
    more = {"values": dict(options.values), "if_revision": options.if_revision}
    return _change(options, "set_parameters", scope=_scope(options), **more)


def clear_(options: Namespace) -> int:
    """Take values of a scope away."""
    return _change(options, "clear_parameters", scope=_scope(options), names=options.names)


def undo_(options: Namespace) -> int:
    """Take a change back."""
    return _change(options, "revert", change=options.change or "latest")


def redo_(options: Namespace) -> int:
    """Make anew what was taken back."""
    return _change(options, "revert", change="undone")


def diff_(options: Namespace) -> int:
    """Show all values that are set."""
    found = _asked(options, "/parameters")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("scope", "parameter", "usually", "set to")
    for scope, values in sorted(found["scopes"].items()):
        for name, value in sorted(values.items()):
            table.add_row(scope, name, f"{found['defaults'][name]:g}", f"{value:g}")
    console().print(table)
    return exit_codes.OK


def _asked(options: Namespace, path: str, body: Any = None) -> Any:
    try:
        return ask(options.url, options.token, path, body)
    except OperatorError as error:
        raise CommandError(str(error)) from None


def _scope(options: Namespace) -> str:
    return scope_text(options.group, options.actor)


def _change(options: Namespace, op: str, **command: Any) -> int:
    body = {"op": op, "note": options.note, "dry_run": options.dry_run, **command}
    answer = _asked(options, "/commands", body)
    for subject, fields in answer["after"].items():
        for field, value in fields.items():
            before = answer["before"][subject][field]
            print(f"{subject} {field}: {_value(before)} -> {_value(value)}")
    for name, count in answer["shadowed"].items():
        print(f"{name}: {count} narrower scopes have a value of their own, and keep it")
    if options.dry_run:
        prices = {"tick": "at once", "prepared": "once the ground is prepared for other bodies"}
        print(f"nothing was changed; it would be, {prices[answer['price']]}")
    else:
        print(f"change {answer['command']}, tick {answer['tick']}")
    return exit_codes.OK


def _show_actor(found: dict[str, Any]) -> None:
    print(f"{found['id']} {found['name']}: {found['behaviour']['kind']}, {found.get('reason', '')}")
    table = Table("parameter", "value", "from")
    for name, source in found["parameters"].items():
        level = source["level"]
        table.add_row(name, f"{source['value']:g}", source["group"] or level)
    console().print(table)


def _value(value: Any) -> str:
    return "not set" if value is None else json.dumps(value)
