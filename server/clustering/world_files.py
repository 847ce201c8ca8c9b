"""The files of a world as they are carried to other machines."""

from pathlib import Path
from typing import Final

from esplanade.planning.scene.bounded_reading import read_bounded
from esplanade.planning.scene.world_file import World

MOST_BYTES: Final = 64 * 1024 * 1024
"""No larger file of a scene is taken in."""


class WorldFilesError(ValueError):
    """The files of a world cannot be carried to other machines; the message says which and why."""


def files_of(path: Path, world: World) -> dict[str, bytes]:
    """The bytes of a world's file and of its scenes, by their names relative to it.

    Raises
    ------
    OSError
        A file cannot be read, or is too large.
    WorldFilesError
        A scene needs a mesh, or lies outside of the folder of the world's file.
    """
    files = {path.name: read_bounded(path, MOST_BYTES)}
    for zone in world.file.zones:
        name = zone.scene.as_posix()
        if world.scenes[zone.name].mesh is not None:
            raise WorldFilesError(f"zone {zone.name!r}: scenes of meshes cannot be carried along")
        if zone.scene.is_absolute() or ".." in zone.scene.parts or name == path.name:
            raise WorldFilesError(
                f"zone {zone.name!r}: {name} is to lie in the folder of the world's file"
            )
        files[name] = read_bounded(world.paths[zone.name], MOST_BYTES)
    return files
