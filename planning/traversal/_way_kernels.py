"""Steps between anchors on bare arrays: whether and how a body gets from one to the next.

A step is straight, or has one bend where a straight one is barred: the point that the middle of the
step is pushed to, or one past the end of what bars it.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import Measures, NearBarriers, height_to_climb
from esplanade.planning.ground._geometry_kernels import (
    LOW_ROOM_M,
    TOLERANCE_M,
    crosses,
    nearest_on_segment,
    point_segment_distance,
)
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.traversal._anchor_kernels import (
    AIM_M,
    EXACT_M,
    JUST_M,
    LITTLE_M,
    SLACK_M,
    WITHIN_M,
    anchor_of,
    is_listed,
    pushed,
    room_at,
    two_nearest,
)

_LEVEL_M = 1e-4
"""Floors that differ by less see the same barriers."""

CLEAR, BARRED, BLOCKED = range(3)
"""A way is clear, too near a barrier or past the end of one, or blocked by a long barrier."""


@inlined
def way_through(
    near: NearBarriers,
    body: Measures,
    cell: int,
    lowest: float,
    highest: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    aside: float,
    fits: bool,
    rises: bool,
    but: int,
) -> int:
    """Whether a body can go straight from a to b, as far as the list of one cell tells.

    Barriers may not be crossed, seen from the `lowest` floor, and distance is kept from what is an
    obstacle even from the `highest` one: the other end of the way sees to its own. If it `rises`,
    a is on the lowest floor and b on the highest; what the body passes below on the lowest matters
    from the middle on. BLOCKED means that a barrier is crossed whose ends are further than `aside`
    from the middle. With `fits` both ends are known to be far enough from all; what the list of the
    cell `but` has is left out.
    """
    from_x, from_y = ax, ay
    length = np.sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay))
    found = CLEAR
    entry = near.first[cell]
    while entry >= 0:
        row = near.entries[entry]["barrier"]
        barrier = near.barriers[row]
        entry = near.entries[entry]["next"]
        climb = height_to_climb(barrier, lowest, highest, body.height_m)
        if climb <= body.step_on_m + TOLERANCE_M:
            continue
        if lowest < highest:
            climb = height_to_climb(barrier, highest, highest, body.height_m)
        need = 0.0
        if climb > body.leg_length_m + TOLERANCE_M:
            need = body.radius_m - SLACK_M
        elif climb > body.step_on_m + TOLERANCE_M:
            need = min(body.radius_m, LOW_ROOM_M) - SLACK_M
        full = need + SLACK_M - EXACT_M if need > 0.0 else 0.0
        if rises:
            ax, ay = from_x, from_y
            if barrier["bottom_m"] >= lowest + body.height_m - TOLERANCE_M:
                ax, ay = 0.5 * (from_x + bx), 0.5 * (from_y + by)
        x0, y0, x1, y1 = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        dx, dy = x1 - x0, y1 - y0
        left_a = dx * (ay - y0) - dy * (ax - x0)
        left_b = dx * (by - y0) - dy * (bx - x0)
        least = min(abs(left_a), abs(left_b))
        if left_a * left_b > 0.0 and least * least >= full * full * (dx * dx + dy * dy):
            continue  # a and b are far enough from its line, on the same side
        if nearest_on_segment(ax, ay, x0, y0, x1, y1)[0] > full + length:
            continue
        if but >= 0 and is_listed(near, but, row):
            continue
        if crosses(barrier, ax, ay, bx, by):
            mx, my = 0.5 * (ax + bx), 0.5 * (ay + by)
            if min(np.hypot(x0 - mx, y0 - my), np.hypot(x1 - mx, y1 - my)) > aside:
                return BLOCKED
            found = BARRED
            continue
        apart, cx, cy, qx, qy = _closest(x0, y0, x1, y1, ax, ay, bx, by, fits)
        if apart < need or (
            apart < full
            and not _has_room_aside(near, body, cell, highest, cx, cy, qx, qy, need + SLACK_M)
        ):
            found = BARRED
    return found


@inlined
def _closest(
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    ends_only: bool,
) -> tuple[float, float, float, float, float]:
    """Distance of a barrier and a segment ab that do not cross, and the points where they are
    nearest: that of ab, then that of the barrier; with `ends_only` from the barrier's ends alone.
    """
    apart, cx, cy = nearest_on_segment(x0, y0, ax, ay, bx, by)
    qx, qy = x0, y0
    d, px, py = nearest_on_segment(x1, y1, ax, ay, bx, by)
    if d < apart:
        apart, cx, cy, qx, qy = d, px, py, x1, y1
    if not ends_only:
        for x, y in ((ax, ay), (bx, by)):
            d, px, py = nearest_on_segment(x, y, x0, y0, x1, y1)
            if d < apart:
                apart, cx, cy, qx, qy = d, x, y, px, py
    return apart, cx, cy, qx, qy


@inlined
def _has_room_aside(
    near: NearBarriers,
    body: Measures,
    cell: int,
    floor: float,
    cx: float,
    cy: float,
    qx: float,
    qy: float,
    room: float,
) -> bool:
    """Whether a body that comes too near a barrier at c, by less than the slack, may give way.

    The point q of the barrier is nearest to c; `room` is the distance to keep. Without that room a
    passage is narrower than the body.
    """
    apart = np.hypot(cx - qx, cy - qy)
    if apart < WITHIN_M:
        return False
    part = room / apart
    px, py = qx + part * (cx - qx), qy + part * (cy - qy)
    return bool(room_at(near, body, cell, floor, px, py)[0] >= body.radius_m - EXACT_M)


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
    return bool(
        way_through(near, body, cell, lowest, highest, ax, ay, bx, by, 0.0, False, False, -1)
        == CLEAR
    )


@inlined
def _straight_between(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    offsets: NDArray[np.int8],
    first: int,
    second: int,
    fit: bool,
) -> int:
    """Whether a body gets straight from the anchor of a cell to that of a neighbour.

    `fit` tells that the body is known to fit at both.
    """
    a, b = float(arrays.floors[first]), float(arrays.floors[second])
    lowest, highest = min(a, b), max(a, b)
    ax, ay = anchor_of(arrays, near.first, offsets, first)
    bx, by = anchor_of(arrays, near.first, offsets, second)
    if a > b:
        ax, ay, bx, by = bx, by, ax, ay
    aside = max(arrays.cell_m, 0.5 * np.sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay)))
    rises = highest - lowest >= _LEVEL_M
    fits = fit and not rises
    found = way_through(near, body, first, lowest, highest, ax, ay, bx, by, aside, fits, rises, -1)
    if found != BLOCKED:
        then = way_through(
            near, body, second, lowest, highest, ax, ay, bx, by, aside, fits, rises, first
        )
        found = max(found, then)
    return found


@kernel
def bend_between(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    offsets: NDArray[np.int8],
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
    found = _straight_between(arrays, near, body, offsets, first, second, False)
    if found == CLEAR:
        return 1, 0.0, 0.0
    if found == BLOCKED:
        return 0, 0.0, 0.0
    leads, x, y = _bend_past(arrays, near, body, offsets, first, second)
    return 2 if leads else 0, x, y


@kernel
def _bend_past(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    offsets: NDArray[np.int8],
    first: int,
    second: int,
) -> tuple[bool, float, float]:
    """Whether one bend leads past barriers that are in the straight way between two anchors."""
    a, b = float(arrays.floors[first]), float(arrays.floors[second])
    lowest, highest = min(a, b), max(a, b)
    ax, ay = anchor_of(arrays, near.first, offsets, first)
    bx, by = anchor_of(arrays, near.first, offsets, second)
    mx, my = 0.5 * (ax + bx), 0.5 * (ay + by)
    if not (
        _has_two(near, body, first, lowest, mx, my) or _has_two(near, body, second, lowest, mx, my)
    ):
        return False, 0.0, 0.0  # it is open there, and other steps lead around the end
    cells = (first, second)
    heights = (lowest, highest)
    ends = (ax, ay, bx, by)
    found, px, py = _bend_from(arrays, near, body, cells, heights, ends, mx, my, AIM_M)
    if found == CLEAR:
        return True, px, py
    if found == BARRED:
        # Between corners that lie aslant the middle of the step is pushed out of the passage.
        lacks, tx, ty = _tightest(near, body, cells, heights, ends)
        if lacks < AIM_M:
            found, px, py = _bend_from(arrays, near, body, cells, heights, ends, tx, ty, LITTLE_M)
            if found == CLEAR:
                return True, px, py
        found, px, py = _bend_from(arrays, near, body, cells, heights, ends, mx, my, JUST_M)
        if found == CLEAR:
            return True, px, py
    # Past the end of what bars the way there may be a gap, such as a door beside its post.
    for cell in cells:
        entry = near.first[cell]
        while entry >= 0:
            row = near.entries[entry]["barrier"]
            barrier = near.barriers[row]
            entry = near.entries[entry]["next"]
            climb = height_to_climb(barrier, lowest, highest, body.height_m)
            if climb <= body.step_on_m + TOLERANCE_M:
                continue
            x0, y0, x1, y1 = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
            if np.hypot(x1 - mx, y1 - my) < np.hypot(x0 - mx, y0 - my):
                x0, y0, x1, y1 = x1, y1, x0, y0
            long = np.hypot(x1 - x0, y1 - y0)
            if long < 1e-6 or point_segment_distance(x0, y0, ax, ay, bx, by) > body.radius_m:
                continue
            if cell == second and is_listed(near, first, row):
                continue
            part = body.radius_m / long
            sx, sy = x0 + part * (x0 - x1), y0 + part * (y0 - y1)
            if room_at(near, body, first, highest, sx, sy)[0] >= body.radius_m - WITHIN_M:
                continue  # it is open there, and other steps lead around the end
            found, px, py = _bend_from(arrays, near, body, cells, heights, ends, sx, sy, AIM_M)
            if found == CLEAR:
                return True, px, py
    return False, 0.0, 0.0


@kernel
def _tightest(
    near: NearBarriers,
    body: Measures,
    cells: tuple[int, int],
    heights: tuple[float, float],
    ends: tuple[float, float, float, float],
) -> tuple[float, float, float]:
    """The point of the straight way between two ends that is nearest to what bars it.

    Returns the distance from it that the body lacks there, and the point; or any point where it
    lacks `AIM_M` or more.
    """
    ax, ay, bx, by = ends
    mx, my = 0.5 * (ax + bx), 0.5 * (ay + by)
    reach = body.radius_m + 0.5 * np.hypot(bx - ax, by - ay)
    best, x, y = np.inf, mx, my
    for cell in cells:
        entry = near.first[cell]
        while entry >= 0:
            barrier = near.barriers[near.entries[entry]["barrier"]]
            entry = near.entries[entry]["next"]
            climb = height_to_climb(barrier, heights[0], heights[1], body.height_m)
            if climb <= body.step_on_m + TOLERANCE_M:
                continue
            x0, y0, x1, y1 = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
            if point_segment_distance(mx, my, x0, y0, x1, y1) > reach:
                continue
            apart, cx, cy, _, _ = _closest(x0, y0, x1, y1, ax, ay, bx, by, False)
            if climb <= body.leg_length_m + TOLERANCE_M:
                apart += max(0.0, body.radius_m - LOW_ROOM_M)
            if apart < best:
                best, x, y = apart, cx, cy
                if body.radius_m - best >= AIM_M:
                    return body.radius_m - best, x, y
    return body.radius_m - best, x, y


@inlined
def _has_two(
    near: NearBarriers, body: Measures, cell: int, floor: float, x: float, y: float
) -> bool:
    """Whether the list of a cell has more than one barrier that stops a body."""
    return bool(two_nearest(near, body, cell, floor, x, y)[3] < np.inf)


@inlined
def _bend_from(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    cells: tuple[int, int],
    heights: tuple[float, float],
    ends: tuple[float, float, float, float],
    x: float,
    y: float,
    aim: float,
) -> tuple[int, float, float]:
    """Whether a body gets from one end to the other by the point that (x, y) is pushed to.

    BLOCKED means that it fits nowhere near that point, BARRED that it gets there from one end at
    most.
    """
    lowest, highest = heights
    ax, ay, bx, by = ends
    px, py, room = pushed(near, body, cells[0], highest, x, y, aim)
    if room < body.radius_m - EXACT_M:
        return BLOCKED, px, py
    if np.hypot(px - 0.5 * (ax + bx), py - 0.5 * (ay + by)) > arrays.cell_m:
        return BARRED, px, py
    for cell in cells:
        if not (
            is_way_clear(near, body, cell, lowest, highest, ax, ay, px, py)
            and is_way_clear(near, body, cell, lowest, highest, px, py, bx, by)
        ):
            return BARRED, px, py
    return CLEAR, px, py


@inlined
def leads_on(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Measures,
    offsets: NDArray[np.int8],
    rooms: NDArray[np.float32],
    one: int,
    two: int,
    aslant: int,
) -> bool:
    """Whether a body gets from the anchor of a cell to that of a neighbour; cheap in the open.

    `aslant` is 1 if the neighbour is in another row and column, else 0.
    Nowhere between two points does a body have less room than half of what it has at both, less
    the way between them.
    """
    exact = body.radius_m - EXACT_M
    least = min(rooms[one], rooms[two])
    if least < exact:
        return False
    if abs(arrays.floors[one] - arrays.floors[two]) < _LEVEL_M:
        way2 = (2.0 if aslant else 1.0) * arrays.cell_m * arrays.cell_m
        if least <= body.radius_m + AIM_M + WITHIN_M:  # an anchor may be off its centre
            ax, ay = anchor_of(arrays, near.first, offsets, one)
            bx, by = anchor_of(arrays, near.first, offsets, two)
            way2 = (bx - ax) * (bx - ax) + (by - ay) * (by - ay)
        both = rooms[one] + rooms[two] - 2.0 * exact
        if both > 0.0 and both * both >= way2:
            return True
    first, second = min(one, two), max(one, two)
    found = _straight_between(arrays, near, body, offsets, first, second, True)
    if found == BARRED:
        return bool(_bend_past(arrays, near, body, offsets, first, second)[0])
    return bool(found == CLEAR)
