"""Scene files: read whole, or refused with every fault and its place in the file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

from pydantic import ValidationError

from esplanade.files.text import decoded
from esplanade.planning.scene.bounded_reading import read_bounded
from esplanade.planning.scene.faults import faults_of, spots_of
from esplanade.planning.scene.json_places import Path as Loc
from esplanade.planning.scene.json_places import Spot
from esplanade.planning.scene.scene import Scene

MAX_FILE_BYTES: Final = 16 * 2**20
"""A scene of as many parts as are possible has less."""

_GROUPS: Final = ("polygons", "walls", "stairs", "doors", "spawns", "places", "portals")


class SceneError(ValueError):
    """A scene file that cannot be read or is no scene; `faults` has one line for each fault.

    `spots` has the line and column of each fault in the file, where they are known.
    """

    def __init__(
        self, path: Path, faults: tuple[str, ...], spots: tuple[Spot | None, ...] = ()
    ) -> None:
        self.spots = spots or (None,) * len(faults)
        lines = []
        for fault, spot in zip(faults, self.spots, strict=True):
            where = f"{path}:{spot[0]}:{spot[1]}" if spot else f"{path}"
            lines.append(f"{where}: {fault}")
        super().__init__("\n".join(lines))
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
    data = read_bounded(path, MAX_FILE_BYTES)
    try:
        text = decoded(data).text
    except ValueError as error:
        raise SceneError(path, (str(error),)) from None
    try:
        scene = Scene.model_validate_json(text)
    except ValidationError as error:
        faults = _all_faults(text, error)
        raise SceneError(path, tuple(faults), spots_of(text, faults.values())) from None
    if scene.mesh is None:
        return scene
    mesh = path.parent / scene.mesh
    if not mesh.is_file():
        fault = f"mesh: there is no file {mesh}"
        raise SceneError(path, (fault,), spots_of(text, [("mesh",)]))
    return scene.model_copy(update={"mesh": mesh})


def _all_faults(text: str, error: ValidationError) -> dict[str, Loc]:
    """Every fault with its path: those of parts, and those of how the sound parts fit together.

    The second are looked for in a scene without the parts that are at fault.
    """
    faults = faults_of(error)
    wrong = {path for path in faults.values() if path}
    if not wrong:
        return faults
    content = json.loads(text)
    kept: dict[str, list[int]] = {}
    for group in {path[0] for path in wrong}:
        parts = content.get(group)
        places = {path[1] for path in wrong if path[0] == group and len(path) > 1}
        if isinstance(parts, list) and places and group in _GROUPS:
            kept[group] = [i for i in range(len(parts)) if i not in places]
            content[group] = [parts[i] for i in kept[group]]
        elif group in content and group != "bounds":
            del content[group]
    try:
        Scene.model_validate(content)
    except ValidationError as further:
        for fault, path in faults_of(further).items():
            if path and path[0] not in ("bounds", ""):
                faults.setdefault(*_renumbered(fault, path, kept))
    return faults


def _renumbered(fault: str, path: Loc, kept: dict[str, list[int]]) -> tuple[str, Loc]:
    """A fault of a part with the number that it has in the file."""
    if len(path) < 2 or path[0] not in kept or not isinstance(path[1], int):
        return fault, path
    number = kept[path[0]][path[1]]
    group = path[0]
    return fault.replace(f"{group}.{path[1]}", f"{group}.{number}", 1), (group, number, *path[2:])


def scene_faults(error: ValidationError) -> tuple[str, ...]:
    """One line for each fault, as `polygons.3.height_m: must be > 0, got -1`."""
    return tuple(faults_of(error))
