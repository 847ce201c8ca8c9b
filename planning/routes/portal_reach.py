"""Portals that nobody gets to, and places of arrival at which nobody can stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from esplanade.planning.grid.grid import ADULT, LayeredGrid
from esplanade.planning.routes.storey_heights import reached_from
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.portal_areas import portals_at
from esplanade.planning.scene.scene import Scene

Point = tuple[float, float, float]


def unreached_portals(
    grid: LayeredGrid, scene: Scene, arrivals: Sequence[Point] = (), body: Body = ADULT
) -> list[str]:
    """The names of the portals of a scene that a body does not get to.

    It starts from the spawns; in a scene without any, from the places `arrivals` (x, y, z, metres)
    at which people come in from elsewhere. A portal is reached if the middle of a cell in it is.
    """
    spawns = [(*spawn.position, spawn.z_m) for spawn in scene.spawns]
    arrays = grid.layered
    cells = np.flatnonzero(reached_from(grid, spawns or list(arrivals), body))
    places = arrays.places[cells]
    positions = np.column_stack(
        [
            arrays.x0 + (places["column"] + 0.5) * arrays.cell_m,
            arrays.y0 + (places["row"] + 0.5) * arrays.cell_m,
        ]
    )
    heights = arrays.floors[cells].astype(np.float64)
    # One portal after the other, since of those that overlap the first would hide the others.
    return [
        portal.name
        for portal in scene.portals
        if not (portals_at([portal], positions, heights) == 0).any()
    ]
