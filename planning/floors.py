"""The floors of a zone: where one can stand, and what is in the way."""

from __future__ import annotations

from typing import NamedTuple

from planning._layered import LayeredArrays
from planning.barriers import Barriers, barriers_of_scene
from planning.doors import Doors
from planning.scene import Scene
from planning.surfaces import Surfaces, surfaces_of_scene


class Floors(NamedTuple):
    """Everything that is derived from the shape of a zone alone, whatever the body."""

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
