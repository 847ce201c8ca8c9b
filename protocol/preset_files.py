"""Files of presets: values of parameters under a name, as TOML or JSON."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from esplanade.files.text import read_text
from esplanade.protocol.commands.fields import NO_NUL, Number, ParameterName
from esplanade.protocol.commands.presets import PresetName, Version


class PresetFileError(ValueError):
    """A file that holds no preset; the message names the file and the field."""


class PresetFile(BaseModel):
    """A preset as it stands in a file."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: PresetName
    version: Version = 1
    note: Annotated[str, Field(max_length=500, pattern=NO_NUL)] | None = None
    values: Annotated[dict[ParameterName, Number], Field(min_length=1, max_length=64)]


def read_preset(path: Path) -> PresetFile:
    """Read a preset from a file, whose name ends in .toml or .json.

    Raises
    ------
    PresetFileError
        The file cannot be read, or holds no preset.
    """
    try:
        text = read_text(path)
        found: Any = json.loads(text) if path.suffix == ".json" else tomllib.loads(text)
    except ValueError as error:
        raise PresetFileError(f"{path}: {error}") from None
    try:
        return PresetFile.model_validate(found)
    except ValidationError as error:
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise PresetFileError(f"{path}: {where + ': ' if where else ''}{fault['msg']}") from None


def as_toml(preset: PresetFile) -> str:
    """Return a preset as TOML, its values in the order of their names."""
    lines = [f"name = {json.dumps(preset.name)}", f"version = {preset.version}"]
    if preset.note is not None:
        lines.append(f"note = {_quoted(preset.note)}")
    return "\n".join([*lines, "", "[values]", *_assignments(preset.values), ""])


def as_json(preset: PresetFile) -> str:
    """Return a preset as JSON."""
    found = preset.model_dump(mode="json", exclude_none=True)
    return (
        json.dumps({**found, "values": _plain(preset.values)}, indent=1, ensure_ascii=False) + "\n"
    )


def _assignments(values: Mapping[str, float]) -> list[str]:
    return [f"{name} = {value}" for name, value in sorted(_plain(values).items())]


def _plain(values: Mapping[str, float]) -> dict[str, float | int]:
    """Whole numbers without a point, as people write them."""
    return {
        name: int(value) if float(value).is_integer() else value for name, value in values.items()
    }


def _quoted(text: str) -> str:
    """A basic string of TOML: that of JSON, but for characters that TOML wants escaped."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
