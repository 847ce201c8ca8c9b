"""Plane geometry on bare arrays: points, segments, barriers, and a bucket index of barriers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel

LOW_ROOM_M = 0.13
"""Distance that the centre of a body keeps from what it does not step over, but could put a leg
over: its disc may reach beyond. Moves are looked at every 0.25 m at least, and jump over none."""

TOLERANCE_M = 1e-4
"""Heights and lengths that differ by less are equal, since floors are rounded to float32."""
_SHORTEST_PIECE_M = 0.01
"""A move that fails is not tried in pieces shorter than twice this."""

BARRIER = np.dtype(
    [
        ("x0", "f8"),
        ("y0", "f8"),
        ("x1", "f8"),
        ("y1", "f8"),
        ("bottom_m", "f8"),
        ("top_m", "f8"),
        ("climb_m", "f8"),
    ]
)
"""One barrier: a vertical strip over the segment from (x0, y0) to (x1, y1), in metres.

It reaches from `bottom_m` to `top_m`. `climb_m` is the greatest height that a body has to climb to
get past it: infinite for a wall, the difference of the floors for a ledge, 0 for an open door.
A barrier stops a body of a height and a step-on height that stands on a floor if and only if
bottom_m < floor + height, top_m > floor + step-on height, and climb_m > step-on height, all of them
by more than `TOLERANCE_M`.
"""


class BarrierIndex(NamedTuple):
    """Barriers, listed by square bucket in CSR form.

    A bucket lists every barrier that passes within `reach_m` of it, so that all barriers within
    `reach_m` of a point are in the point's own bucket.
    """

    barriers: NDArray[np.void]
    """(S,) of `BARRIER`."""
    starts: NDArray[np.int64]
    """(ny * nx + 1,): where each bucket's list begins."""
    members: NDArray[np.int64]
    """Row numbers of barriers, bucket after bucket."""
    x0: float
    y0: float
    bucket_m: float
    reach_m: float
    nx: int
    ny: int


class Placement(NamedTuple):
    """A body at a place, as far as it decides which barriers stop the body; metres."""

    floor_m: float
    """Height of the floor under its centre."""
    support_m: float
    """Height of the highest floor that its feet can be on: its steps count from there."""
    height_m: float
    """Height of the body."""
    step_on_m: float
    """Greatest height that the body steps up or down."""
    leg_length_m: float
    """Greatest height that the body could put a leg over: such obstacles are low."""


@inlined
def stops(barrier: np.void, placement: Placement) -> bool:
    """Whether a barrier stops a body that can neither step over it nor walk under it."""
    return bool(
        barrier["bottom_m"] < placement.floor_m + placement.height_m - TOLERANCE_M
        and barrier["top_m"] > placement.support_m + placement.step_on_m + TOLERANCE_M
        and barrier["climb_m"] > placement.step_on_m + TOLERANCE_M
    )


@inlined
def _nearest_share(px: float, py: float, ax: float, ay: float, dx: float, dy: float) -> float:
    """The part of a segment, from a on along (dx, dy), at which it is nearest to a point p."""
    length2 = dx * dx + dy * dy
    if length2 > 0.0:
        return min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / length2))
    return 0.0


@inlined
def point_segment_distance(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> float:
    """Distance from a point p to the segment ab."""
    dx = bx - ax
    dy = by - ay
    u = _nearest_share(px, py, ax, ay, dx, dy)
    ex = px - ax - u * dx
    ey = py - ay - u * dy
    return float(np.sqrt(ex * ex + ey * ey))


@inlined
def nearest_on_segment(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float, float]:
    """Distance from a point p to the segment ab, and the nearest point of the segment."""
    dx = bx - ax
    dy = by - ay
    u = _nearest_share(px, py, ax, ay, dx, dy)
    cx = ax + u * dx
    cy = ay + u * dy
    return float(np.sqrt((px - cx) * (px - cx) + (py - cy) * (py - cy))), cx, cy


@kernel
def segments_cross(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> bool:
    """Whether segment ab meets segment cd, touching included.

    Segments count as longer by one billionth of themselves, so that nothing slips between walls
    that share a corner.
    """
    tolerance = 1e-9
    rx = bx - ax
    ry = by - ay
    sx = dx - cx
    sy = dy - cy
    den = rx * sy - ry * sx
    qx = cx - ax
    qy = cy - ay
    if abs(den) < 1e-15:
        if abs(qx * ry - qy * rx) > 1e-12:
            return False
        length2 = rx * rx + ry * ry
        if length2 == 0.0:
            return point_segment_distance(ax, ay, cx, cy, dx, dy) < 1e-12
        t0 = (qx * rx + qy * ry) / length2
        t1 = t0 + (sx * rx + sy * ry) / length2
        return max(min(t0, t1), 0.0) <= min(max(t0, t1), 1.0) + tolerance
    t = (qx * sy - qy * sx) / den
    u = (qx * ry - qy * rx) / den
    return -tolerance <= t <= 1.0 + tolerance and -tolerance <= u <= 1.0 + tolerance


@inlined
def crosses(barrier: np.void, ax: float, ay: float, bx: float, by: float) -> bool:
    """Whether the segment ab meets a barrier, touching included."""
    return segments_cross(
        ax, ay, bx, by, barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
    )


@inlined
def closest_approach(rx: float, ry: float, dx: float, dy: float) -> float:
    """Smallest length of a relative position (rx, ry) while it changes evenly by (dx, dy)."""
    length2 = dx * dx + dy * dy
    u = 0.0
    if length2 > 1e-12:
        u = min(1.0, max(0.0, -(rx * dx + ry * dy) / length2))
    qx = rx + u * dx
    qy = ry + u * dy
    return float(np.sqrt(qx * qx + qy * qy))


@kernel
def bucket_of(index: BarrierIndex, x: float, y: float) -> int:
    """The bucket that holds a point; a point outside belongs to the nearest bucket."""
    i = min(index.nx - 1, max(0, int((x - index.x0) / index.bucket_m)))
    j = min(index.ny - 1, max(0, int((y - index.y0) / index.bucket_m)))
    return j * index.nx + i


@kernel
def nearest_barrier(
    index: BarrierIndex, placement: Placement, clearance: float, x: float, y: float
) -> tuple[float, float, float]:
    """Distance to the nearest barrier that stops a body, and the barrier's nearest point.

    Low obstacles count as so much further away that the `clearance` which the body keeps from
    others is `LOW_ROOM_M` from them. Only the point's own bucket is searched; without a barrier
    there the distance is inf.
    """
    low_m = max(0.0, clearance - LOW_ROOM_M)
    best = np.inf
    bx = x
    by = y
    bucket = bucket_of(index, x, y)
    for k in range(index.starts[bucket], index.starts[bucket + 1]):
        b = index.barriers[index.members[k]]
        if not stops(b, placement):
            continue
        d, cx, cy = nearest_on_segment(x, y, b["x0"], b["y0"], b["x1"], b["y1"])
        if (
            min(b["top_m"] - placement.support_m, b["climb_m"])
            <= placement.leg_length_m + TOLERANCE_M
        ):
            d += low_m
        if d < best:
            best = d
            bx = cx
            by = cy
    return best, bx, by


@kernel
def crosses_any(
    index: BarrierIndex, placement: Placement, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Whether a short segment ab meets a barrier that stops a body, in the bucket of a.

    The segment must be shorter than the index's `reach_m`.
    """
    bucket = bucket_of(index, ax, ay)
    for k in range(index.starts[bucket], index.starts[bucket + 1]):
        barrier = index.barriers[index.members[k]]
        if stops(barrier, placement) and crosses(barrier, ax, ay, bx, by):
            return True
    return False


@kernel
def _within(low: float, value: float, high: float) -> float:
    return min(high, max(low, value))


@kernel
def in_bounds(bounds: tuple[float, float, float, float], x: float, y: float) -> bool:
    """Whether a point lies inside the bounds x0, y0, x1, y1, or on them."""
    return bool(bounds[0] <= x <= bounds[2] and bounds[1] <= y <= bounds[3])


@kernel
def slide_step(
    index: BarrierIndex,
    placement: Placement,
    bounds: tuple[float, float, float, float],
    x: float,
    y: float,
    dx: float,
    dy: float,
    clearance: float,
    before: float,
) -> tuple[float, float]:
    """Move a disc by a short step and push it out of barriers; it stays if that fails.

    `before` is the distance to the nearest barrier at the start. The bounds are applied before the
    barriers, so that nobody gets around the end of a wall outside of the bounds.
    """
    nx = _within(bounds[0], x + dx, bounds[2])
    ny = _within(bounds[1], y + dy, bounds[3])
    allowed = min(clearance, before) - 1e-9
    for pushes in range(5):
        d, cx, cy = nearest_barrier(index, placement, clearance, nx, ny)
        if d >= allowed:
            break
        apart = np.hypot(nx - cx, ny - cy)
        if apart < 1e-9 or pushes == 4:  # between barriers it may be pushed to and fro for ever
            return x, y
        part = (min(clearance, before) - d) / apart
        nx = _within(bounds[0], nx + (nx - cx) * part, bounds[2])
        ny = _within(bounds[1], ny + (ny - cy) * part, bounds[3])
    if crosses_any(index, placement, x, y, nx, ny):
        return x, y
    return nx, ny


@kernel
def slide(
    index: BarrierIndex,
    placement: Placement,
    bounds: tuple[float, float, float, float],
    x: float,
    y: float,
    dx: float,
    dy: float,
    clearance: float,
) -> tuple[float, float]:
    """Move a disc by (dx, dy) on one level; it slides along barriers and stays inside the bounds.

    Near barriers the movement is cut into pieces of half the clearance, so that no barrier is
    jumped over, and a piece that fails into shorter ones. Where no barrier is as near as the
    movement is long, it is made at once.
    """
    length = np.hypot(dx, dy)
    if length == 0.0:
        return x, y
    done = 0.0
    while done < length:
        before = nearest_barrier(index, placement, clearance, x, y)[0]
        room = min(before, index.reach_m) - clearance
        if done == 0.0 and room > length and in_bounds(bounds, x + dx, y + dy):
            return x + dx, y + dy
        piece = min(length - done, max(room, 0.5 * clearance, 0.02))
        while True:
            u = piece / length
            nx, ny = slide_step(index, placement, bounds, x, y, dx * u, dy * u, clearance, before)
            if nx != x or ny != y or piece <= _SHORTEST_PIECE_M:
                break
            piece *= 0.5  # between two barriers a body that is pushed out of both gets on by less
        x, y = nx, ny
        done += piece
    return x, y


@kernel
def list_by_bucket(
    barriers: NDArray[np.void],
    place: tuple[float, float, float, int, int],
    reach: float,
    starts: NDArray[np.int64],
    members: NDArray[np.int64],
) -> None:
    """List the barriers within `reach` of each bucket's centre, in order.

    `place` is x0, y0, edge of a bucket, columns, rows. If `members` is empty, barriers are only
    counted, into starts[1:]; otherwise `starts` tells where each bucket's list begins.
    """
    x0, y0, bucket_m, nx, ny = place
    count = np.zeros(nx * ny, dtype=np.int64)
    for s in range(len(barriers)):
        ax = barriers[s]["x0"]
        ay = barriers[s]["y0"]
        bx = barriers[s]["x1"]
        by = barriers[s]["y1"]
        i0 = max(0, int((min(ax, bx) - reach - x0) / bucket_m))
        i1 = min(nx - 1, int((max(ax, bx) + reach - x0) / bucket_m))
        j0 = max(0, int((min(ay, by) - reach - y0) / bucket_m))
        j1 = min(ny - 1, int((max(ay, by) + reach - y0) / bucket_m))
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                cx = x0 + (i + 0.5) * bucket_m
                cy = y0 + (j + 0.5) * bucket_m
                if point_segment_distance(cx, cy, ax, ay, bx, by) > reach:
                    continue
                b = j * nx + i
                if len(members):
                    members[starts[b] + count[b]] = s
                else:
                    starts[b + 1] += 1
                count[b] += 1
