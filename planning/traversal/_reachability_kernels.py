"""Reachability on bare arrays: the links that a body may follow from each cell."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import TOLERANCE_M, Measures, NearBarriers
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.traversal._anchor_kernels import bend_between
from esplanade.planning.traversal.tiles import TileBox


@inlined
def _unbarred_bits(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    anchors: NDArray[np.float32],
    cell: int,
    bits: int,
) -> int:
    """Those steps of a cell, of those in `bits`, on which the body keeps clear of barriers."""
    for d in range(8):
        if bits >> d & 1:
            other = arrays.links[cell, d]
            if bend_between(arrays, near, body, anchors, cell, other)[0] == 0:
                bits &= ~(1 << d)
    return bits


@kernel
def step_bits(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    anchors: NDArray[np.float32],
    box: TileBox,
    out: NDArray[np.uint8],
) -> None:
    """Write the links that a body may follow from each cell of some tiles, into `out` (N,).

    Bit d stands for link d.
    """
    tiles_y, tiles_x = arrays.pages.shape[1:]
    for layer in range(arrays.pages.shape[0]):
        for tj in range(box.first_row, box.end_row):
            for ti in range(box.first_column, box.end_column):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                is_inner = 0 < tj < tiles_y - 1 and 0 < ti < tiles_x - 1
                headroom = arrays.level_headroom[page // (TILE * TILE)]
                is_open = is_inner and headroom >= body.height_m - TOLERANCE_M
                for cell in range(page, page + TILE * TILE):
                    bits = 255 if is_open else _bits_by_heights(arrays, body, cell)
                    if bits:
                        bits = _unbarred_bits(arrays, near, body, anchors, cell, bits)
                    out[cell] = bits


@inlined
def _bits_by_heights(arrays: LayeredArrays, body: Measures, cell: int) -> int:
    """The links that floors and ceilings allow a body to follow, without regard to barriers."""
    floor = arrays.floors[cell]
    if np.isnan(floor):
        return 0
    ceiling = arrays.ceilings[cell]
    step = np.float32(body.step_on_m + TOLERANCE_M)
    room = np.float32(body.height_m - TOLERANCE_M)
    bits = 0
    for d in range(8):
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
