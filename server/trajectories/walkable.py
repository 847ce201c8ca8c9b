"""The lowest floor of a scene as well-known text, as far as trajectories are laid on it."""

from importlib import import_module

from esplanade.planning import Scene
from esplanade.recordings.jupedsim_tables import box

_WALL_M = 0.1
_LOW_M = 0.5
"""Solids that begin lower stand on the lowest floor."""


def walkable_wkt(scene: Scene) -> str:
    """The bounds without solids and walls; the bounds alone without shapely, or with a mesh.

    Walls are 0.1 m thick, doors are open. Of several parts only the largest is given, since
    programs for trajectories take one polygon.
    """
    bounds = box(scene.bounds)
    if scene.mesh is not None:
        return bounds
    try:
        shapely = import_module("shapely")
    except ImportError:
        return bounds
    taken = [
        shapely.Polygon(solid.points)
        for solid in scene.polygons
        if not solid.carries and solid.offset_m < _LOW_M
    ]
    taken += [
        shapely.LineString([wall.start, wall.end]).buffer(_WALL_M / 2, cap_style="square")
        for wall in scene.walls
        if wall.offset_m < _LOW_M
    ]
    left = shapely.from_wkt(bounds).difference(shapely.union_all(taken))
    parts = shapely.get_parts(left).tolist()
    if not parts:
        return bounds
    text: str = shapely.to_wkt(max(parts, key=lambda part: part.area), rounding_precision=4)
    return text
