"""The floors of a building that comes as a mesh: its standing surfaces and its barriers."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._gap_kernels import (
    GAP,
    ColumnSurfaces,
    Hits,
    find_gaps,
    insert_gaps,
)
from esplanade.planning.ground._geometry_kernels import BARRIER
from esplanade.planning.ground._ledge_kernels import FACE
from esplanade.planning.ground._lintel_kernels import (
    find_hems,
    lintels_between,
    lintels_of_hems,
    list_in_columns,
)
from esplanade.planning.ground._mesh_kernels import (
    grow_regions,
    hits_of_triangles,
    join_faces,
    steep_faces,
    surfaces_of_hits,
)
from esplanade.planning.ground._rim_kernels import ledges_of_rims
from esplanade.planning.ground._surface_kernels import TOP, Raster, SolidArrays, SolidColumns
from esplanade.planning.ground._triangle_kernels import (
    TriangleBuckets,
    find_rims,
    kinds_of,
    list_triangles,
)
from esplanade.planning.ground.barriers import Barriers, filled
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.ground.surfaces import MAX_LAYERS, Surfaces, linked, raster_of
from esplanade.planning.scene.mesh_file import MeshError

Progress = Callable[[str, float], None]
"""Called with the name of the work that begins, and the part of the whole that is done, 0 to 1."""

_BATCH = 4096
_MOST_ROOM = 2**18
_WIDEST_BUCKET_M = 0.5
_LEAST_BUCKET_M = 0.1


def no_progress(_doing: str, _share: float) -> None:
    """Report no progress."""


def surfaces_of_triangles(
    triangles: NDArray[np.float64], cell_m: float = 0.25, progress: Progress = no_progress
) -> Surfaces:
    """The standing surfaces on triangles (T, 3, 3), x east, y north, z up, metres.

    A surface lies where the vertical through a cell's centre meets a face that looks up, no
    steeper than 45 degrees, and has headroom; also over a gap of one cell between two surfaces.
    Surfaces that links join are grouped into layers from the lowest on; a surface that lies above
    another of its layer begins the next layer.

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
    found = ColumnSurfaces(tops, floors[:count], ceilings[:count])
    tops, floors, ceilings = _with_gaps(raster, Hits(starts, heights), found)

    progress("linking", 0.45)
    links = linked(raster, tops, floors, ceilings)
    progress("grouping", 0.6)
    numbers = np.repeat(np.arange(columns, dtype=np.int32), np.diff(tops))
    layers = np.empty(len(floors), dtype=np.int16)
    order = np.argsort(floors, kind="stable")
    layer_count = grow_regions(tops, numbers, floors, links, order, layers)
    if layer_count > MAX_LAYERS:
        raise MeshError(f"{layer_count} layers, but there may be {MAX_LAYERS}")
    rows, cols = np.divmod(numbers, np.int32(raster.nx))
    place = bounds, cell_m, raster.ny, raster.nx
    return Surfaces(rows, cols, floors, ceilings, layers, links, _no_solids(columns), *place)


def _with_gaps(raster: Raster, hits: Hits, surfaces: ColumnSurfaces) -> ColumnSurfaces:
    """Surfaces by column, together with those over gaps between them."""
    gaps = np.empty(4 * len(surfaces.floors), dtype=GAP)
    gaps = gaps[: find_gaps(raster, hits, surfaces, gaps)]
    floors = np.empty(len(surfaces.floors) + len(gaps), dtype=np.float32)
    both = ColumnSurfaces(np.empty_like(surfaces.starts), floors, np.empty_like(floors))
    insert_gaps(surfaces, gaps, both)
    return both


def barriers_of_triangles(
    triangles: NDArray[np.float64], surfaces: Surfaces, arrays: LayeredArrays
) -> Barriers:
    """Barriers on triangles (T, 3, 3): faces too steep to stand on, ledges and lintels, (S,)."""
    columns = surfaces.ny * surfaces.nx
    numbers = surfaces.rows.astype(np.int64) * surfaces.nx + surfaces.columns
    tops = np.zeros(columns + 1, dtype=np.int32)
    np.cumsum(np.bincount(numbers, minlength=columns), out=tops[1:])
    faces = _faces(triangles, surfaces, tops)
    steep = np.empty(len(faces), dtype=BARRIER)
    for field in ("x0", "y0", "x1", "y1", "bottom_m", "top_m"):
        steep[field] = faces[field]
    steep["climb_m"] = math.inf
    buckets = _buckets(triangles, surfaces.bounds)
    place = surfaces.raster, tops, surfaces.floors
    ledges = filled(BARRIER, ledges_of_rims, buckets, *place, room=_MOST_ROOM)
    hems = np.zeros(len(triangles), dtype=np.uint8)
    find_hems(triangles, buckets.kinds, hems)
    hanging = filled(BARRIER, lintels_of_hems, buckets, hems, *place)
    between = _lintels_between(arrays, surfaces.raster, np.concatenate([steep, hanging]))
    return np.concatenate([steep, ledges, hanging, between])


def _lintels_between(arrays: LayeredArrays, raster: Raster, exact: Barriers) -> Barriers:
    """Lintels between cells, (S,), where no exact barrier (R,) marks the end of a ceiling."""
    starts = np.zeros(raster.ny * raster.nx + 1, dtype=np.int64)
    list_in_columns(raster, exact, starts, np.empty(0, dtype=np.int32))
    np.cumsum(starts, out=starts)
    members = np.empty(starts[-1], dtype=np.int32)
    list_in_columns(raster, exact, starts, members)
    return np.concatenate(
        [filled(BARRIER, lintels_between, arrays, d, exact, starts, members) for d in (0, 2)]
    )


def _buckets(
    triangles: NDArray[np.float64], bounds: tuple[float, float, float, float]
) -> TriangleBuckets:
    """The triangles with their rims, listed by buckets: small ones if there are many triangles."""
    kinds = np.empty(len(triangles), dtype=np.uint8)
    kinds_of(triangles, kinds)
    rims = np.zeros(len(triangles), dtype=np.uint8)
    find_rims(triangles, kinds, rims)
    x0, y0, x1, y1 = bounds
    bucket_m = min(
        _WIDEST_BUCKET_M, max(_LEAST_BUCKET_M, math.sqrt((x1 - x0) * (y1 - y0) / len(triangles)))
    )
    while True:
        nx = max(1, math.ceil((x1 - x0) / bucket_m))
        ny = max(1, math.ceil((y1 - y0) / bucket_m))
        place = (x0, y0, bucket_m, nx, ny)
        starts = np.zeros(nx * ny + 1, dtype=np.int64)
        list_triangles(triangles, kinds, place, starts, np.empty(0, dtype=np.int32))
        np.cumsum(starts, out=starts)
        if starts[-1] <= 8 * len(triangles) + _MOST_ROOM:
            break
        bucket_m *= 2.0
    members = np.empty(starts[-1], dtype=np.int32)
    list_triangles(triangles, kinds, place, starts, members)
    return TriangleBuckets(triangles, kinds, rims, starts, members, *place)


def _faces(
    triangles: NDArray[np.float64], surfaces: Surfaces, tops: NDArray[np.int32]
) -> NDArray[np.void]:
    """Pieces of steep faces (R,) of `FACE`."""
    columns = surfaces.ny * surfaces.nx
    room = min(8 * len(triangles), _MOST_ROOM)
    faces = filled(FACE, steep_faces, surfaces.raster, triangles, tops, surfaces.floors, room=room)
    faces = faces[np.argsort(faces["column"], kind="stable")]
    starts = np.zeros(columns + 1, dtype=np.int64)
    np.cumsum(np.bincount(faces["column"], minlength=columns), out=starts[1:])
    kept = np.empty(len(faces), dtype=np.bool_)
    join_faces(starts, faces, kept)
    return faces[kept]


def _no_solids(columns: int) -> SolidColumns:
    nothing = SolidArrays(
        np.empty((0, 2)),
        np.zeros(1, dtype=np.int64),
        np.empty(0),
        np.empty(0, dtype=TOP),
        np.empty(0, dtype=np.bool_),
        np.empty(0, dtype=np.int16),
    )
    starts = np.zeros(columns + 1, dtype=np.int32)
    return SolidColumns(nothing, starts, np.empty(0, dtype=np.int32))


def _raster(
    triangles: NDArray[np.float64], cell_m: float
) -> tuple[Raster, tuple[float, float, float, float]]:
    """The columns over triangles; edges of cells lie at whole multiples of the cell.

    The round coordinates that buildings are drawn in then fall on edges of cells, not on centres.
    """
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    x0, y0 = (math.floor(v / cell_m) * cell_m for v in low[:2])
    x1, y1 = (math.ceil(v / cell_m) * cell_m for v in high[:2])
    bounds = (x0, y0, x1, y1)
    return raster_of(bounds, cell_m), bounds
