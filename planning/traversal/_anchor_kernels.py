"""Anchors on bare arrays: the point of each cell where a body has room, on or off the centre.

Whether a body gets through a door, up a flight or along a corridor must not depend on where the
centres of cells lie. Where the body does not fit at a centre, the anchor is pushed away from the
nearest barrier until the body fits, or until another barrier is as near: between two barriers that
is the middle of the passage. Links lead from anchor to anchor, straight or with one bend that is
found in the same way.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import (
    TOLERANCE_M,
    Measures,
    NearBarriers,
    height_to_climb,
    segment_barrier_distance,
)
from esplanade.planning.ground._geometry_kernels import crosses, nearest_on_segment
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.traversal.tiles import TileBox

SLACK_M = 0.007
"""A body fits where it has this much less room than its radius: links between anchors are checked
exactly, and what they lose by being straight is won back."""
LOW_ROOM_M = 0.05
"""Distance that the centre of a body keeps from what it does not step over, but could put a leg
over: its disc may reach beyond."""
_AIM_M = 0.02
"""A push aims at this much more room than the radius."""
_PUSHES = 12
_HALVINGS = 14
_ALONG_M = 0.03
"""Length of a move along the middle between two barriers."""


@inlined
def room_at(
    near: NearBarriers,
    body: Measures,
    cell: int,
    lowest: float,
    highest: float,
    x: float,
    y: float,
) -> tuple[float, float, float]:
    """Distance from a point to the nearest barrier in the list of a cell, and its nearest point.

    Low obstacles, up to leg length, count as further away, so that the body's radius suffices as
    distance from all. `lowest` and `highest` are the heights of the floors that matter.
    """
    best, bx, by = np.inf, x, y
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry]["barrier"]]
        entry = near.entries[entry]["next"]
        climb = height_to_climb(barrier, lowest, highest, body.height_m)
        if climb <= body.step_on_m + TOLERANCE_M:
            continue
        d, qx, qy = nearest_on_segment(
            x, y, barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        )
        if climb <= body.leg_length_m + TOLERANCE_M:
            d += max(0.0, body.radius_m - LOW_ROOM_M)
        if d < best:
            best, bx, by = d, qx, qy
    return best, bx, by


@inlined
def pushed(
    near: NearBarriers,
    body: Measures,
    cell: int,
    lowest: float,
    highest: float,
    x: float,
    y: float,
) -> tuple[float, float, float]:
    """A point with more room than a given one, reached without crossing a barrier, and its room."""
    want = body.radius_m + _AIM_M
    best, best_x, best_y = -1.0, x, y
    for _ in range(_PUSHES):
        d, qx, qy = room_at(near, body, cell, lowest, highest, x, y)
        if d > best:
            best, best_x, best_y = d, x, y
        apart = np.hypot(x - qx, y - qy)
        if d >= want or apart < 1e-6:
            break
        ux, uy = (x - qx) / apart, (y - qy) / apart
        low, high = 0.0, want - d
        if room_at(near, body, cell, lowest, highest, x + high * ux, y + high * uy)[0] >= (
            want - 1e-6
        ):
            x += high * ux
            y += high * uy
            continue
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            there = room_at(near, body, cell, lowest, highest, x + middle * ux, y + middle * uy)[0]
            if there >= d + middle - 1e-6:
                low = middle
            else:
                high = middle
        x += low * ux
        y += low * uy
        if low < 1e-3:
            # Two barriers are as near as each other: only the way between them is left.
            d, qx, qy = room_at(near, body, cell, lowest, highest, x, y)
            other, ox, oy = room_at(near, body, cell, lowest, highest, x + 2e-3 * ux, y + 2e-3 * uy)
            one, two = np.hypot(x - qx, y - qy), np.hypot(x - ox, y - oy)
            if one < 1e-6 or two < 1e-6 or other < 1e-6:
                break
            vx = (x - qx) / one + (x - ox) / two
            vy = (y - qy) / one + (y - oy) / two
            length = np.hypot(vx, vy)
            if length < 0.05:
                break
            along = min(_ALONG_M, want - d) / length
            x += along * vx
            y += along * vy
    d = room_at(near, body, cell, lowest, highest, x, y)[0]
    if d > best:
        best, best_x, best_y = d, x, y
    return best_x, best_y, best


@kernel
def place_anchors(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    box: TileBox,
    out: NDArray[np.float32],
) -> None:
    """Write the anchor of each cell of some tiles into `out` (N, 2), metres.

    Where the body fits nowhere in a cell, it is the centre.
    """
    half = 0.5 * arrays.cell_m
    for layer in range(arrays.pages.shape[0]):
        for tj in range(box.first_row, box.end_row):
            for ti in range(box.first_column, box.end_column):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                for k in range(TILE * TILE):
                    cell = page + k
                    x = arrays.x0 + (ti * TILE + (k & (TILE - 1)) + 0.5) * arrays.cell_m
                    y = arrays.y0 + (tj * TILE + k // TILE + 0.5) * arrays.cell_m
                    out[cell, 0] = x
                    out[cell, 1] = y
                    if near.first[cell] < 0 or np.isnan(arrays.floors[cell]):
                        continue
                    floor = float(arrays.floors[cell])
                    room = room_at(near, body, cell, floor, floor, x, y)[0]
                    if room >= body.radius_m - SLACK_M:
                        continue
                    px, py, room = pushed(near, body, cell, floor, floor, x, y)
                    if room >= body.radius_m - SLACK_M and max(abs(px - x), abs(py - y)) <= half:
                        out[cell, 0] = px
                        out[cell, 1] = py


@inlined
def is_way_clear(
    near: NearBarriers,
    body: Measures,
    cell: int,
    lowest: float,
    highest: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> bool:
    """Whether a body can go straight from a to b, as far as the list of one cell tells."""
    length = np.hypot(bx - ax, by - ay)
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry]["barrier"]]
        entry = near.entries[entry]["next"]
        climb = height_to_climb(barrier, lowest, highest, body.height_m)
        if climb <= body.step_on_m + TOLERANCE_M:
            continue
        need = body.radius_m - SLACK_M
        if climb <= body.leg_length_m + TOLERANCE_M:
            need = min(need, LOW_ROOM_M - SLACK_M)
        x0, y0, x1, y1 = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        if nearest_on_segment(ax, ay, x0, y0, x1, y1)[0] >= need + length:
            continue
        if crosses(barrier, ax, ay, bx, by):
            return False
        if segment_barrier_distance(barrier, ax, ay, bx, by) < need:
            return False
    return True


@inlined
def bend_between(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    anchors: NDArray[np.float32],
    one: int,
    two: int,
) -> tuple[int, float, float]:
    """Whether and how a body gets from the anchor of a cell to that of a neighbour.

    0: it does not; 1: straight; 2: by way of the point that is returned too. The result is the same
    in both directions.
    """
    if near.first[one] < 0 and near.first[two] < 0:
        return 1, 0.0, 0.0
    first, second = min(one, two), max(one, two)
    a, b = float(arrays.floors[first]), float(arrays.floors[second])
    lowest, highest = min(a, b), max(a, b)
    ax, ay = float(anchors[first, 0]), float(anchors[first, 1])
    bx, by = float(anchors[second, 0]), float(anchors[second, 1])
    if is_way_clear(near, body, first, lowest, highest, ax, ay, bx, by) and is_way_clear(
        near, body, second, lowest, highest, ax, ay, bx, by
    ):
        return 1, 0.0, 0.0
    mx, my = 0.5 * (ax + bx), 0.5 * (ay + by)
    px, py, room = pushed(near, body, first, lowest, highest, mx, my)
    if room < body.radius_m - SLACK_M or np.hypot(px - mx, py - my) > arrays.cell_m:
        return 0, 0.0, 0.0
    for cell in (first, second):
        if not (
            is_way_clear(near, body, cell, lowest, highest, ax, ay, px, py)
            and is_way_clear(near, body, cell, lowest, highest, px, py, bx, by)
        ):
            return 0, 0.0, 0.0
    return 2, px, py
