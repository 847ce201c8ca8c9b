"""Barriers: exact lines on the plan that stop bodies from one height to another."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._geometry_kernels import BARRIER
from esplanade.planning.ground._ledge_kernels import (
    FACE,
    Sides,
    ledges_towards,
    lintels_between,
    outlines,
)
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.surfaces import Surfaces
from esplanade.planning.scene.scene import Door, Scene, Wall

Barriers = NDArray[np.void]
"""(S,) of `BARRIER`, whose docstring says which bodies a barrier stops."""

_SIDES = (0, 2, 4, 6)


def barriers_of_scene(scene: Scene, surfaces: Surfaces, arrays: LayeredArrays) -> Barriers:
    """Barriers of a scene of polygons, doors first, (S,). Cost O(cells + outlines)."""
    columns = surfaces.solids
    no_faces = np.empty(0, dtype=FACE)
    sides = Sides(columns, np.zeros(len(columns.starts), dtype=np.int64), no_faces)
    strips = [*map(_door_barrier, scene.doors), *map(_wall_barrier, scene.walls)]
    return np.concatenate(
        [
            np.array(strips, dtype=BARRIER),
            filled(BARRIER, outlines, columns.solids),
            ledges(arrays, sides),
        ]
    )


def ledges(arrays: LayeredArrays, sides: Sides) -> Barriers:
    """Barriers where floors end or change their height, (S,)."""
    return np.concatenate([filled(BARRIER, ledges_towards, arrays, sides, d) for d in _SIDES])


def lintels(arrays: LayeredArrays) -> Barriers:
    """Barriers where ceilings change their height, (S,); needed where no outline is known."""
    return np.concatenate([filled(BARRIER, lintels_between, arrays, d) for d in (0, 2)])


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
