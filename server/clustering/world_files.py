"""The files of a world as they are carried to other machines."""

import tempfile
from pathlib import Path
from typing import Final

from esplanade.planning.scene.bounded_reading import read_bounded
from esplanade.planning.scene.mesh_file import MeshError, read_triangles
from esplanade.planning.scene.world_file import World

MOST_BYTES: Final = 64 * 1024 * 1024
"""No larger file of a scene is taken in."""


class WorldFilesError(ValueError):
    """The files of a world cannot be carried to other machines; the message says which and why."""


def files_of(path: Path, world: World) -> dict[str, bytes]:
    """The bytes of a world's file, its scenes and their meshes, by their names relative to it.

    Raises
    ------
    OSError
        A file cannot be read, or is too large.
    WorldFilesError
        A scene or its mesh lies outside of the folder of the world's file, or a mesh is no whole
        one without other files beside it.
    """
    files = {path.name: read_bounded(path, MOST_BYTES)}
    for zone in world.file.zones:
        scene, mesh = world.paths[zone.name], world.scenes[zone.name].mesh
        for part in (scene,) if mesh is None else (scene, mesh):
            name = _name_within(path, part)
            if name is None:
                raise WorldFilesError(
                    f"zone {zone.name!r}: {part} is to lie in the folder of the world's file"
                )
            files[name] = read_bounded(part, MOST_BYTES)
            if part == mesh:
                _check_alone(zone.name, mesh, files[name])
    return files


def _name_within(path: Path, part: Path) -> str | None:
    """The name of a file in the folder of a world's file; None if it is not in there."""
    try:
        within = part.relative_to(path.parent)
    except ValueError:
        return None
    return None if ".." in within.parts or part == path else within.as_posix()


def _check_alone(zone: str, mesh: Path, content: bytes) -> None:
    """Check that a mesh can be read where nothing else of its folder is."""
    with tempfile.TemporaryDirectory(prefix="esplanade-mesh-") as folder:
        alone = Path(folder) / mesh.name
        alone.write_bytes(content)
        try:
            read_triangles(alone)
        except MeshError as error:
            text = f"zone {zone!r}: {mesh.name} cannot be carried along without other files"
            raise WorldFilesError(f"{text}: {error}") from None
