"""The parts of `esplanade op preset`."""

import json
from argparse import Namespace
from pathlib import Path
from typing import Any

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.commandline.output import console
from esplanade.operators.asking import asked, change, change_all, scope_of
from esplanade.protocol.preset_files import (
    PresetFile,
    PresetFileError,
    as_json,
    as_toml,
    read_preset,
)


def list_(options: Namespace) -> int:
    """List all presets."""
    found = asked(options, "/presets")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("preset", "version", "by", "note")
    for each in found["presets"]:
        by = "came along" if each["shipped"] else each["by"] or ""
        table.add_row(each["name"], str(each["version"]), by, each["note"] or "")
    console().print(table)
    return exit_codes.OK


def show(options: Namespace) -> int:
    """Show the values of a preset."""
    found = _preset(options)
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    usual = asked(options, "/parameters")["defaults"]
    print(f"{found['name']}, version {found['version']}: {found['note'] or ''}")
    table = Table("parameter", "usually", "value")
    for name, value in sorted(found["values"].items()):
        table.add_row(name, f"{usual[name]:g}", f"{value:g}")
    console().print(table)
    return exit_codes.OK


def apply(options: Namespace) -> int:
    """Set the values of a preset in a scope."""
    return change(
        options,
        "apply_preset",
        scope=scope_of(options),
        preset=options.name,
        version=options.version,
        replace=options.replace,
        guard=options.guard,
    )


def save(options: Namespace) -> int:
    """Keep values under a name."""
    if bool(options.values) == bool(options.from_scope):
        raise UsageError("give NAME=VALUE, or --from, and not both")
    values = dict(options.values) or None
    return change(
        options, "save_preset", name=options.name, values=values, from_scope=options.from_scope
    )


def delete(options: Namespace) -> int:
    """Forget what was saved under a name."""
    return change(options, "delete_preset", name=options.name)


def export(options: Namespace) -> int:
    """Write a preset to a file, or to the standard output."""
    found = _preset(options)
    preset = PresetFile(**{name: found[name] for name in ("name", "version", "note", "values")})
    path: Path | None = options.out
    text = as_json(preset) if path is not None and path.suffix == ".json" else as_toml(preset)
    if path is None:
        print(text, end="")
        return exit_codes.OK
    if path.suffix not in {".json", ".toml"}:
        raise UsageError("--out: the file's name must end in .toml or .json")
    try:
        path.write_text(text)
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    print(f"{path}: {preset.name}, version {preset.version}")
    return exit_codes.OK


def import_(options: Namespace) -> int:
    """Save presets from files."""
    try:
        presets = [read_preset(path) for path in options.files]
    except PresetFileError as error:
        raise CommandError(str(error)) from None
    commands = [{"op": "save_preset", "name": one.name, "values": one.values} for one in presets]
    if options.note is None and len(presets) == 1:
        options.note = presets[0].note
    return change_all(options, commands)


def _preset(options: Namespace) -> dict[str, Any]:
    version = "" if options.version is None else f"?version={options.version}"
    return dict(asked(options, f"/presets/{options.name}{version}"))
