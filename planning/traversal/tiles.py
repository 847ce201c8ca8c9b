"""Rectangles of tiles, which are derived anew together."""

from typing import NamedTuple

from esplanade.planning.ground.layered import LayeredArrays


class TileBox(NamedTuple):
    """A rectangle of tiles; the last row and column are excluded."""

    first_row: int
    first_column: int
    end_row: int
    end_column: int


def all_tiles(arrays: LayeredArrays) -> TileBox:
    """The box of all tiles."""
    return TileBox(0, 0, int(arrays.pages.shape[1]), int(arrays.pages.shape[2]))
