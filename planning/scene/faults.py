"""Faults of files that hands write: words for them, and their places in the text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from pydantic import ValidationError

from esplanade.planning.scene.json_places import Path, Spot, find_places

_PHRASES: Final = {
    "greater_than": "must be > {gt:g}",
    "greater_than_equal": "must be >= {ge:g}",
    "less_than": "must be < {lt:g}",
    "less_than_equal": "must be <= {le:g}",
    "finite_number": "must be finite",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "int_type": "must be a whole number",
    "int_parsing": "must be a whole number",
    "int_from_float": "must be a whole number",
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "string_type": "must be a text",
    "tuple_type": "must be a list",
    "model_type": "must be an object",
    "literal_error": "must be {expected}",
    "string_too_long": "must have at most {max_length} characters",
    "string_too_short": "must not be empty",
    "string_pattern_mismatch": "must match {pattern}",
    "too_short": "needs at least {min_length} of them, got {actual_length}",
    "too_long": "must have at most {max_length} of them",
    "missing": "is missing",
    "extra_forbidden": "there is no such key",
    "json_invalid": "is no JSON: {error}",
}
"""Words for the faults that hands make; all other faults keep pydantic's words."""
_TOLD: Final = frozenset(
    ("value_error", "missing", "extra_forbidden", "json_invalid", "too_short", "string_too_short")
)
"""Faults whose words say all: the value found adds nothing."""


def faults_of(error: ValidationError) -> dict[str, Path]:
    """One line for each fault, as `polygons.3.height_m: must be > 0, got -1`, and its path."""
    faults: dict[str, Path] = {}
    for fault in error.errors(include_url=False):
        path = fault["loc"]
        for text in _phrase(fault).split("\n"):
            if path:
                faults[f"{'.'.join(map(str, path))}: {text}"] = path
            else:
                faults[text] = _path_in(text)
    return faults


def _path_in(text: str) -> Path:
    """The path that a fault of the whole scene begins with, as `spawns.0: ...`."""
    head, found, _ = text.partition(": ")
    if not found or " " in head:
        return ()
    return tuple(int(step) if step.isdecimal() else step for step in head.split("."))


def _phrase(fault: Any) -> str:
    kind, found = fault["type"], fault["input"]
    phrase = _PHRASES.get(kind)
    if phrase is not None:
        text = phrase.format(**fault.get("ctx", {}))
    else:
        text = fault["msg"].removeprefix("Value error, ").removeprefix("Input ")
    return text if kind in _TOLD or not _short(found) else f"{text}, got {_short(found)}"


def _short(found: Any) -> str:
    """A value as it stands in the file; nothing for whole lists and objects."""
    match found:
        case bool():
            return str(found).lower()
        case int() | float():
            return f"{found:g}"
        case str():
            return repr(found if len(found) <= 40 else found[:39] + "…")
    return ""


def spots_of(text: str, paths: Iterable[Path]) -> tuple[Spot | None, ...]:
    """The line and column of each path in a JSON text; None for all where they cannot be told."""
    paths = list(paths)
    try:
        found = find_places(text, paths)
    except (ValueError, IndexError, RecursionError):
        return (None,) * len(paths)
    return tuple(found[path] for path in paths)
