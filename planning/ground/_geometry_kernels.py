"""Plane geometry on bare arrays: points, segments, and a bucket index of barriers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel


class SegmentIndex(NamedTuple):
    """Barriers, listed by square bucket (CSR).

    A bucket lists every barrier that passes within `reach_m` of it, so that all within `reach_m`
    of a point are in the point's own bucket.
    """

    segments: NDArray[np.float64]
    """(S, 7): x0, y0, x1, y1, underside, top, rise; metres."""
    starts: NDArray[np.int64]
    """(ny * nx + 1,): where each bucket's list begins."""
    members: NDArray[np.int64]
    """Row numbers of segments, bucket after bucket."""
    x0: float
    y0: float
    bucket_m: float
    reach_m: float
    nx: int
    ny: int


class Stance(NamedTuple):
    """How somebody stands at a place: what decides which barriers stop them."""

    floor_m: float
    foothold_m: float
    """Height that its steps count from: of the highest floor that its feet are on."""
    height_m: float
    step_on_m: float


@inlined
def stops(index: SegmentIndex, s: int, stance: Stance) -> bool:
    """Whether a barrier stops who stands like that: it is neither stepped over nor walked under.

    An edge with a drop (`rise`) stops those whose step-on height is less.
    """
    segment = index.segments[s]
    return bool(
        segment[4] < stance.floor_m + stance.height_m
        and segment[5] > stance.foothold_m + stance.step_on_m
        and stance.step_on_m < segment[6]
    )


@kernel
def point_segment_distance(
    px: float, py: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float, float]:
    """Distance from a point to a segment, and the closest point of the segment."""
    dx = bx - ax
    dy = by - ay
    length2 = dx * dx + dy * dy
    u = 0.0
    if length2 > 0.0:
        u = min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / length2))
    cx = ax + u * dx
    cy = ay + u * dy
    return np.hypot(px - cx, py - cy), cx, cy


@kernel
def segments_cross(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> bool:
    """Whether segment ab meets segment cd, touching included.

    A hair beyond the ends counts too: nothing slips between walls that share a corner.
    """
    hair = 1e-9
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
            return point_segment_distance(ax, ay, cx, cy, dx, dy)[0] < 1e-12
        t0 = (qx * rx + qy * ry) / length2
        t1 = t0 + (sx * rx + sy * ry) / length2
        return max(min(t0, t1), 0.0) <= min(max(t0, t1), 1.0) + hair
    t = (qx * sy - qy * sx) / den
    u = (qx * ry - qy * rx) / den
    return -hair <= t <= 1.0 + hair and -hair <= u <= 1.0 + hair


@inlined
def closest_approach(rx: float, ry: float, dx: float, dy: float) -> float:
    """Smallest distance while a relative position (rx, ry) changes evenly by (dx, dy)."""
    length2 = dx * dx + dy * dy
    u = 0.0
    if length2 > 1e-12:
        u = min(1.0, max(0.0, -(rx * dx + ry * dy) / length2))
    qx = rx + u * dx
    qy = ry + u * dy
    return float(np.sqrt(qx * qx + qy * qy))


@kernel
def bucket_of(index: SegmentIndex, x: float, y: float) -> int:
    """Bucket that holds a point; points outside fall to the nearest bucket."""
    i = min(index.nx - 1, max(0, int((x - index.x0) / index.bucket_m)))
    j = min(index.ny - 1, max(0, int((y - index.y0) / index.bucket_m)))
    return j * index.nx + i


@kernel
def nearest_segment(
    index: SegmentIndex, stance: Stance, x: float, y: float
) -> tuple[float, float, float]:
    """Distance to the nearest barrier of the point's bucket and its closest point; inf if none."""
    best = np.inf
    bx = x
    by = y
    b = bucket_of(index, x, y)
    for k in range(index.starts[b], index.starts[b + 1]):
        if not stops(index, index.members[k], stance):
            continue
        s = index.segments[index.members[k]]
        d, cx, cy = point_segment_distance(x, y, s[0], s[1], s[2], s[3])
        if d < best:
            best = d
            bx = cx
            by = cy
    return best, bx, by


@kernel
def crosses_any(
    index: SegmentIndex, stance: Stance, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Whether the short way from a to b meets a barrier listed in the bucket of a.

    The way must be shorter than the index's reach.
    """
    b = bucket_of(index, ax, ay)
    for k in range(index.starts[b], index.starts[b + 1]):
        if not stops(index, index.members[k], stance):
            continue
        s = index.segments[index.members[k]]
        if segments_cross(ax, ay, bx, by, s[0], s[1], s[2], s[3]):
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
    index: SegmentIndex,
    stance: Stance,
    bounds: tuple[float, float, float, float],
    x: float,
    y: float,
    dx: float,
    dy: float,
    clearance: float,
    before: float,
) -> tuple[float, float]:
    """Move a disc by a short step, pushed out of barriers; stays where it is when that fails.

    `before` is how near the nearest barrier is. The bounds count before barriers do: a wall that
    ends at them must not be rounded outside.
    """
    nx = _within(bounds[0], x + dx, bounds[2])
    ny = _within(bounds[1], y + dy, bounds[3])
    allowed = min(clearance, before) - 1e-9
    for pushes in range(5):
        d, cx, cy = nearest_segment(index, stance, nx, ny)
        if d >= allowed:
            break
        if d < 1e-9 or pushes == 4:  # between barriers it may be pushed to and fro for ever
            return x, y
        part = (min(clearance, before) - d) / d
        nx = _within(bounds[0], nx + (nx - cx) * part, bounds[2])
        ny = _within(bounds[1], ny + (ny - cy) * part, bounds[3])
    if crosses_any(index, stance, x, y, nx, ny):
        return x, y
    return nx, ny


@kernel
def slide(
    index: SegmentIndex,
    stance: Stance,
    bounds: tuple[float, float, float, float],
    x: float,
    y: float,
    dx: float,
    dy: float,
    clearance: float,
) -> tuple[float, float]:
    """Move a disc by (dx, dy) on one level, sliding along barriers and kept inside the bounds.

    Near walls the way is cut into pieces of half the clearance, so that none is jumped over. Where
    nothing is as near as the way is long, nothing has to be asked on it.
    """
    length = np.hypot(dx, dy)
    if length == 0.0:
        return x, y
    done = 0.0
    while done < length:
        before = nearest_segment(index, stance, x, y)[0]
        room = min(before, index.reach_m) - clearance
        if done == 0.0 and room > length and in_bounds(bounds, x + dx, y + dy):
            return x + dx, y + dy
        piece = min(length - done, max(room, 0.5 * clearance, 0.02))
        u = piece / length
        x, y = slide_step(index, stance, bounds, x, y, dx * u, dy * u, clearance, before)
        done += piece
    return x, y


@kernel
def list_by_bucket(
    segments: NDArray[np.float64],
    place: tuple[float, float, float, int, int],
    reach: float,
    starts: NDArray[np.int64],
    members: NDArray[np.int64],
) -> None:
    """List the segments within `reach` of each bucket's centre, in order.

    `place` is x0, y0, edge of a bucket, columns, rows. Without room in `members` they are only
    counted, into starts[1:]; else `starts` tells where each bucket's list begins.
    """
    x0, y0, bucket_m, nx, ny = place
    count = np.zeros(nx * ny, dtype=np.int64)
    for s in range(len(segments)):
        ax = segments[s, 0]
        ay = segments[s, 1]
        bx = segments[s, 2]
        by = segments[s, 3]
        i0 = max(0, int((min(ax, bx) - reach - x0) / bucket_m))
        i1 = min(nx - 1, int((max(ax, bx) + reach - x0) / bucket_m))
        j0 = max(0, int((min(ay, by) - reach - y0) / bucket_m))
        j1 = min(ny - 1, int((max(ay, by) + reach - y0) / bucket_m))
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                cx = x0 + (i + 0.5) * bucket_m
                cy = y0 + (j + 0.5) * bucket_m
                if point_segment_distance(cx, cy, ax, ay, bx, by)[0] > reach:
                    continue
                b = j * nx + i
                if len(members):
                    members[starts[b] + count[b]] = s
                else:
                    starts[b + 1] += 1
                count[b] += 1
