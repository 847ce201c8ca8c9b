"""The ground under feet: its exact height, and the treads that a foot can be put on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from esplanade.actors.locomotion.footsteps import _ground_kernels as kernels
from esplanade.actors.locomotion.footsteps._ground_kernels import GroundArrays, SolidArrays
from esplanade.planning import LayeredGrid, Polygon, Scene
from esplanade.planning.compiled.arrays import Bools, Floats, Ints

NEAR_M: Final = kernels.NEAR_M
"""Ground that is further up or down than this does not count for the next step."""

_BUCKET_M: Final = 1.0
_MOST_BUCKETS: Final = 1 << 17
_MOST_MEMBERS: Final = 1 << 22
"""Buckets are made larger until there are no more of them, and of solids in them."""


class Ground:
    """The standing surfaces of a zone.

    Solids are known exactly; of a mesh only the heights of its cells are known.
    """

    def __init__(self, scene: Scene, grid: LayeredGrid) -> None:
        solids = () if scene.mesh is not None else scene.solids()
        self.flat = bool(grid.arrays.flat)
        self.arrays = GroundArrays(self.flat, scene.mesh is None, solid_arrays(solids), grid.arrays)
        """The same surfaces as compiled code takes them."""

    def height(self, points: Floats, near_m: Floats) -> Floats:
        """Heights of the ground at points.

        Parameters
        ----------
        points : float64 (N, 2), metres
        near_m : float64 (N,), metres
            Of several surfaces at a point the one nearest to this height is meant.

        Returns
        -------
        float64 (N,), metres
            nan where there is no ground within NEAR_M, as over an edge or in a wall.
        """
        out = np.empty(len(points))
        places, near = np.ascontiguousarray(points), np.ascontiguousarray(near_m)
        kernels.fill_heights(self.arrays, places, near, out)
        return out

    def settle(self, footprints: Floats, foot_m: Floats) -> tuple[Floats, Bools]:
        """Put feet on the ground.

        A foot that would hang over the edge of a tread is moved along itself until it does not,
        by up to 20 cm. On a slope it lies at the height of its middle.

        Parameters
        ----------
        footprints : float64 (N, 4), metres and radians
            Their heights are about those expected.
        foot_m : float64 (N,), metres

        Returns
        -------
        float64 (N, 4) footprints, and bool (N,) whether there is ground at all
        """
        out = footprints.copy()
        found = np.empty(len(out), dtype=np.bool_)
        kernels.settle_feet(self.arrays, out, foot_m, found)
        return out, found


def solid_arrays(solids: Sequence[Polygon]) -> SolidArrays:
    """Solids in the order given, with an index of those about each bucket of the map."""
    counts = np.array([0, *(len(solid.points) for solid in solids)], dtype=np.int64)
    corners = np.array([xy for solid in solids for xy in solid.points], dtype=np.float64)
    corners = corners.reshape(-1, 2)
    begins = np.cumsum(counts)
    boxes = np.empty((len(solids), 4))
    if len(solids):
        boxes[:, :2] = np.minimum.reduceat(corners, begins[:-1])
        boxes[:, 2:] = np.maximum.reduceat(corners, begins[:-1])
    low = boxes[:, :2].min(axis=0, initial=0.0)
    size_m = _bucket_size_m(boxes, low)
    per_m = 1.0 / size_m
    cells = np.maximum(((boxes - np.tile(low, 2)) * per_m).astype(np.int64), 0)
    nx, ny = (cells[:, 2:].max(axis=0, initial=0) + 1).tolist()
    first, members = _members(cells, nx, ny)
    return SolidArrays(
        corners,
        begins,
        boxes,
        np.array([solid.offset_m for solid in solids], dtype=np.float64),
        np.array([solid.offset_m + solid.height_m for solid in solids], dtype=np.float64),
        np.array([_ramp(solid) for solid in solids], dtype=np.float64).reshape(-1, 6),
        np.array([solid.ramp is not None for solid in solids], dtype=np.bool_),
        np.array([solid.carries for solid in solids], dtype=np.bool_),
        first,
        members,
        float(low[0]),
        float(low[1]),
        per_m,
        nx,
        ny,
        int(np.diff(first).max()),
    )


def _ramp(solid: Polygon) -> tuple[float, float, float, float, float, float]:
    """Beginning, way and squared length of a solid's ramp, and its height at the beginning."""
    if solid.ramp is None:
        return 0.0, 0.0, 0.0, 0.0, 1.0, 0.0
    (ax, ay), (bx, by) = solid.ramp.start, solid.ramp.end
    square = (bx - ax) ** 2 + (by - ay) ** 2
    return ax, ay, bx - ax, by - ay, square, solid.offset_m + solid.ramp.start_height_m


def _bucket_size_m(boxes: Floats, low: Floats) -> float:
    """The size at which neither buckets nor the solids in them are too many."""
    size_m = _BUCKET_M
    while True:
        cells = np.floor((boxes - np.tile(low, 2)) / size_m)
        spans = cells[:, 2:] - cells[:, :2] + 1.0
        buckets = (cells[:, 2:].max(axis=0, initial=0.0) + 1.0).prod()
        if buckets <= _MOST_BUCKETS and spans.prod(axis=1).sum() <= max(_MOST_MEMBERS, len(boxes)):
            return size_m
        size_m *= 2.0


def _members(cells: Ints, nx: int, ny: int) -> tuple[Ints, Ints]:
    """Find the first member of each of nx * ny buckets, and the solids in them, ascending.

    `cells` (S, 4) are the least column and row, and the greatest column and row, of each solid.
    """
    spans = cells[:, 2:] - cells[:, :2] + 1
    counts = spans.prod(axis=1)
    solids = np.repeat(np.arange(len(cells)), counts)
    place = np.arange(len(solids)) - np.repeat(np.cumsum(counts) - counts, counts)
    rows, columns = np.divmod(place, spans[solids, 0])
    buckets = (cells[solids, 1] + rows) * nx + cells[solids, 0] + columns
    order = np.argsort(buckets, kind="stable")
    first = np.searchsorted(buckets[order], np.arange(nx * ny + 1))
    return first.astype(np.int64), solids[order].astype(np.int64)
