"""Where a body may step from each cell, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import (
    HAIR_M,
    Measures,
    NearBarriers,
    crosses,
    point_to_segment,
    to_raise,
)
from esplanade.planning.ground.layered import LINK_COLUMNS, LINK_ROWS, TILE, LayeredArrays

Box = tuple[int, int, int, int]
"""Tiles to work on: first row, first column, row after the last, column after the last."""
_TOUCH_M4 = 1e-12
"""Two points whose sides of a line multiply to less may touch it."""


@inlined
def _barred_bits(
    arrays: LayeredArrays, near: NearBarriers, body: Measures, cell: int, bits: int
) -> int:
    """Those of a cell's steps on which a barrier stops the body.

    Who is clear of an obstacle at both ends must not clip its corner between them either.
    """
    floors, links, cell_m = arrays.floors, arrays.links, arrays.cell_m
    lowest = highest = floors[cell]
    for d in range(8):
        if bits >> d & 1:
            lowest = min(lowest, floors[links[cell, d]])
            highest = max(highest, floors[links[cell, d]])
    x = arrays.x0 + (arrays.places[cell, 2] + 0.5) * cell_m
    y = arrays.y0 + (arrays.places[cell, 1] + 0.5) * cell_m
    radius = body.radius_m - HAIR_M
    beyond = body.radius_m + 1.5 * cell_m
    barred = 0
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry, 0]]
        entry = near.entries[entry, 1]
        if to_raise(barrier, lowest, highest, body.height_m) <= body.step_on_m + HAIR_M:
            continue
        along_x, along_y = barrier[2] - barrier[0], barrier[3] - barrier[1]
        side = along_x * (y - barrier[1]) - along_y * (x - barrier[0])
        may_clip = (
            max(abs(barrier[0] - x), abs(barrier[1] - y)) < beyond
            or max(abs(barrier[2] - x), abs(barrier[3] - y)) < beyond
        ) and point_to_segment(x, y, barrier[0], barrier[1], barrier[2], barrier[3]) >= radius
        for d in range(8):
            if not (bits & ~barred) >> d & 1:
                continue
            dx, dy = LINK_COLUMNS[d] * cell_m, LINK_ROWS[d] * cell_m
            is_across = side * (side + along_x * dy - along_y * dx) <= _TOUCH_M4
            if not (is_across or may_clip):
                continue
            other = links[cell, d]
            step = to_raise(
                barrier,
                float(min(floors[cell], floors[other])),
                float(max(floors[cell], floors[other])),
                body.height_m,
            )
            if step <= body.step_on_m + HAIR_M:
                continue
            if (is_across and crosses(barrier, x, y, x + dx, y + dy)) or (
                may_clip
                and step > body.leg_length_m + HAIR_M
                and _clips_corner(barrier, x, y, x + dx, y + dy, radius)
            ):
                barred |= 1 << d
    return barred


@inlined
def _clips_corner(
    barrier: NDArray[np.float64], ax: float, ay: float, bx: float, by: float, radius: float
) -> bool:
    """Whether a disc that does not touch a barrier in a or b does so on the way between them."""
    px, py, qx, qy = barrier[0], barrier[1], barrier[2], barrier[3]
    return (
        min(point_to_segment(px, py, ax, ay, bx, by), point_to_segment(qx, qy, ax, ay, bx, by))
        < radius
        <= point_to_segment(bx, by, px, py, qx, qy)
    )


@kernel
def step_bits(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    box: Box,
    out: NDArray[np.uint8],
) -> None:
    """Write for each cell of some tiles the links that a body may follow; bit d is link d."""
    tiles_y, tiles_x = arrays.pages.shape[1:]
    for layer in range(arrays.pages.shape[0]):
        for tj in range(box[0], box[2]):
            for ti in range(box[1], box[3]):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                is_inner = 0 < tj < tiles_y - 1 and 0 < ti < tiles_x - 1
                plain = arrays.plain[page // (TILE * TILE)]
                is_open = is_inner and plain >= body.height_m - HAIR_M
                for cell in range(page, page + TILE * TILE):
                    bits = 255 if is_open else _bits_by_heights(arrays, body, cell)
                    if bits and near.first[cell] >= 0:
                        bits &= ~_barred_bits(arrays, near, body, cell, bits)
                    out[cell] = bits


@inlined
def _bits_by_heights(arrays: LayeredArrays, body: Measures, cell: int) -> int:
    floor = arrays.floors[cell]
    if np.isnan(floor):
        return 0
    ceiling = arrays.ceilings[cell]
    step = np.float32(body.step_on_m + HAIR_M)
    room = np.float32(body.height_m - HAIR_M)
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
    """Mark all cells that steps lead to from some cells, in `out` preset to False; their number."""
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
