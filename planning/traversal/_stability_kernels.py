"""The five classes of cells of Huang & Li, sec. 4.2, on bare arrays, tile by tile."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import (
    Measures,
    NearBarriers,
    height_to_climb,
    point_barrier_distance,
)
from esplanade.planning.ground._geometry_kernels import TOLERANCE_M
from esplanade.planning.ground.layered import LINK_ROOM_M, TILE, LayeredArrays, cell_index
from esplanade.planning.traversal._anchor_kernels import SLACK_M, anchor_of
from esplanade.planning.traversal.tiles import TileBox

FORBIDDEN, STABLE, UNSTABLE, UP_STAIR, DOWN_STAIR = range(5)

RAMP_SLOPE = 0.35
"""Ground that rises by less than this part of its length (19 degrees) is flat; steeper ground
counts as an edge."""

OFFSET = np.dtype([("rows", "i8"), ("columns", "i8")])
"""The offset from a cell to another."""


@kernel
def classify(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    anchors: NDArray[np.int8],
    offsets: NDArray[np.void],
    box: TileBox,
    out: NDArray[np.uint8],
) -> None:
    """Write the class of each cell of some tiles into `out` (N,).

    `anchors` (E, 2) are `Traversability.offsets`; `offsets` (K,) of `OFFSET` lead from a cell to
    the others that the body's disc touches.
    """
    reach = 0
    for k in range(len(offsets)):
        reach = max(reach, abs(offsets[k]["rows"]), abs(offsets[k]["columns"]))
    side = TILE + 2 * reach
    floors = np.empty((side, side), dtype=np.float32)
    ceilings = np.empty((side, side), dtype=np.float32)
    edges = np.empty(len(offsets), dtype=np.float32)
    for k in range(len(offsets)):
        edges[k] = (
            RAMP_SLOPE * arrays.cell_m * np.hypot(offsets[k]["rows"], offsets[k]["columns"])
            + TOLERANCE_M
        )
    for layer in range(arrays.pages.shape[0]):
        for tj in range(box.first_row, box.end_row):
            for ti in range(box.first_column, box.end_column):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                headroom = arrays.level_headroom[page // (TILE * TILE)]
                if reach <= TILE and headroom >= body.height_m - TOLERANCE_M:
                    out[page : page + TILE * TILE] = STABLE
                else:
                    _gather(arrays, layer, tj * TILE, ti * TILE, reach, floors, ceilings)
                    for k in range(TILE * TILE):
                        out[page + k] = _class_by_heights(
                            arrays, body, layer, page + k, offsets, edges, floors, ceilings, reach
                        )
                for cell in range(page, page + TILE * TILE):
                    if near.first[cell] >= 0 and out[cell] != FORBIDDEN:
                        out[cell] = _class_by_barriers(arrays, near, body, anchors, cell, out[cell])


@inlined
def _gather(
    arrays: LayeredArrays,
    layer: int,
    j0: int,
    i0: int,
    reach: int,
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
) -> None:
    """Copy the heights of a tile and of the cells around it, up to `reach` cells away.

    Heights outside of the grid are inf, which is no obstacle; those of holes are nan.
    """
    tiles_y, tiles_x = arrays.pages.shape[1:]
    side = TILE + 2 * reach
    for tj in range((j0 - reach) // TILE, (j0 + TILE - 1 + reach) // TILE + 1):
        for ti in range((i0 - reach) // TILE, (i0 + TILE - 1 + reach) // TILE + 1):
            top = max(0, tj * TILE - j0 + reach)
            bottom = min(side, (tj + 1) * TILE - j0 + reach)
            left = max(0, ti * TILE - i0 + reach)
            right = min(side, (ti + 1) * TILE - i0 + reach)
            page = -1
            if 0 <= tj < tiles_y and 0 <= ti < tiles_x:
                page = arrays.pages[layer, tj, ti]
            for v in range(top, bottom):
                j = j0 - reach + v
                for u in range(left, right):
                    i = i0 - reach + u
                    if not (0 <= j < arrays.ny and 0 <= i < arrays.nx):
                        floors[v, u] = np.inf
                        ceilings[v, u] = np.inf
                        continue
                    floors[v, u] = np.nan
                    if page >= 0:
                        cell = page + (j - tj * TILE) * TILE + i - ti * TILE
                        floors[v, u] = arrays.floors[cell]
                        ceilings[v, u] = arrays.ceilings[cell]


@inlined
def _class_by_heights(
    arrays: LayeredArrays,
    body: Measures,
    layer: int,
    cell: int,
    offsets: NDArray[np.void],
    edges: NDArray[np.float32],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
    reach: int,
) -> int:
    """The class of a cell by the heights around it, without regard to barriers."""
    j, i = arrays.places[cell]["row"], arrays.places[cell]["column"]
    v = (j & (TILE - 1)) + reach
    u = (i & (TILE - 1)) + reach
    floor = floors[v, u]
    leg = np.float32(body.leg_length_m + TOLERANCE_M)
    room = np.float32(body.height_m - TOLERANCE_M)
    if np.isnan(floor) or np.isinf(floor) or ceilings[v, u] - floor < room:
        return FORBIDDEN
    is_edge = False
    is_obstacle = False
    for k in range(len(offsets)):
        b = v + offsets[k]["rows"]
        a = u + offsets[k]["columns"]
        other = floors[b, a]
        if other == np.inf:
            continue
        difference = abs(other - floor)
        if np.isnan(other) or difference > leg:
            is_obstacle = True
        elif min(ceilings[b, a], ceilings[v, u]) - max(other, floor) < LINK_ROOM_M:
            is_obstacle = True  # a floor above or below another, such as that under a ramp
        elif min(ceilings[b, a], ceilings[v, u]) - max(other, floor) < room:
            continue  # what is too low for the head is a barrier
        elif difference > edges[k]:
            is_edge = True
    if not is_obstacle:
        return UNSTABLE if is_edge else STABLE
    for other_layer in range(layer + 1, arrays.pages.shape[0]):
        if _is_within_leg(arrays, other_layer, j, i, floor, leg, offsets):
            return UP_STAIR
    for other_layer in range(layer - 1, -1, -1):
        if _is_within_leg(arrays, other_layer, j, i, floor, leg, offsets):
            return DOWN_STAIR
    # Whether the obstacle is within the body's radius is for the barrier around it to say.
    return UNSTABLE if is_edge else STABLE


@inlined
def _is_within_leg(
    arrays: LayeredArrays,
    layer: int,
    j: int,
    i: int,
    floor: np.float32,
    leg: np.float32,
    offsets: NDArray[np.void],
) -> bool:
    """Whether a layer has a floor around a cell that differs in height by leg length at most."""
    for k in range(len(offsets)):
        cell = cell_index(arrays, layer, j + offsets[k]["rows"], i + offsets[k]["columns"])
        if cell >= 0 and abs(arrays.floors[cell] - floor) <= leg:
            return True
    return False


@inlined
def _class_by_barriers(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    anchors: NDArray[np.int8],
    cell: int,
    by_heights: int,
) -> int:
    """The class of a cell when barriers within the body's radius are taken into account too."""
    found = by_heights
    floor = float(arrays.floors[cell])
    x, y = anchor_of(arrays, near.first, anchors, cell)
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry]["barrier"]]
        entry = near.entries[entry]["next"]
        step = height_to_climb(barrier, floor, floor, body.height_m)
        if step <= RAMP_SLOPE * arrays.cell_m + TOLERANCE_M:
            continue
        if point_barrier_distance(barrier, x, y) >= body.radius_m - SLACK_M:
            continue
        if step > body.leg_length_m + TOLERANCE_M:
            return FORBIDDEN
        if found == STABLE:
            found = UNSTABLE
    return found
