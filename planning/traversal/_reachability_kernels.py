"""Reachability on bare arrays: the links that a body may follow from each cell."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import (
    TOLERANCE_M,
    Measures,
    NearBarriers,
    height_to_climb,
    point_barrier_distance,
)
from esplanade.planning.ground._geometry_kernels import crosses, point_segment_distance
from esplanade.planning.ground.layered import LINK_COLUMNS, LINK_ROWS, TILE, LayeredArrays

_TOUCH_M4 = 1e-12
"""A step may touch a line if the signed areas of its ends with the line multiply to no more."""


class TileBox(NamedTuple):
    """A rectangle of tiles; the last row and column are excluded."""

    first_row: int
    first_column: int
    end_row: int
    end_column: int


@inlined
def _barred_bits(
    arrays: LayeredArrays, near: NearBarriers, body: Measures, cell: int, bits: int
) -> int:
    """The steps of a cell, of those in `bits`, that barriers bar to the body.

    A body that is clear of an obstacle at both ends of a step must also not clip a corner of the
    obstacle between them.
    """
    floors, links, cell_m = arrays.floors, arrays.links, arrays.cell_m
    lowest = highest = floors[cell]
    for d in range(8):
        if bits >> d & 1:
            lowest = min(lowest, floors[links[cell, d]])
            highest = max(highest, floors[links[cell, d]])
    x = arrays.x0 + (arrays.places[cell]["column"] + 0.5) * cell_m
    y = arrays.y0 + (arrays.places[cell]["row"] + 0.5) * cell_m
    radius = body.radius_m - TOLERANCE_M
    beyond = body.radius_m + 1.5 * cell_m
    barred = 0
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry]["barrier"]]
        entry = near.entries[entry]["next"]
        if height_to_climb(barrier, lowest, highest, body.height_m) <= body.step_on_m + TOLERANCE_M:
            continue
        x0, y0, x1, y1 = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        along_x, along_y = x1 - x0, y1 - y0
        side = along_x * (y - y0) - along_y * (x - x0)
        may_clip = (
            max(abs(x0 - x), abs(y0 - y)) < beyond or max(abs(x1 - x), abs(y1 - y)) < beyond
        ) and point_barrier_distance(barrier, x, y) >= radius
        for d in range(8):
            if not (bits & ~barred) >> d & 1:
                continue
            dx, dy = LINK_COLUMNS[d] * cell_m, LINK_ROWS[d] * cell_m
            is_across = side * (side + along_x * dy - along_y * dx) <= _TOUCH_M4
            if not (is_across or may_clip):
                continue
            other = links[cell, d]
            step = height_to_climb(
                barrier,
                float(min(floors[cell], floors[other])),
                float(max(floors[cell], floors[other])),
                body.height_m,
            )
            if step <= body.step_on_m + TOLERANCE_M:
                continue
            if (is_across and crosses(barrier, x, y, x + dx, y + dy)) or (
                may_clip
                and step > body.leg_length_m + TOLERANCE_M
                and _clips_corner(barrier, x, y, x + dx, y + dy, radius)
            ):
                barred |= 1 << d
    return barred


@inlined
def _clips_corner(
    barrier: np.void, ax: float, ay: float, bx: float, by: float, radius: float
) -> bool:
    """Whether a disc touches a barrier between a and b although it does not in a or b."""
    px, py, qx, qy = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
    return (
        min(
            point_segment_distance(px, py, ax, ay, bx, by),
            point_segment_distance(qx, qy, ax, ay, bx, by),
        )
        < radius
        <= point_segment_distance(bx, by, px, py, qx, qy)
    )


@kernel
def step_bits(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
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
                    if bits and near.first[cell] >= 0:
                        bits &= ~_barred_bits(arrays, near, body, cell, bits)
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
