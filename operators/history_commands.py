"""The parts of `esplanade op` about what was changed: `changes` and `diff`."""

import json
from argparse import Namespace
from typing import Any
from urllib.parse import quote

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.output import console
from esplanade.operators.asking import asked, in_words
from esplanade.operators.times import at_time


def changes_(options: Namespace) -> int:
    """List the latest changes."""
    found = asked(options, f"/changes?limit={options.limit}")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("change", "when", "who", "command", "what", "note", "undo")
    for each in found["changes"]:
        table.add_row(
            str(each["number"]),
            at_time(each["at_us"]),
            each["account"] or "",
            each["op"],
            "\n".join(_what(each)),
            each["note"] or "",
            _undo(each),
        )
    console().print(table)
    return exit_codes.OK


def diff_(options: Namespace) -> int:
    """Show all values that are set, or columns side by side."""
    if options.columns:
        return _columns(options)
    found = asked(options, "/parameters")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("scope", "parameter", "usually", "set to")
    for scope, values in sorted(found["scopes"].items()):
        for name, value in sorted(values.items()):
            table.add_row(scope, name, f"{found['defaults'][name]:g}", f"{value:g}")
    console().print(table)
    return exit_codes.OK


def _columns(options: Namespace) -> int:
    found = asked(options, f"/diff?columns={quote(','.join(options.columns))}")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("parameter", *found["columns"])
    for row in found["rows"]:
        if options.all or row["differs"]:
            values = ["" if value is None else f"{value:g}" for value in row["values"]]
            table.add_row(row["name"], *values)
    console().print(table)
    return exit_codes.OK


def _what(change: dict[str, Any]) -> list[str]:
    lines = [
        f"{subject} {field}: {_short(change['before'].get(subject, {}).get(field))}"
        f" -> {_short(value)}"
        for subject, fields in change["after"].items()
        for field, value in fields.items()
    ]
    return [*lines[:5], f"and {len(lines) - 5} more"] if len(lines) > 6 else lines


def _short(value: Any) -> str:
    text = in_words(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def _undo(change: dict[str, Any]) -> str:
    if change["reverted_by"] is not None:
        return f"taken back by {change['reverted_by']}"
    return "can be" if change["can_revert"] else ""
