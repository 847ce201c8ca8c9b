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
    Measures,
    NearBarriers,
    height_to_climb,
    point_barrier_distance,
)
from esplanade.planning.ground._geometry_kernels import LOW_ROOM_M, TOLERANCE_M, nearest_on_segment
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.traversal.tiles import CellBox

SLACK_M = 0.007
"""A body fits where it has this much less room than its radius: links between anchors are checked
exactly, and what they lose by being straight is won back."""
PARTS = 254
"""Offsets of anchors are in this part of a cell, so that they fit into a byte."""
_MOST_PARTS = 126
_HALF_DIAGONAL = 0.7072
"""Of a cell, in cells."""
AIM_M = 0.04
"""A push aims at this much more room than the radius."""
LITTLE_M = 0.02
"""A push that would leave a narrow passage aims at this much more room."""
JUST_M = 0.01
"""A push that would leave even that passage aims at this much more room."""
WITHIN_M = 1e-6
EXACT_M = 1e-3
"""Anchors are rounded to parts of a cell, so that their distances are exact to this."""
_PUSHES = 12
_HALVINGS = 8
_ALONG_M = 0.03
"""Length of a move along the middle between two barriers."""


@inlined
def anchor_of(
    arrays: LayeredArrays, first: NDArray[np.int32], offsets: NDArray[np.int8], cell: int
) -> tuple[float, float]:
    """The point of a cell that paths go through, metres; `first` (N,) is that of `NearBarriers`."""
    u = arrays.places[cell]["column"] + 0.5
    v = arrays.places[cell]["row"] + 0.5
    entry = first[cell]
    if entry >= 0:
        u += offsets[entry, 0] / PARTS
        v += offsets[entry, 1] / PARTS
    return arrays.x0 + u * arrays.cell_m, arrays.y0 + v * arrays.cell_m


@inlined
def two_nearest(
    near: NearBarriers, body: Measures, cell: int, floor: float, x: float, y: float
) -> tuple[float, float, float, float]:
    """`room_at`, and the distance to the second nearest barrier, metres."""
    best, second, bx, by = np.inf, np.inf, x, y
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry]["barrier"]]
        entry = near.entries[entry]["next"]
        climb = height_to_climb(barrier, floor, floor, body.height_m)
        if climb <= body.step_on_m + TOLERANCE_M:
            continue
        d, qx, qy = nearest_on_segment(
            x, y, barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        )
        if climb <= body.leg_length_m + TOLERANCE_M:
            d += max(0.0, body.radius_m - LOW_ROOM_M)
        if d < best:
            best, second, bx, by = d, best, qx, qy
        elif d < second:
            second = d
    return best, bx, by, second


@inlined
def room_at(
    near: NearBarriers, body: Measures, cell: int, floor: float, x: float, y: float
) -> tuple[float, float, float]:
    """Distance from a point to the nearest barrier in the list of a cell, and its nearest point.

    Low obstacles, up to leg length, count as further away, so that the body's radius suffices as
    distance from all. `floor` is the height that they are seen from.
    """
    best, bx, by, _ = two_nearest(near, body, cell, floor, x, y)
    return best, bx, by


@kernel
def pushed(
    near: NearBarriers, body: Measures, cell: int, floor: float, x: float, y: float, aim: float
) -> tuple[float, float, float]:
    """A point with more room than a given one, reached without crossing a barrier, and its room.

    It is pushed until it has `aim` metres more room than the body's radius, if there is so much.
    """
    want = body.radius_m + aim
    best, best_x, best_y = -1.0, x, y
    for _ in range(_PUSHES):
        d, qx, qy = room_at(near, body, cell, floor, x, y)
        if d > best:
            best, best_x, best_y = d, x, y
        apart = np.hypot(x - qx, y - qy)
        if d >= want or apart < 1e-6:
            break
        ux, uy = (x - qx) / apart, (y - qy) / apart
        low, high = 0.0, want - d
        if room_at(near, body, cell, floor, x + high * ux, y + high * uy)[0] >= want - 1e-6:
            x += high * ux
            y += high * uy
            continue
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            there = room_at(near, body, cell, floor, x + middle * ux, y + middle * uy)[0]
            if there >= d + middle - 1e-6:
                low = middle
            else:
                high = middle
        x += low * ux
        y += low * uy
        if low < 2e-3:
            # Two barriers are as near as each other: only the way between them is left.
            d, qx, qy = room_at(near, body, cell, floor, x, y)
            other, ox, oy = room_at(near, body, cell, floor, x + 3e-3 * ux, y + 3e-3 * uy)
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
    d = room_at(near, body, cell, floor, x, y)[0]
    if d > best:
        best, best_x, best_y = d, x, y
    return best_x, best_y, best


ANY = -1
"""Instead of the row of a barrier that has changed: everything is derived."""


@inlined
def is_listed(near: NearBarriers, cell: int, row: int) -> bool:
    """Whether the list of a cell has a barrier, or any is meant."""
    if row == ANY:
        return True
    entry = near.first[cell]
    while entry >= 0:
        if near.entries[entry]["barrier"] == row:
            return True
        entry = near.entries[entry]["next"]
    return False


@kernel
def place_anchors(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    box: CellBox,
    row: int,
    offsets: NDArray[np.int8],
    rooms: NDArray[np.float32],
) -> None:
    """Write where the anchors of some cells are: offsets from their centres (E, 2).

    The offset of a cell is in the row of the first entry of its list; a cell without has none.

    `rooms` (N,) is the distance from an anchor to the nearest barrier, as `room_at` has it, as far
    as the list of its cell tells. Where the body fits nowhere in a cell, the anchor is the centre.
    Anchors stay where they are in cells that do not list the barrier `row`, unless it is `ANY`.
    """
    part_m = arrays.cell_m / PARTS
    most_m = _MOST_PARTS * part_m
    reach = np.float32(near.reach_m)
    least = body.radius_m - EXACT_M
    for layer in range(arrays.pages.shape[0]):
        for tj in range(box.first_row // TILE, (box.end_row - 1) // TILE + 1):
            for ti in range(box.first_column // TILE, (box.end_column - 1) // TILE + 1):
                page = arrays.pages[layer, tj, ti]
                if page < 0:
                    continue
                for j in range(max(box.first_row, tj * TILE), min(box.end_row, (tj + 1) * TILE)):
                    first = max(box.first_column, ti * TILE)
                    for i in range(first, min(box.end_column, (ti + 1) * TILE)):
                        cell = page + (j - tj * TILE) * TILE + i - ti * TILE
                        rooms[cell] = reach
                        entry = near.first[cell]
                        if entry < 0:
                            continue
                        floor = float(arrays.floors[cell])
                        if not is_listed(near, cell, row):
                            u, v = offsets[entry, 0] * part_m, offsets[entry, 1] * part_m
                            ax, ay = anchor_of(arrays, near.first, offsets, cell)
                            there = room_at(near, body, cell, floor, ax, ay)[0]
                            rooms[cell] = min(there, near.reach_m - np.hypot(u, v))
                            if u != 0.0 or v != 0.0:
                                rooms[cell] = min(rooms[cell], body.radius_m + AIM_M)
                            continue
                        offsets[entry, 0] = 0
                        offsets[entry, 1] = 0
                        x = arrays.x0 + (i + 0.5) * arrays.cell_m
                        y = arrays.y0 + (j + 0.5) * arrays.cell_m
                        room, qx, qy, second = two_nearest(near, body, cell, floor, x, y)
                        rooms[cell] = min(room, near.reach_m)
                        if not least - _HALF_DIAGONAL * arrays.cell_m <= room < body.radius_m:
                            continue
                        if not _may_fit(near, body, cell, floor, x, y, most_m):
                            continue
                        away = (room, qx, qy, second)
                        dx, dy, two = _push(near, body, cell, floor, x, y, away)
                        u, v, there = _within_cell(near, body, cell, floor, x, y, dx, dy, part_m)
                        out = max(abs(dx), abs(dy)) > most_m
                        if two and out and not (there >= least and there > room):
                            # It was pushed on along the passage, out of its cell.
                            px, py, _ = pushed(near, body, cell, floor, x, y, LITTLE_M)
                            dx, dy = px - x, py - y
                            u, v, there = _within_cell(
                                near, body, cell, floor, x, y, dx, dy, part_m
                            )
                        if there >= least and there > room:
                            offsets[entry, 0] = u
                            offsets[entry, 1] = v
                            there = min(
                                there,
                                body.radius_m + AIM_M,
                                near.reach_m - part_m * np.hypot(u, v),
                            )
                            rooms[cell] = there


@inlined
def _within_cell(
    near: NearBarriers,
    body: Measures,
    cell: int,
    floor: float,
    x: float,
    y: float,
    dx: float,
    dy: float,
    part_m: float,
) -> tuple[int, int, float]:
    """A displacement from a centre in parts of a cell, cut off at its edge, and the room there."""
    far = max(abs(dx), abs(dy)) / (_MOST_PARTS * part_m)
    if far > 1.0:
        dx /= far
        dy /= far
    u, v = int(np.round(dx / part_m)), int(np.round(dy / part_m))
    return u, v, room_at(near, body, cell, floor, x + u * part_m, y + v * part_m)[0]


@inlined
def _may_fit(
    near: NearBarriers, body: Measures, cell: int, floor: float, x: float, y: float, most: float
) -> bool:
    """Whether no single barrier takes up a whole square around a point, `most` to each side."""
    entry = near.first[cell]
    while entry >= 0:
        barrier = near.barriers[near.entries[entry]["barrier"]]
        entry = near.entries[entry]["next"]
        climb = height_to_climb(barrier, floor, floor, body.height_m)
        if climb <= body.step_on_m + TOLERANCE_M:
            continue
        need = body.radius_m
        if climb <= body.leg_length_m + TOLERANCE_M:
            need = min(need, LOW_ROOM_M)
        if (
            point_barrier_distance(barrier, x - most, y - most) < need
            and point_barrier_distance(barrier, x + most, y + most) < need
            and point_barrier_distance(barrier, x - most, y + most) < need
            and point_barrier_distance(barrier, x + most, y - most) < need
        ):
            return False  # distances from a barrier are greatest in a corner
    return True


@inlined
def _push(
    near: NearBarriers,
    body: Measures,
    cell: int,
    floor: float,
    x: float,
    y: float,
    nearest: tuple[float, float, float, float],
) -> tuple[float, float, bool]:
    """`pushed` as a displacement, and whether more than one barrier counts; cheap with one.

    `nearest` are the distance of the nearest barrier, the point of it that is, and the distance of
    the next.
    """
    room, qx, qy, second = nearest
    away = body.radius_m + AIM_M - room
    apart = np.sqrt((x - qx) * (x - qx) + (y - qy) * (y - qy))
    if apart > WITHIN_M:
        dx, dy = away * (x - qx) / apart, away * (y - qy) / apart
        if (
            second - away >= room + away
            or room_at(near, body, cell, floor, x + dx, y + dy)[0] >= room + away - WITHIN_M
        ):
            return dx, dy, False
    px, py, _ = pushed(near, body, cell, floor, x, y, AIM_M)
    return px - x, py - y, True
