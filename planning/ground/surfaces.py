"""Standing surfaces of a scene: where a body can stand, linked and grouped into layers."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._surface_kernels import (
    RUN,
    TOP,
    Raster,
    SolidArrays,
    SolidColumns,
    fill_columns,
    flood,
    keep_surfaces,
    link_columns,
    relate_groups,
    runs_of_solids,
    surfaces_of_columns,
)
from esplanade.planning.ground.layered import (
    PLACE,
    TILE,
    LayeredArrays,
    fill_cells,
    fill_places,
    find_level_tiles,
    number_tiles,
)
from esplanade.planning.scene.scene import Polygon, Scene

MAX_COVERED = 50_000_000
"""Most cells that solids cover, counted solid by solid: they take some seconds and 200 MB."""
MAX_OFFSETS = 500
"""Most heights of undersides: solids of each are a layer of their own at first."""
MAX_COLUMNS = 43_000_000
"""Greatest number of columns of a grid: the largest scene has as many with cells of 0.1 m."""
MAX_LAYERS = 255
"""Greatest number of layers: they are numbered by one byte on the wire."""


class GroundError(ValueError):
    """The ground of a scene would be too large, or have too many layers; the message says which."""


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Standing surfaces, one row each, column by column and lowest first.

    A surface is a floor in one cell of one layer, with at least `LEAST_HEADROOM_M` of headroom.
    """

    rows: NDArray[np.int32]
    """(S,): row of the grid."""
    columns: NDArray[np.int32]
    """(S,): column of the grid."""
    floors: NDArray[np.float32]
    """(S,): height at the cell's centre, metres."""
    ceilings: NDArray[np.float32]
    """(S,): height of the underside above, metres; inf under the open sky."""
    layers: NDArray[np.int16]
    """(S,): no layer has two surfaces in one column."""
    links: NDArray[np.int32]
    """(S, 8): the surfaces of the neighbouring columns that a body can get to; -1 if none."""
    solids: SolidColumns
    """The solids that carry the surfaces and stand on them; none if triangles carry them."""
    bounds: tuple[float, float, float, float]
    """x0, y0, x1, y1 in metres."""
    cell_m: float
    ny: int
    nx: int

    @property
    def raster(self) -> Raster:
        """The columns that the surfaces lie in."""
        return Raster(self.bounds[0], self.bounds[1], self.cell_m, self.ny, self.nx)

    def __len__(self) -> int:
        return len(self.floors)

    @property
    def layer_count(self) -> int:
        """Number of layers, at least one."""
        return int(self.layers.max(initial=0)) + 1

    def layered(self) -> LayeredArrays:
        """The same surfaces as tiles of cells."""
        tiles_y, tiles_x = -(-self.ny // TILE), -(-self.nx // TILE)
        pages = np.full((self.layer_count, tiles_y, tiles_x), -1, dtype=np.int32)
        cells = number_tiles(pages, self.layers, self.rows, self.columns) * TILE * TILE
        arrays = LayeredArrays(
            pages,
            np.full(cells, np.nan, dtype=np.float32),
            np.full(cells, np.nan, dtype=np.float32),
            np.full((cells, 8), -1, dtype=np.int32),
            np.empty(cells, dtype=PLACE),
            np.empty(cells // TILE**2, dtype=np.float32),
            *self.bounds,
            self.cell_m,
            self.ny,
            self.nx,
        )
        fill_places(pages, arrays.places)
        fill_cells(
            arrays,
            (self.layers, self.rows, self.columns),
            (self.floors, self.ceilings),
            self.links,
            np.empty(len(self), dtype=np.int32),
        )
        find_level_tiles(arrays)
        return arrays


def raster_of(bounds: tuple[float, float, float, float], cell_m: float) -> Raster:
    """The columns over the bounds x0, y0, x1, y1, with cells of `cell_m` metres.

    Raises
    ------
    ValueError
        `cell_m` is not between 0.05 and 2 m, or is so small that there are too many columns.
    """
    if not 0.05 <= cell_m <= 2.0:
        raise ValueError(f"cell_m must lie between 0.05 and 2 m, got {cell_m}")
    x0, y0, x1, y1 = bounds
    ny = max(1, math.ceil((y1 - y0) / cell_m - 1e-9))
    nx = max(1, math.ceil((x1 - x0) / cell_m - 1e-9))
    if ny * nx > MAX_COLUMNS:
        least = math.sqrt((y1 - y0) * (x1 - x0) / MAX_COLUMNS)
        raise GroundError(
            f"cell_m must be {least:.2g} m or more over {x1 - x0:g} x {y1 - y0:g} m, got {cell_m}"
        )
    return Raster(float(x0), float(y0), float(cell_m), ny, nx)


def surfaces_of_scene(scene: Scene, cell_m: float = 0.25) -> Surfaces:
    """The standing surfaces of a scene of polygons.

    Polygons of one offset form one layer; if they only lie beside a lower layer that is linked to
    them, they belong to that layer. If the scene has spawns or places, surfaces that are not
    linked to any of them, such as roofs, are left out. `cell_m` is the edge of a cell in metres.
    Cost O(cells + surfaces).

    Raises
    ------
    ValueError
        `cell_m` is not between 0.05 and 2 m; there are too many layers, or the solids cover too
        many cells.
    """
    raster = raster_of(scene.bounds, cell_m)
    columns = solid_columns(scene, raster)
    room = raster.ny * raster.nx + len(columns.members)
    floors, ceilings = np.empty(room, dtype=np.float32), np.empty(room, dtype=np.float32)
    rows, cols = np.empty(room, dtype=np.int32), np.empty(room, dtype=np.int32)
    groups = np.empty(room, dtype=np.int16)
    tops = np.empty_like(columns.starts)
    count = surfaces_of_columns(
        raster, columns, True, (floors, ceilings), (rows, cols), groups, tops
    )
    floors, ceilings, groups = floors[:count], ceilings[:count], groups[:count]
    rows, cols = rows[:count], cols[:count]
    links = linked(raster, tops, floors, ceilings)

    if count and (scene.spawns or scene.places):
        kept = _reached(scene, raster, rows * raster.nx + cols, floors, links)
        links = links[: keep_surfaces(kept, links, np.empty(count, dtype=np.int32))]
        floors, ceilings, groups = floors[kept], ceilings[kept], groups[kept]
        rows, cols = rows[kept], cols[kept]
    layers = _layers_of_groups(rows, cols, groups, links)
    place = scene.bounds, cell_m, raster.ny, raster.nx
    return Surfaces(rows, cols, floors, ceilings, layers, links, columns, *place)


def linked(
    raster: Raster,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
) -> NDArray[np.int32]:
    """Links, int32 (S, 8), of surfaces that are listed by column (CSR)."""
    links = np.full((len(floors), 8), -1, dtype=np.int32)
    link_columns(raster.ny, raster.nx, starts, floors, ceilings, links)
    return links


def solid_columns(scene: Scene, raster: Raster) -> SolidColumns:
    """The solids of a scene, and which of them each column goes through."""
    solids = _solid_arrays(scene)
    runs = np.empty(4096, dtype=RUN)
    while True:
        starts = np.zeros(raster.ny * raster.nx + 1, dtype=np.int32)
        used = runs_of_solids(raster, solids, runs, starts)
        if used <= len(runs):
            break
        runs = np.empty(used, dtype=RUN)
    covered = int(starts.sum(dtype=np.int64))
    if covered > MAX_COVERED:
        raise GroundError(
            f"the solids cover {covered} cells of {raster.cell_m:g} m, counted solid by solid; "
            f"{MAX_COVERED} are possible: make it of fewer, or of larger cells"
        )
    np.cumsum(starts, out=starts)
    members = np.empty(starts[-1], dtype=np.int32)
    fill_columns(raster.nx, runs[:used], starts, members)
    return SolidColumns(solids, starts, members)


def _solid_arrays(scene: Scene) -> SolidArrays:
    solids = scene.solids()
    offsets = sorted({0.0, *(solid.offset_m for solid in solids)})
    if len(offsets) > MAX_OFFSETS:
        raise GroundError(
            f"the solids have {len(offsets)} different undersides, {MAX_OFFSETS} are possible"
        )
    groups = {offset: group for group, offset in enumerate(offsets)}
    ends = itertools.accumulate((len(solid.points) for solid in solids), initial=0)
    return SolidArrays(
        np.array([p for solid in solids for p in solid.points], dtype=np.float64).reshape(-1, 2),
        np.array(list(ends), dtype=np.int64),
        np.array([solid.offset_m for solid in solids], dtype=np.float64),
        np.array([_top(solid) for solid in solids], dtype=TOP),
        np.array([solid.carries for solid in solids], dtype=np.bool_),
        np.array([groups[solid.offset_m] for solid in solids], dtype=np.int16),
    )


def _top(solid: Polygon) -> tuple[float, float, float, float, float]:
    """Coefficients of `SolidArrays.tops`."""
    top = solid.offset_m + solid.height_m
    if solid.ramp is None:
        return top, 0.0, 0.0, top, top
    (ax, ay), (bx, by) = solid.ramp.start, solid.ramp.end
    low = solid.offset_m + solid.ramp.start_height_m
    length2 = (bx - ax) ** 2 + (by - ay) ** 2
    gx, gy = (top - low) * (bx - ax) / length2, (top - low) * (by - ay) / length2
    return low - gx * ax - gy * ay, gx, gy, min(low, top), max(low, top)


def _reached(
    scene: Scene,
    raster: Raster,
    numbers: NDArray[np.int32],
    floors: NDArray[np.float32],
    links: NDArray[np.int32],
) -> NDArray[np.bool_]:
    """The surfaces that are linked to a spawn or a place."""
    points = [(*spawn.position, spawn.z_m) for spawn in scene.spawns]
    points += [(*place.position, place.z_m) for place in scene.places]
    reached = np.zeros(len(floors), dtype=np.bool_)
    seeds = []
    for x, y, z in points:
        row = min(raster.ny - 1, int((y - raster.y0) / raster.cell_m))
        column = min(raster.nx - 1, int((x - raster.x0) / raster.cell_m))
        first, last = np.searchsorted(numbers, row * raster.nx + column + np.arange(2))
        if first == last:
            rows, columns = np.divmod(numbers, raster.nx)
            away = np.hypot(rows - row, columns - column) * raster.cell_m
            seeds.append(int((away + np.abs(floors - z)).argmin()))
        else:
            seeds.append(int(first + np.abs(floors[first:last] - z).argmin()))
    flood(links, np.array(seeds, dtype=np.int64), reached)
    return reached


def _layers_of_groups(
    rows: NDArray[np.int32],
    columns: NDArray[np.int32],
    groups: NDArray[np.int16],
    links: NDArray[np.int32],
) -> NDArray[np.int16]:
    """Layers of surfaces by the offsets that they stand on."""
    count = int(groups.max(initial=0)) + 1
    if count == 1:
        return np.zeros(len(groups), dtype=np.int16)
    overlap = np.zeros((count, count), dtype=np.bool_)
    joined = np.zeros((count, count), dtype=np.bool_)
    relate_groups(rows, columns, groups, links, overlap, joined)
    layer_of = np.full(count, -1, dtype=np.int16)
    for group in np.flatnonzero(joined.diagonal()):
        free = (
            layer
            for layer in range(layer_of.max() + 1)
            if (joined[group] & (layer_of == layer)).any()
            and not (overlap[group] & (layer_of == layer)).any()
        )
        layer_of[group] = next(free, layer_of.max() + 1)
    if layer_of.max() >= MAX_LAYERS:
        raise GroundError(f"{layer_of.max() + 1} layers, but there may be {MAX_LAYERS}")
    return layer_of[groups]
