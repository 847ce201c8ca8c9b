"""What stops a body, as exact lines on the map that reach from one height to another."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from planning._layered import LINK_M, LayeredArrays
from planning._ledge_kernels import Sides, ledges_towards, lintels_between
from planning.scene import Door, Polygon, Scene
from planning.surfaces import Surfaces, solid_columns

Barriers = NDArray[np.float64]
"""(S, 7): x0, y0, x1, y1, z0, z1, rise, metres.

A row stops a body of height H and step-on s that stands at height z if and only if
z0 < z + H, z1 > z + s and s < rise."""

_SIDES = (0, 2, 4, 6)
_PIECE_RISE_M = 0.25
"""The side of a ramp is cut into pieces whose tops rise by no more than this."""


def barriers_of_scene(scene: Scene, surfaces: Surfaces, arrays: LayeredArrays) -> Barriers:
    """Barriers of a scene of polygons, doors first. Cost O(cells + outlines)."""
    exact = [_door_row(door) for door in scene.doors]
    for wall in scene.walls:
        top = wall.offset_m + wall.height_m
        exact.append((*wall.start, *wall.end, wall.offset_m, top, math.inf))
    exact.extend(row for solid in scene.solids() for row in _outline(solid))
    columns = solid_columns(scene, surfaces.raster)
    sides = Sides(columns, np.zeros(len(columns.starts), dtype=np.int64), np.empty((0, 6)))
    outlines = np.array(exact, dtype=np.float64).reshape(-1, 7)
    return np.concatenate([outlines, ledges(arrays, sides)])


def ledges(arrays: LayeredArrays, sides: Sides) -> Barriers:
    """Barriers where floors end or change their height."""
    return np.concatenate([written(ledges_towards, arrays, sides, d) for d in _SIDES])


def lintels(arrays: LayeredArrays) -> Barriers:
    """Barriers where ceilings change their height; only for what no outline is known of."""
    return np.concatenate([written(lintels_between, arrays, d) for d in (0, 2)])


def written(kernel: Callable[..., int], *arguments: object) -> Barriers:
    """What a kernel writes, with as much room as it turns out to need."""
    out = np.empty((1024, 7))
    count = kernel(*arguments, out)
    if count > len(out):
        out = np.empty((count, 7))
        count = kernel(*arguments, out)
    return out[:count]


def _door_row(door: Door) -> tuple[float, ...]:
    rise = 0.0 if door.open else math.inf
    return (*door.start, *door.end, door.offset_m, door.offset_m + door.height_m, rise)


def _outline(solid: Polygon) -> Iterator[tuple[float, ...]]:
    """The edges of a solid, up to its top; of what nobody climbs, higher than anyone steps."""
    least = 0.0 if solid.carries else solid.offset_m + LINK_M
    for a, b in itertools.pairwise((*solid.points, solid.points[0])):
        low, high = solid.top_at(*a), solid.top_at(*b)
        pieces = max(1, math.ceil(abs(high - low) / _PIECE_RISE_M - 1e-9))
        for k in range(pieces):
            u, v = k / pieces, (k + 1) / pieces
            start = (a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]))
            end = (a[0] + v * (b[0] - a[0]), a[1] + v * (b[1] - a[1]))
            top = max(solid.top_at(*start), solid.top_at(*end), least)
            yield (*start, *end, solid.offset_m, top, math.inf)
