"""The floors of a building that comes as a mesh: standing surfaces and what is in the way."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._gap_kernels import find_gaps, put_in
from esplanade.planning.ground._ledge_kernels import Sides
from esplanade.planning.ground._mesh_kernels import (
    grow_regions,
    hits_of_triangles,
    join_faces,
    steep_faces,
    surfaces_of_hits,
)
from esplanade.planning.ground._surface_kernels import Raster, SolidArrays, SolidColumns
from esplanade.planning.ground.barriers import Barriers, ledges, lintels, written
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.surfaces import MAX_LAYERS, Surfaces, linked, raster_of
from esplanade.planning.scene.mesh_file import MeshError

Progress = Callable[[str, float], None]
"""Told what is being done, and which share of the whole is behind."""

_BATCH = 4096
_MOST_ROOM = 2**18


def unheard(_doing: str, _share: float) -> None:
    pass


def surfaces_of_triangles(
    triangles: NDArray[np.float64], cell_m: float = 0.25, progress: Progress = unheard
) -> Surfaces:
    """Where one can stand on triangles (T, 3, 3), x east, y north, z up, metres.

    A surface lies where the vertical through a cell's centre meets a face that looks up, no
    steeper than 45 degrees, and has headroom; also over a gap of one cell between two. Surfaces
    that links join are grouped from the lowest on; one that lies above another of its layer
    begins the next.

    Raises
    ------
    MeshError
        Nobody can stand anywhere, or there are too many layers.
    """
    raster, bounds = _raster(triangles, cell_m)
    columns = raster.ny * raster.nx
    starts = np.zeros(columns + 1, dtype=np.int64)
    heights, kinds = np.empty(0, dtype=np.float32), np.empty(0, dtype=np.uint8)
    for fill in (False, True):
        for first in range(0, len(triangles), _BATCH):
            batch = triangles[first : first + _BATCH]
            hits_of_triangles(raster, batch, fill, starts, heights, kinds)
            share = (fill + first / len(triangles)) / 2.0
            progress("cutting columns", 0.1 + 0.3 * share)
        if not fill:
            np.cumsum(starts, out=starts)
            heights = np.empty(starts[-1], dtype=np.float32)
            kinds = np.empty(starts[-1], dtype=np.uint8)
    starts = np.concatenate([np.zeros(1, dtype=np.int64), starts[:-1]])
    floors, ceilings = np.empty_like(heights), np.empty_like(heights)
    tops = np.empty(columns + 1, dtype=np.int32)
    count = surfaces_of_hits(starts, heights, kinds, floors, ceilings, tops)
    if count == 0:
        raise MeshError("nobody can stand anywhere on it; does it look up?")
    hits = starts, heights
    tops, floors, ceilings = _with_gaps(raster, hits, tops, floors[:count], ceilings[:count])

    progress("linking", 0.45)
    links = linked(raster, tops, floors, ceilings)
    progress("grouping", 0.6)
    numbers = np.repeat(np.arange(columns, dtype=np.int32), np.diff(tops))
    layers = np.empty(len(floors), dtype=np.int16)
    order = np.argsort(floors, kind="stable")
    found = grow_regions(tops, numbers, floors, links, order, layers)
    if found > MAX_LAYERS:
        raise MeshError(f"{found} layers, but there may be {MAX_LAYERS}")
    rows, cols = np.divmod(numbers, np.int32(raster.nx))
    place = bounds, cell_m, raster.ny, raster.nx
    return Surfaces(rows, cols, floors, ceilings, layers, links, _no_solids(columns), *place)


def _with_gaps(
    raster: Raster,
    hits: tuple[NDArray[np.int64], NDArray[np.float32]],
    tops: NDArray[np.int32],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
) -> tuple[NDArray[np.int32], NDArray[np.float32], NDArray[np.float32]]:
    """Surfaces by column (CSR), floors and ceilings, and those over gaps between them."""
    columns = np.empty(2 * len(floors), dtype=np.int32)
    surfaces = np.empty((2 * len(floors), 2), dtype=np.float32)
    gaps = find_gaps(raster, hits, tops, floors, ceilings, columns, surfaces)
    new_floors = np.empty(len(floors) + gaps, dtype=np.float32)
    new_tops, new_ceilings = np.empty_like(tops), np.empty_like(new_floors)
    put_in(
        tops,
        (floors, ceilings),
        columns[:gaps],
        surfaces[:gaps],
        new_tops,
        (new_floors, new_ceilings),
    )
    return new_tops, new_floors, new_ceilings


def barriers_of_triangles(
    triangles: NDArray[np.float64], surfaces: Surfaces, arrays: LayeredArrays
) -> Barriers:
    """What stops a body on triangles: faces too steep to stand on, ledges and lintels."""
    starts, faces = _faces(triangles, surfaces)
    sides = Sides(surfaces.solids, starts, faces)
    exact = np.concatenate([faces, np.full((len(faces), 1), np.inf)], axis=1)
    return np.concatenate([exact, ledges(arrays, sides), lintels(arrays)])


def _faces(
    triangles: NDArray[np.float64], surfaces: Surfaces
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Pieces of steep faces (R, 6), listed by column (CSR)."""
    columns = surfaces.ny * surfaces.nx
    numbers = surfaces.rows.astype(np.int64) * surfaces.nx + surfaces.columns
    tops = np.zeros(columns + 1, dtype=np.int32)
    np.cumsum(np.bincount(numbers, minlength=columns), out=tops[1:])
    room = min(8 * len(triangles), _MOST_ROOM)
    rows = written(steep_faces, surfaces.raster, triangles, tops, surfaces.floors, room=room)
    where = rows[:, 6].astype(np.int64)
    order = np.argsort(where, kind="stable")
    faces = np.ascontiguousarray(rows[order, :6])
    starts = np.zeros(columns + 1, dtype=np.int64)
    np.cumsum(np.bincount(where, minlength=columns), out=starts[1:])
    kept = np.empty(len(faces), dtype=np.bool_)
    join_faces(starts, faces, kept)
    np.cumsum(np.bincount(where[order][kept], minlength=columns), out=starts[1:])
    return starts, faces[kept]


def _no_solids(columns: int) -> SolidColumns:
    nothing = SolidArrays(
        np.empty((0, 2)),
        np.zeros(1, dtype=np.int64),
        np.empty(0),
        np.empty((0, 5)),
        np.empty(0, dtype=np.bool_),
        np.empty(0, dtype=np.int16),
    )
    starts = np.zeros(columns + 1, dtype=np.int32)
    return SolidColumns(nothing, starts, np.empty(0, dtype=np.int32))


def _raster(
    triangles: NDArray[np.float64], cell_m: float
) -> tuple[Raster, tuple[float, float, float, float]]:
    """The columns over triangles; its lines lie at whole multiples of the cell.

    So the round coordinates that buildings are drawn in fall on edges of cells, not on centres.
    """
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    x0, y0 = (math.floor(v / cell_m) * cell_m for v in low[:2])
    x1, y1 = (math.ceil(v / cell_m) * cell_m for v in high[:2])
    bounds = (x0, y0, x1, y1)
    return raster_of(bounds, cell_m), bounds
