"""The form that every scene is brought into: tiles of cells, layer by layer, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel

TILE = 8
"""Cells along a side of a tile."""
_SHIFT = 3
_CELLS = TILE * TILE

LINK_M = 1.2
"""Greatest difference in height between the floors of two linked cells: more than anyone steps."""
LINK_ROOM_M = 0.5
"""Least headroom that two linked cells have in common, in metres."""

LINK_ROWS = (0, 1, 1, 1, 0, -1, -1, -1)
LINK_COLUMNS = (1, 1, 0, -1, -1, -1, 0, 1)
"""Offsets to the eight neighbours E, NE, N, NW, W, SW, S, SE; d + 4 is opposite to d."""

PLACE = np.dtype([("layer", "i4"), ("row", "i4"), ("column", "i4")])
"""The place of a cell in its grid."""


class LayeredArrays(NamedTuple):
    """The floors of a zone. Memory grows with the area that can be stood on.

    Cells come in square tiles, row by row within a tile; a tile without any standing surface has
    no cells. N is 64 times the number of tiles.
    """

    pages: NDArray[np.int32]
    """(L, tiles_y, tiles_x): first cell of each tile, -1 where the layer has no surface."""
    floors: NDArray[np.float32]
    """(N,): height of the standing surface at the cell's centre, metres; nan in a hole."""
    ceilings: NDArray[np.float32]
    """(N,): height of the underside above it, metres; inf under open sky, nan in a hole."""
    links: NDArray[np.int32]
    """(N, 8): the neighbours in the order of `LINK_ROWS`, on any layer; -1 where there is
    none. If a links to b, then b links to a."""
    places: NDArray[np.void]
    """(N,) of `PLACE`, also of holes."""
    level_headroom: NDArray[np.float32]
    """(N / 64,): least headroom over a tile and those around it, metres, if all of them are level,
    at one height and without holes; -1 for other tiles. Most tiles of a building are level."""
    x0: float
    y0: float
    x1: float
    y1: float
    cell_m: float
    ny: int
    nx: int


@inlined
def cell_index(arrays: LayeredArrays, layer: int, j: int, i: int) -> int:
    """The cell at a layer, row and column; -1 outside of the grid, and in a hole of the layer."""
    if not (0 <= layer < arrays.pages.shape[0] and 0 <= j < arrays.ny and 0 <= i < arrays.nx):
        return -1
    first = arrays.pages[layer, j >> _SHIFT, i >> _SHIFT]
    if first < 0:
        return -1
    cell = int(first + ((j & (TILE - 1)) << _SHIFT) + (i & (TILE - 1)))
    return -1 if np.isnan(arrays.floors[cell]) else cell


@inlined
def cell_of(arrays: LayeredArrays, layer: int, x: float, y: float) -> int:
    """The cell of a layer that holds a point; -1 outside the bounds and where nobody can stand."""
    if not (arrays.x0 <= x <= arrays.x1 and arrays.y0 <= y <= arrays.y1):
        return -1
    j = min(arrays.ny - 1, int((y - arrays.y0) / arrays.cell_m))
    i = min(arrays.nx - 1, int((x - arrays.x0) / arrays.cell_m))
    return cell_index(arrays, layer, j, i)


@kernel
def cell_near(arrays: LayeredArrays, x: float, y: float, z: float) -> int:
    """The cell above or below a point whose floor is nearest in height; -1 if there is none."""
    best = -1
    away = np.inf
    for layer in range(arrays.pages.shape[0]):
        cell = cell_of(arrays, layer, x, y)
        if cell >= 0 and abs(arrays.floors[cell] - z) < away:
            away = abs(arrays.floors[cell] - z)
            best = cell
    return best


@kernel
def number_tiles(
    pages: NDArray[np.int32],
    layers: NDArray[np.int16],
    rows: NDArray[np.int32],
    columns: NDArray[np.int32],
) -> int:
    """Write the first cell of each tile that holds any surface; returns the number of tiles.

    `pages` must be preset to -1; `layers`, `rows` and `columns` are those of the surfaces.
    """
    for s in range(len(layers)):
        pages[layers[s], rows[s] >> _SHIFT, columns[s] >> _SHIFT] = 0
    tiles = 0
    for layer in range(pages.shape[0]):
        for tj in range(pages.shape[1]):
            for ti in range(pages.shape[2]):
                if pages[layer, tj, ti] == 0:
                    pages[layer, tj, ti] = tiles * _CELLS
                    tiles += 1
    return tiles


@kernel
def fill_places(pages: NDArray[np.int32], places: NDArray[np.void]) -> None:
    """Fill `places` (N,) of `PLACE`."""
    for layer in range(pages.shape[0]):
        for tj in range(pages.shape[1]):
            for ti in range(pages.shape[2]):
                first = pages[layer, tj, ti]
                if first < 0:
                    continue
                for k in range(_CELLS):
                    place = places[first + k]
                    place["layer"] = layer
                    place["row"] = (tj << _SHIFT) + (k >> _SHIFT)
                    place["column"] = (ti << _SHIFT) + (k & (TILE - 1))


@kernel
def fill_cells(
    arrays: LayeredArrays,
    surfaces: tuple[NDArray[np.int16], NDArray[np.int32], NDArray[np.int32]],
    heights: tuple[NDArray[np.float32], NDArray[np.float32]],
    links: NDArray[np.int32],
    cells: NDArray[np.int32],
) -> None:
    """Write surfaces (layers, rows, columns), (floors, ceilings) and their links into cells.

    `links` (S, 8) are rows of surfaces; `cells` (S,) receives the cell of each surface.
    """
    layers, rows, columns = surfaces
    floors, ceilings = heights
    pages, into = arrays.pages, arrays.links
    for s in range(len(layers)):
        j, i = rows[s], columns[s]
        first = pages[layers[s], j >> _SHIFT, i >> _SHIFT]
        cell = first + ((j & (TILE - 1)) << _SHIFT) + (i & (TILE - 1))
        cells[s] = cell
        arrays.floors[cell] = floors[s]
        arrays.ceilings[cell] = ceilings[s]
    for s in range(len(layers)):
        cell = cells[s]
        for d in range(8):
            t = links[s, d]
            into[cell, d] = cells[t] if t >= 0 else -1


@kernel
def find_level_tiles(arrays: LayeredArrays) -> None:
    """Fill `arrays.level_headroom`, once everything else is filled."""
    floors = np.full(len(arrays.level_headroom), np.nan, dtype=np.float32)
    rooms = np.empty(len(arrays.level_headroom), dtype=np.float32)
    for tile in range(len(floors)):
        first = tile * _CELLS
        floor, ceiling = arrays.floors[first], arrays.ceilings[first]
        level = True
        for cell in range(first, first + _CELLS):
            level &= arrays.floors[cell] == floor
            ceiling = min(ceiling, arrays.ceilings[cell])
        if level:
            floors[tile], rooms[tile] = floor, ceiling - floor
    layers, tiles_y, tiles_x = arrays.pages.shape
    for layer in range(layers):
        for tj in range(tiles_y):
            for ti in range(tiles_x):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                tile = page // _CELLS
                room = rooms[tile]
                for jj in range(max(0, tj - 1), min(tiles_y, tj + 2)):
                    for ii in range(max(0, ti - 1), min(tiles_x, ti + 2)):
                        other = arrays.pages[layer, jj, ii] // _CELLS
                        if other < 0 or floors[other] != floors[tile]:
                            room = np.float32(-1.0)
                        else:
                            room = min(room, rooms[other])
                arrays.level_headroom[tile] = room
