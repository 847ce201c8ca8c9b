"""A scene as GLB: a node for each layer, one for what is solid, for walls, and for each door."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Scene
from esplanade.scenery.exports.layers import LayerCells
from esplanade.scenery.meshes import as_glb

Floats = NDArray[np.float64]


def scene_as_glb(scene: Scene, layers: Iterable[LayerCells]) -> bytes:
    """GLB, y up and in metres. Floors are as their cells; what is solid has sides and no top."""
    parts = {f"layer {layer.number}": _floors(layer) for layer in layers}
    sides = [
        _upright(start, end, solid.offset_m, solid.height_m)
        for solid in scene.polygons
        if not solid.carries
        for start, end in zip(solid.points, (*solid.points[1:], solid.points[0]), strict=True)
    ]
    parts["solids"] = _joined(sides)
    parts["walls"] = _joined(
        [_upright(wall.start, wall.end, wall.offset_m, wall.height_m) for wall in scene.walls]
    )
    for door in scene.doors:
        parts[f"door {door.name}"] = _upright(door.start, door.end, door.offset_m, door.height_m)
    return as_glb(parts)


def _joined(parts: list[Floats]) -> Floats:
    return np.concatenate([np.empty((0, 3, 3)), *parts])


def _floors(layer: LayerCells) -> Floats:
    x0, y0 = layer.corner
    runs = np.array(layer.runs(), dtype=np.float64).reshape(-1, 4)
    south, west = y0 + runs[:, 0] * layer.cell_m, x0 + runs[:, 1] * layer.cell_m
    north, east, z = south + layer.cell_m, x0 + runs[:, 2] * layer.cell_m, runs[:, 3]
    a, b, c, d = (
        np.stack([x, y, z], axis=1)
        for x, y in ((west, south), (east, south), (east, north), (west, north))
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
