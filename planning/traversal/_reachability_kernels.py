"""Reachability on bare arrays: the links that a body may follow from each cell."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import TOLERANCE_M, Measures, NearBarriers
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.traversal._anchor_kernels import is_listed
from esplanade.planning.traversal._way_kernels import leads_on
from esplanade.planning.traversal.tiles import CellBox


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
    is_quiet = np.zeros(len(arrays.level_headroom), dtype=np.bool_)
    for opposite in (False, True):
        for layer in range(arrays.pages.shape[0]):
            for tj in range(box.first_row // TILE, (box.end_row - 1) // TILE + 1):
                for ti in range(box.first_column // TILE, (box.end_column - 1) // TILE + 1):
                    page = arrays.pages[layer, tj, ti]
                    if page < 0:
                        continue
                    tile = page // (TILE * TILE)
                    is_open = _is_open(arrays, body, page, tj, ti)
                    j0, j1 = max(box.first_row, tj * TILE), min(box.end_row, (tj + 1) * TILE)
                    i0, i1 = max(box.first_column, ti * TILE), min(box.end_column, (ti + 1) * TILE)
                    if not opposite and is_open:
                        is_quiet[tile] = (near.first[page : page + TILE * TILE] < 0).all()
                    for j in range(j0 - tj * TILE, j1 - tj * TILE):
                        for i in range(i0 - ti * TILE, i1 - ti * TILE):
                            cell = page + j * TILE + i
                            if is_quiet[tile] and 0 < j < TILE - 1 and 0 < i < TILE - 1:
                                out[cell] = 255
                            elif opposite:
                                out[cell] |= _opposite_bits(arrays, out, cell)
                            else:
                                bits = 15 if is_open else _bits_by_heights(arrays, body, cell)
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
def _is_open(arrays: LayeredArrays, body: Measures, page: int, tj: int, ti: int) -> bool:
    """Whether heights bar no link of any cell of a tile."""
    tiles_y, tiles_x = arrays.pages.shape[1:]
    is_inner = 0 < tj < tiles_y - 1 and 0 < ti < tiles_x - 1
    headroom = arrays.level_headroom[page // (TILE * TILE)]
    return bool(is_inner and headroom >= body.height_m - TOLERANCE_M)


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
