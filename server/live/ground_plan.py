"""The plan of a scene, storey by storey, for a map: what stands, what carries, doors and places."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.scene.scene import Polygon

_KNEE_M, _HEAD_M = 0.3, 1.9
"""Between these heights above a storey, something is in a body's way there."""
_THROUGH = ("wall", "building")


def ground_plan(scene: Scene, grid: LayeredGrid, storeys_m: Sequence[float]) -> dict[str, Any]:
    """All of a scene that a map draws and that does not move, as plain data."""
    heights = list(storeys_m) or [0.0]
    solids = [
        [each for each in scene.polygons if _in_the_way(each, z) and _shows(each, z, heights)]
        for z in heights
    ]
    floors = [[each for each in scene.polygons if _carries_at(each, z)] for z in heights]
    return {
        "scene": scene.name,
        "bounds": list(scene.bounds),
        "origin_m": [scene.bounds[0], scene.bounds[1]],
        "storeys": [
            {"z_m": z, "name": f"{z:+.1f} m" if z else "ground"} for z in map(float, heights)
        ],
        "walls": _walls(scene, grid),
        "doors": [
            {
                "name": door.name,
                **dict(zip(("x0", "y0", "x1", "y1"), (*door.start, *door.end), strict=True)),
                "z_m": door.offset_m,
                "height_m": door.height_m,
            }
            for door in scene.doors
        ],
        "places": [
            {"name": each.name, "x": each.position[0], "y": each.position[1], "z": each.z_m}
            for each in scene.places
        ],
        "spawns": [
            {"x": each.position[0], "y": each.position[1], "z": each.z_m, "radius_m": each.radius_m}
            for each in scene.spawns
        ],
        "stairs": [
            each.model_dump(mode="json", include={"start", "end", "width_m", "bottom_m", "top_m"})
            for each in scene.stairs
        ],
        "outlines": [[list(map(list, each.points)) for each in found] for found in solids],
        "kinds": [[each.kind for each in found] for found in solids],
        "floors": [[list(map(list, each.points)) for each in found] for found in floors],
    }


def _walls(scene: Scene, grid: LayeredGrid) -> list[list[float]]:
    """Walls as x0, y0, x1, y1, bottom and top; of a mesh, all that nobody climbs."""
    if scene.mesh is None:
        return [
            [*each.start, *each.end, each.offset_m, each.offset_m + each.height_m]
            for each in scene.walls
        ]
    barriers = grid.barriers[len(grid.doors) :]
    high = barriers[barriers["climb_m"] > _KNEE_M]
    names = ["x0", "y0", "x1", "y1", "bottom_m", "top_m"]
    columns = np.stack([np.nan_to_num(high[name], posinf=1e3, neginf=-1e3) for name in names], 1)
    found: list[list[float]] = columns.round(2).tolist()
    return found


def _in_the_way(polygon: Polygon, storey_m: float) -> bool:
    top = polygon.offset_m + polygon.height_m
    return polygon.offset_m < storey_m + _HEAD_M and top > storey_m + _KNEE_M


def _shows(polygon: Polygon, storey_m: float, heights: Sequence[float]) -> bool:
    """Whether a storey's plan has it: walls and buildings go on through storeys, all else belongs
    to the one that it stands on, however high it grows."""
    if polygon.kind in _THROUGH:
        return True
    below = [z for z in heights if z <= polygon.offset_m + _KNEE_M]
    return storey_m == max(below, default=min(heights))


def _carries_at(polygon: Polygon, storey_m: float) -> bool:
    top = polygon.offset_m + polygon.height_m
    return polygon.carries and abs(top - storey_m) <= _KNEE_M
