"""The floors of a zone: its standing surfaces, its barriers and its doors."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from esplanade.planning.ground.barriers import Barriers, barriers_of_scene
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.meshes import (
    Progress,
    barriers_of_triangles,
    no_progress,
    surfaces_of_triangles,
)
from esplanade.planning.ground.surfaces import Surfaces, surfaces_of_scene
from esplanade.planning.scene.doors import Doors
from esplanade.planning.scene.mesh_file import MeshError, Up, read_triangles
from esplanade.planning.scene.scene import Scene


class Floors(NamedTuple):
    """Everything that is derived from the shape of a zone alone, without any body."""

    surfaces: Surfaces
    layered: LayeredArrays
    barriers: Barriers
    doors: Doors


def floors_of_scene(scene: Scene, cell_m: float = 0.25) -> Floors:
    """The floors of a scene of polygons; see `surfaces_of_scene` and `barriers_of_scene`."""
    surfaces = surfaces_of_scene(scene, cell_m)
    layered = surfaces.layered()
    barriers = barriers_of_scene(scene, surfaces, layered)
    doors = Doors(barriers, {door.name: k for k, door in enumerate(scene.doors)})
    return Floors(surfaces, layered, barriers, doors)


def floors_of_mesh(
    path: str | Path, cell_m: float = 0.25, up: Up = "y", progress: Progress = no_progress
) -> Floors:
    """The floors of a mesh file; see `read_triangles` and `surfaces_of_triangles`.

    Raises
    ------
    MeshError
        The file is at fault; the message names the file and the fault.
    """
    progress("reading", 0.0)
    triangles = read_triangles(path, up)
    try:
        surfaces = surfaces_of_triangles(triangles, cell_m, progress)
    except MeshError as error:
        raise MeshError(f"{Path(path).name}: {error}") from None
    layered = surfaces.layered()
    progress("finding barriers", 0.7)
    barriers = barriers_of_triangles(triangles, surfaces, layered)
    progress("done", 1.0)
    return Floors(surfaces, layered, barriers, Doors(barriers, {}))
