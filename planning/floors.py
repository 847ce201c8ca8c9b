"""The floors of a zone: where one can stand, and what is in the way."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planning._layered import LayeredArrays
from planning.barriers import Barriers, barriers_of_scene
from planning.bodies import Body
from planning.doors import Doors
from planning.mesh_file import MeshError, Up, read_triangles
from planning.meshes import Progress, barriers_of_triangles, surfaces_of_triangles, unheard
from planning.scene import Scene
from planning.surfaces import Surfaces, surfaces_of_scene


class Floors(NamedTuple):
    """Everything that is derived from the shape of a zone alone, whatever the body."""

    surfaces: Surfaces
    layered: LayeredArrays
    barriers: Barriers
    doors: Doors

    def met_on(self, layer: int) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """What an adult meets on one layer, and where that has a floor.

        Returns
        -------
        float64 (K, 4) lines x0, y0, x1, y1 in metres, and bool (ny, nx).
        """
        s, body = self.surfaces, Body.adult()
        own = s.layers == layer
        heights = np.full((s.ny, s.nx), np.nan)
        heights[s.rows[own], s.columns[own]] = s.floors[own]
        a, b = self.barriers[:, 0:2], self.barriers[:, 2:4]
        ways = b - a
        lengths = np.maximum(np.hypot(*ways.T), 1e-9)[:, None]
        aside = ways[:, ::-1] * (0.6, -0.6) * s.cell_m / lengths
        met = np.zeros(len(a), dtype=np.bool_)
        for beside in ((a + b) / 2 + aside, (a + b) / 2 - aside):
            columns, rows = np.floor((beside - s.bounds[:2]) / s.cell_m).astype(np.int64).T
            floors = heights[rows.clip(0, s.ny - 1), columns.clip(0, s.nx - 1)]
            met |= (self.barriers[:, 4] < floors + body.height_m) & (
                self.barriers[:, 5] > floors + body.step_on_m
            )
        met &= self.barriers[:, 6] > body.step_on_m
        return np.ascontiguousarray(self.barriers[met, :4]), ~np.isnan(heights)


def floors_of_scene(scene: Scene, cell_m: float = 0.25) -> Floors:
    """The floors of a scene of polygons; see `surfaces_of_scene` and `barriers_of_scene`."""
    surfaces = surfaces_of_scene(scene, cell_m)
    layered = surfaces.layered()
    barriers = barriers_of_scene(scene, surfaces, layered)
    doors = Doors(barriers, {door.name: k for k, door in enumerate(scene.doors)})
    return Floors(surfaces, layered, barriers, doors)


def floors_of_mesh(
    path: str | Path, cell_m: float = 0.25, up: Up = "y", progress: Progress = unheard
) -> Floors:
    """The floors of a mesh file; see `read_triangles` and `surfaces_of_triangles`.

    Raises
    ------
    MeshError
        The file is at fault; the message names it and says how.
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
