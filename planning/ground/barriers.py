"""What stops a body, as exact lines on the map that reach from one height to another."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._ledge_kernels import (
    Sides,
    ledges_towards,
    lintels_between,
    outlines,
)
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.surfaces import Surfaces
from esplanade.planning.scene.scene import Door, Scene, Wall

Barriers = NDArray[np.float64]
"""(S, 7): x0, y0, x1, y1, z0, z1, rise, metres.

A row stops a body of height H and step-on s that stands at height z if and only if
z0 < z + H, z1 > z + s and s < rise."""

_SIDES = (0, 2, 4, 6)


def barriers_of_scene(scene: Scene, surfaces: Surfaces, arrays: LayeredArrays) -> Barriers:
    """Barriers of a scene of polygons, doors first. Cost O(cells + outlines)."""
    columns = surfaces.solids
    sides = Sides(columns, np.zeros(len(columns.starts), dtype=np.int64), np.empty((0, 6)))
    lines = [*map(_door_row, scene.doors), *map(_wall_row, scene.walls)]
    return np.concatenate(
        [
            np.array(lines, dtype=np.float64).reshape(-1, 7),
            written(outlines, columns.solids),
            ledges(arrays, sides),
        ]
    )


def ledges(arrays: LayeredArrays, sides: Sides) -> Barriers:
    """Barriers where floors end or change their height."""
    return np.concatenate([written(ledges_towards, arrays, sides, d) for d in _SIDES])


def lintels(arrays: LayeredArrays) -> Barriers:
    """Barriers where ceilings change their height; only for what no outline is known of."""
    return np.concatenate([written(lintels_between, arrays, d) for d in (0, 2)])


def written(kernel: Callable[..., int], *arguments: object, room: int = 1024) -> Barriers:
    """What a kernel writes, with as much room as it turns out to need."""
    out = np.empty((room, 7))
    count = kernel(*arguments, out)
    if count > len(out):
        out = np.empty((count, 7))
        count = kernel(*arguments, out)
    return out[:count]


def _door_row(door: Door) -> tuple[float, ...]:
    rise = 0.0 if door.open else math.inf
    return (*door.start, *door.end, door.offset_m, door.offset_m + door.height_m, rise)


def _wall_row(wall: Wall) -> tuple[float, ...]:
    return (*wall.start, *wall.end, wall.offset_m, wall.offset_m + wall.height_m, math.inf)
