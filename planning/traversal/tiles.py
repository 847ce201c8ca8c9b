"""Rectangles of tiles and of cells, which are derived anew together."""

import math
from typing import NamedTuple

from esplanade.planning.ground.layered import TILE, LayeredArrays


class TileBox(NamedTuple):
    """A rectangle of tiles; the last row and column are excluded."""

    first_row: int
    first_column: int
    end_row: int
    end_column: int


class CellBox(NamedTuple):
    """A rectangle of cells; the last row and column are excluded."""

    first_row: int
    first_column: int
    end_row: int
    end_column: int


def all_tiles(arrays: LayeredArrays) -> TileBox:
    """The box of all tiles."""
    return TileBox(0, 0, int(arrays.pages.shape[1]), int(arrays.pages.shape[2]))


def all_cells(arrays: LayeredArrays) -> CellBox:
    """The box of all cells, those beyond the bounds in the last tiles included."""
    return CellBox(0, 0, TILE * int(arrays.pages.shape[1]), TILE * int(arrays.pages.shape[2]))


def cells_around(
    arrays: LayeredArrays, around: tuple[float, float, float, float], reach: float
) -> CellBox:
    """The box of all cells within reach of a rectangle x0, y0, x1, y1; metres."""
    x0, y0, x1, y1 = around
    whole = all_cells(arrays)
    return CellBox(
        max(0, math.floor((y0 - reach - arrays.y0) / arrays.cell_m)),
        max(0, math.floor((x0 - reach - arrays.x0) / arrays.cell_m)),
        min(whole.end_row, math.floor((y1 + reach - arrays.y0) / arrays.cell_m) + 1),
        min(whole.end_column, math.floor((x1 + reach - arrays.x0) / arrays.cell_m) + 1),
    )


def wider(arrays: LayeredArrays, box: CellBox, cells: int) -> CellBox:
    """A box with so many more rows and columns on each side, as far as there are any."""
    whole = all_cells(arrays)
    return CellBox(
        max(0, box.first_row - cells),
        max(0, box.first_column - cells),
        min(whole.end_row, box.end_row + cells),
        min(whole.end_column, box.end_column + cells),
    )


def tiles_of(box: CellBox) -> TileBox:
    """The tiles that cells of a box are in."""
    return TileBox(
        box.first_row // TILE,
        box.first_column // TILE,
        -(-box.end_row // TILE),
        -(-box.end_column // TILE),
    )
