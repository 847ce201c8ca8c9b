"""Barriers: exact lines on the plan that stop bodies from one height to another."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._geometry_kernels import BARRIER
from esplanade.planning.ground._ledge_kernels import outlines
from esplanade.planning.ground._solid_ledge_kernels import (
    SolidBuckets,
    ledges_of_solids,
    list_solids,
)
from esplanade.planning.ground._surface_kernels import SolidArrays
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.surfaces import Surfaces
from esplanade.planning.scene.scene import Door, Scene, Wall

Barriers = NDArray[np.void]
"""(S,) of `BARRIER`, whose docstring says which bodies a barrier stops."""

_BUCKET_M = 1.0


def barriers_of_scene(scene: Scene, surfaces: Surfaces, arrays: LayeredArrays) -> Barriers:
    """Barriers of a scene of polygons, doors first, (S,). Cost O(cells + outlines)."""
    solids = surfaces.solids.solids
    strips = [*map(_door_barrier, scene.doors), *map(_wall_barrier, scene.walls)]
    bounds = arrays.x0, arrays.y0, arrays.x1, arrays.y1
    return np.concatenate(
        [
            np.array(strips, dtype=BARRIER),
            filled(BARRIER, outlines, solids),
            filled(BARRIER, ledges_of_solids, solids, _buckets(solids, bounds), bounds),
        ]
    )


def _buckets(solids: SolidArrays, bounds: tuple[float, float, float, float]) -> SolidBuckets:
    """The solids, listed by buckets."""
    x0, y0, x1, y1 = bounds
    nx = max(1, math.ceil((x1 - x0) / _BUCKET_M))
    ny = max(1, math.ceil((y1 - y0) / _BUCKET_M))
    place = (x0, y0, _BUCKET_M, nx, ny)
    starts = np.zeros(nx * ny + 1, dtype=np.int64)
    list_solids(solids, place, starts, np.empty(0, dtype=np.int64))
    np.cumsum(starts, out=starts)
    members = np.empty(starts[-1], dtype=np.int64)
    list_solids(solids, place, starts, members)
    return SolidBuckets(starts, members, *place)


def filled(
    dtype: np.dtype[np.void], kernel: Callable[..., int], *arguments: object, room: int = 1024
) -> NDArray[np.void]:
    """The rows that a kernel writes into its last argument, however many there are.

    The kernel returns the number of rows; it is called again if there was not enough room.
    """
    out = np.empty(room, dtype=dtype)
    count = kernel(*arguments, out)
    if count > len(out):
        out = np.empty(count, dtype=dtype)
        count = kernel(*arguments, out)
    return out[:count]


def _door_barrier(door: Door) -> tuple[float, ...]:
    climb = 0.0 if door.open else math.inf
    return (*door.start, *door.end, door.offset_m, door.offset_m + door.height_m, climb)


def _wall_barrier(wall: Wall) -> tuple[float, ...]:
    return (*wall.start, *wall.end, wall.offset_m, wall.offset_m + wall.height_m, math.inf)
