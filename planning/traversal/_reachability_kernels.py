"""Reachability on bare arrays: the links that a body may follow from each cell."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import Measures, NearBarriers
from esplanade.planning.ground._geometry_kernels import TOLERANCE_M
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.traversal._anchor_kernels import is_listed
from esplanade.planning.traversal._way_kernels import leads_on
from esplanade.planning.traversal.tiles import CellBox

_EVERY_LINK = 255
_ONE = np.uint64(1)
_ALL = np.uint64(2**64 - 1)
_ROW = np.uint64(TILE)
_TO_LAST_COLUMN = np.uint64(TILE - 1)
_TO_LAST_ROW = np.uint64(TILE * (TILE - 1))
_FIRST_ROW = np.uint64(0xFF)
_FIRST_COLUMN = np.uint64(0x0101010101010101)
"""Bits of the 64 cells of a tile, row by row."""


@kernel
def step_bits(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    offsets: NDArray[np.int8],
    rooms: NDArray[np.float32],
    box: CellBox,
    row: int,
    out: NDArray[np.uint8],
) -> None:
    """Write the links that a body may follow from each cell of a box, into `out` (N,).

    Bit d stands for link d. `offsets` and `rooms` are those of `place_anchors`, for the cells of
    the box and those next to them. Steps lead both ways: those E to NW are looked into, the others
    are taken over from the neighbours that they lead to. Links stay as they are between cells that
    do not list the barrier `row`, unless it is `ANY`.
    """
    listed = _listed_bits(arrays, near, box)
    for opposite in (False, True):
        for layer in range(arrays.pages.shape[0]):
            for tj in range(box.first_row // TILE, (box.end_row - 1) // TILE + 1):
                for ti in range(box.first_column // TILE, (box.end_column - 1) // TILE + 1):
                    page = arrays.pages[layer, tj, ti]
                    if page < 0:
                        continue
                    outer = around = _ALL
                    if not opposite and _is_level(arrays, body, page):
                        outer = _outer_bits(arrays, tj, ti)
                        around = outer | _around_listed(arrays, listed, layer, tj, ti)
                    j0, j1 = max(box.first_row, tj * TILE), min(box.end_row, (tj + 1) * TILE)
                    i0, i1 = max(box.first_column, ti * TILE), min(box.end_column, (ti + 1) * TILE)
                    for j in range(j0 - tj * TILE, j1 - tj * TILE):
                        for i in range(i0 - ti * TILE, i1 - ti * TILE):
                            cell = page + j * TILE + i
                            k = np.uint64(j * TILE + i)
                            if opposite:
                                if out[cell] != _EVERY_LINK:
                                    out[cell] |= _opposite_bits(arrays, out, cell)
                            elif not around >> k & _ONE:
                                out[cell] = _EVERY_LINK
                            else:
                                bits = 15
                                if outer >> k & _ONE:
                                    bits = _bits_by_heights(arrays, body, cell)
                                own = is_listed(near, cell, row)
                                for d in range(4):
                                    if not bits >> d & 1:
                                        continue
                                    other = arrays.links[cell, d]
                                    if near.first[cell] < 0 and near.first[other] < 0:
                                        continue
                                    if own or is_listed(near, other, row):
                                        leads = leads_on(
                                            arrays, near, body, offsets, rooms, cell, other, d % 2
                                        )
                                    else:
                                        leads = out[cell] >> d & 1 > 0
                                    if not leads:
                                        bits &= ~(1 << d)
                                out[cell] = bits


@inlined
def _is_level(arrays: LayeredArrays, body: Measures, page: int) -> bool:
    """Whether heights bar no link of any cell of a tile: it leads to tiles of its layer."""
    headroom = arrays.level_headroom[page // (TILE * TILE)]
    return bool(headroom >= body.height_m - TOLERANCE_M)


@inlined
def _outer_bits(arrays: LayeredArrays, tj: int, ti: int) -> np.uint64:
    """Bits of the cells of a tile that have no neighbours on some side, since the grid ends."""
    tiles_y, tiles_x = arrays.pages.shape[1:]
    bits = np.uint64(0)
    if tj == 0:
        bits |= _FIRST_ROW
    if tj == tiles_y - 1:
        bits |= _FIRST_ROW << _TO_LAST_ROW
    if ti == 0:
        bits |= _FIRST_COLUMN
    if ti == tiles_x - 1:
        bits |= _FIRST_COLUMN << _TO_LAST_COLUMN
    return bits


@kernel
def _listed_bits(arrays: LayeredArrays, near: NearBarriers, box: CellBox) -> NDArray[np.uint64]:
    """Bits of the cells that have a barrier near, by tile; for tiles of a box and around it."""
    bits = np.empty(len(arrays.level_headroom), dtype=np.uint64)
    layers, tiles_y, tiles_x = arrays.pages.shape
    for layer in range(layers):
        for tj in range(max(0, box.first_row // TILE - 1), min(tiles_y, box.end_row // TILE + 2)):
            for ti in range(
                max(0, box.first_column // TILE - 1), min(tiles_x, box.end_column // TILE + 2)
            ):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                listed = np.uint64(0)
                for k in range(TILE * TILE):
                    if near.first[page + k] >= 0:
                        listed |= _ONE << np.uint64(k)
                bits[page // (TILE * TILE)] = listed
    return bits


@inlined
def _bits_of(
    arrays: LayeredArrays, listed: NDArray[np.uint64], layer: int, tj: int, ti: int
) -> np.uint64:
    """The bits of a tile; none where there is no tile."""
    tiles_y, tiles_x = arrays.pages.shape[1:]
    if not (0 <= tj < tiles_y and 0 <= ti < tiles_x):
        return np.uint64(0)
    page = arrays.pages[layer, tj, ti]
    return listed[page // (TILE * TILE)] if page >= 0 else np.uint64(0)


@inlined
def _beside_listed(
    arrays: LayeredArrays, listed: NDArray[np.uint64], layer: int, tj: int, ti: int
) -> np.uint64:
    """Bits of the cells of a tile that have a barrier near, or beside one in their row that has."""
    own = _bits_of(arrays, listed, layer, tj, ti)
    before = _bits_of(arrays, listed, layer, tj, ti - 1)
    after = _bits_of(arrays, listed, layer, tj, ti + 1)
    own |= ((own << _ONE) & ~_FIRST_COLUMN) | ((own & ~_FIRST_COLUMN) >> _ONE)
    own |= (before >> _TO_LAST_COLUMN) & _FIRST_COLUMN
    return own | ((after & _FIRST_COLUMN) << _TO_LAST_COLUMN)


@inlined
def _around_listed(
    arrays: LayeredArrays, listed: NDArray[np.uint64], layer: int, tj: int, ti: int
) -> np.uint64:
    """Bits of the cells of a level tile that have a barrier near, or beside a cell that has."""
    own = _beside_listed(arrays, listed, layer, tj, ti)
    below = _beside_listed(arrays, listed, layer, tj - 1, ti)
    above = _beside_listed(arrays, listed, layer, tj + 1, ti)
    own |= (own << _ROW) | (own >> _ROW)
    return own | (below >> _TO_LAST_ROW) | (above << _TO_LAST_ROW)


@inlined
def _opposite_bits(arrays: LayeredArrays, steps: NDArray[np.uint8], cell: int) -> int:
    """The links W to SE of a cell whose opposites may be followed."""
    bits = 0
    for d in range(4, 8):
        other = arrays.links[cell, d]
        if other >= 0 and steps[other] >> (d - 4) & 1:
            bits |= 1 << d
    return bits


@inlined
def _bits_by_heights(arrays: LayeredArrays, body: Measures, cell: int) -> int:
    """Of the links E to NW, those that floors and ceilings allow a body to follow."""
    floor = arrays.floors[cell]
    if np.isnan(floor):
        return 0
    ceiling = arrays.ceilings[cell]
    step = np.float32(body.step_on_m + TOLERANCE_M)
    room = np.float32(body.height_m - TOLERANCE_M)
    bits = 0
    for d in range(4):
        other = arrays.links[cell, d]
        if other < 0:
            continue
        if (
            abs(arrays.floors[other] - floor) <= step
            and min(arrays.ceilings[other], ceiling) - max(arrays.floors[other], floor) >= room
        ):
            bits |= 1 << d
    return bits


@kernel
def flood(
    links: NDArray[np.int32],
    steps: NDArray[np.uint8],
    starts: NDArray[np.int64],
    out: NDArray[np.bool_],
) -> int:
    """Mark all cells that steps lead to from some cells; returns their number.

    `out` (N,) must be preset to False.
    """
    queue = np.empty(len(out), dtype=np.int32)
    reached = 0
    for start in starts:
        if not out[start]:
            out[start] = True
            queue[reached] = start
            reached += 1
    head = 0
    while head < reached:
        cell = queue[head]
        head += 1
        for d in range(8):
            if steps[cell] >> d & 1:
                other = links[cell, d]
                if not out[other]:
                    out[other] = True
                    queue[reached] = other
                    reached += 1
    return reached
