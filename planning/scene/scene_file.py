"""Scene files: read whole, or refused with every fault and its place in the file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from esplanade.files.content import ContentError
from esplanade.files.text import decoded
from esplanade.planning.scene.bounded_reading import read_bounded
from esplanade.planning.scene.scene import Scene

MAX_FILE_BYTES: Final = 16 * 2**20
"""A scene of as many parts as are possible has less."""

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


class SceneError(ValueError):
    """A scene file that cannot be read or is no scene; `faults` has one line for each fault."""

    def __init__(self, path: Path, faults: tuple[str, ...]) -> None:
        super().__init__("\n".join(f"{path}: {fault}" for fault in faults))
        self.path = path
        self.faults = faults


def read_scene(path: Path) -> Scene:
    """The scene that a file holds; its mesh is looked for beside the file.

    Raises
    ------
    OSError
        The file cannot be read, or has more than `MAX_FILE_BYTES`.
    SceneError
        It holds no scene, or names a mesh that is not there.
    """
    try:
        scene = Scene.model_validate_json(decoded(read_bounded(path, MAX_FILE_BYTES)).text)
    except ContentError as error:
        raise SceneError(path, (str(error),)) from None
    except ValidationError as error:
        raise SceneError(path, scene_faults(error)) from None
    if scene.mesh is None:
        return scene
    mesh = path.parent / scene.mesh
    if not mesh.is_file():
        raise SceneError(path, (f"mesh: there is no file {mesh}",))
    return scene.model_copy(update={"mesh": mesh})


def scene_faults(error: ValidationError) -> tuple[str, ...]:
    """One line for each fault, as `polygons.3.height_m: must be > 0, got -1`."""
    faults = []
    for fault in error.errors(include_url=False):
        where = ".".join(str(part) for part in fault["loc"])
        text = _phrase(fault)
        faults.append(f"{where}: {text}" if where else text)
    return tuple(faults)


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
