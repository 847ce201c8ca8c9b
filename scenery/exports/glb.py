"""A scene as GLB: a node for each layer, one for what is solid, for walls, and for each door."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Scene
from esplanade.planning.scene.mesh_file import read_triangles
from esplanade.scenery.exports.layers import LayerCells
from esplanade.scenery.exports.plugs import plugs_of
from esplanade.scenery.exports.slopes import slopes_of
from esplanade.scenery.meshes import as_glb

Floats = NDArray[np.float64]
_LEVEL = 1e-6
_STEEPEST = 0.7071


def scene_as_glb(scene: Scene, layers: Iterable[LayerCells]) -> bytes:
    """GLB, y up and in metres. Floors are as their cells, ramps are slopes and stairs
    are steps; what is solid has sides and no top, and in a hole of one cell an underside.
    """
    layers = list(layers)
    parts = {f"layer {layer.number}": _floors(scene, layer) for layer in layers}
    sides = [
        _upright(start, end, solid.offset_m, solid.height_m)
        for solid in scene.polygons
        if not solid.carries
        for start, end in zip(solid.points, (*solid.points[1:], solid.points[0]), strict=True)
    ]
    parts["solids"] = _joined([*sides, _undersides(layers)])
    walls = [_upright(wall.start, wall.end, wall.offset_m, wall.height_m) for wall in scene.walls]
    if scene.mesh is not None:
        walls.append(_steep(read_triangles(scene.mesh)))
    parts["walls"] = _joined(walls)
    for door in scene.doors:
        parts[f"door {door.name}"] = _upright(door.start, door.end, door.offset_m, door.height_m)
    return as_glb(parts)


def _steep(triangles: Floats) -> Floats:
    """Those that are too steep to stand on."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    steep: Floats = triangles[np.abs(normals[:, 2]) < _STEEPEST * size]
    return steep


def _joined(parts: list[Floats]) -> Floats:
    return np.concatenate([np.empty((0, 3, 3)), *parts])


def _floors(scene: Scene, layer: LayerCells) -> Floats:
    """Level cells of a row together, each sloping one by itself."""
    east, north = slopes_of(scene, layer)
    sloping = (np.abs(east) > _LEVEL) | (np.abs(north) > _LEVEL)
    level = layer._replace(floors=np.where(sloping, np.nan, layer.floors))
    rows, columns = np.nonzero(sloping & np.isfinite(layer.floors))
    tilted = layer.floors[rows, columns], east[rows, columns], north[rows, columns]
    return np.concatenate(
        [
            _rectangles(layer, np.array(level.runs(), dtype=np.float64).reshape(-1, 4)),
            _rectangles(
                layer, np.stack([rows, columns, columns + 1, tilted[0]], axis=1), *tilted[1:]
            ),
        ]
    )


def _undersides(layers: list[LayerCells]) -> Floats:
    """Rectangles that look down, in holes of one cell."""
    plugs = plugs_of(layers)
    if not len(plugs):
        return np.empty((0, 3, 3))
    rows, columns, heights = plugs.T
    runs = np.stack([rows, columns, columns + 1.0, heights], axis=1)
    return _rectangles(layers[0], runs)[:, ::-1]


def _rectangles(
    layer: LayerCells, runs: Floats, east: Floats | float = 0.0, north: Floats | float = 0.0
) -> Floats:
    """Two triangles for each run of row, columns and height in its middle, that slopes so."""
    x0, y0 = layer.corner
    south, west = y0 + runs[:, 0] * layer.cell_m, x0 + runs[:, 1] * layer.cell_m
    top, right, z = south + layer.cell_m, x0 + runs[:, 2] * layer.cell_m, runs[:, 3]
    half = 0.5 * layer.cell_m
    a, b, c, d = (
        np.stack([x, y, z + half * (to_east * east + to_north * north)], axis=1)
        for x, y, to_east, to_north in (
            (west, south, -1.0, -1.0),
            (right, south, 1.0, -1.0),
            (right, top, 1.0, 1.0),
            (west, top, -1.0, 1.0),
        )
    )
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def _upright(
    start: tuple[float, float], end: tuple[float, float], foot_m: float, height_m: float
) -> Floats:
    """A rectangle that stands on a line."""
    low, high = foot_m, foot_m + height_m
    a, b = (*start, low), (*end, low)
    c, d = (*end, high), (*start, high)
    return np.array([[a, b, c], [a, c, d]])
