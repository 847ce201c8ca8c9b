"""Presets that come along with a server: those of the package, and those of a folder beside."""

from pathlib import Path
from typing import Final

from pydantic import ValidationError

from esplanade.actors import ActorParameters
from esplanade.protocol.preset_files import PresetFile, PresetFileError, read_preset

SHIPPED: Final = Path(__file__).resolve().parents[2] / "presets"
"""The folder of the presets that every server has."""


def read_presets(folder: Path | None) -> list[PresetFile]:
    """The presets of the package; those of a folder take the place of others of their name.

    Raises
    ------
    PresetFileError
        A file holds no preset, or values that actors cannot have; it names the file and the field.
    """
    found: dict[str, PresetFile] = {}
    for where in (SHIPPED, *([] if folder is None else [folder])):
        found |= _of_folder(where)
    return list(found.values())


def _of_folder(folder: Path) -> dict[str, PresetFile]:
    if not folder.is_dir():
        raise PresetFileError(f"{folder}: there is no such folder")
    found: dict[str, PresetFile] = {}
    paths = [path for path in sorted(folder.iterdir()) if path.suffix in {".toml", ".json"}]
    for path in paths:
        preset = read_preset(path)
        _check_values(path, preset)
        if preset.name in found:
            raise PresetFileError(f"{path}: name: another file has a preset {preset.name!r} too")
        found[preset.name] = preset
    return found


def _check_values(path: Path, preset: PresetFile) -> None:
    try:
        ActorParameters(**preset.values)
    except ValidationError as error:
        fault = error.errors()[0]
        where = ".".join(["values", *map(str, fault["loc"])])
        raise PresetFileError(f"{path}: {where}: {fault['msg']}") from None
