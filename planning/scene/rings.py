"""Rings of corners on the ground plane: their area, and whether they cross themselves."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
_Floats = NDArray[np.float64]

SAME_CORNER_M: Final = 1e-9
"""Corners nearer to each other are one."""
_FEW_CORNERS: Final = 8
"""Up to so many, edges are compared one by one."""


def twice_area(points: tuple[Point, ...]) -> float:
    """Twice the area within the ring, positive where it turns left."""
    ring = zip(points, points[1:] + points[:1], strict=True)
    return sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in ring)


def distinct_corners(points: tuple[Point, ...]) -> list[int]:
    """Indices of the corners that do not repeat the one before; the last is before the first."""
    places: list[int] = []
    for place, point in enumerate(points):
        if not places or _apart(point, points[places[-1]]):
            places.append(place)
    while len(places) > 1 and not _apart(points[places[-1]], points[places[0]]):
        places.pop()
    return places


def _apart(a: Point, b: Point) -> bool:
    return abs(a[0] - b[0]) > SAME_CORNER_M or abs(a[1] - b[1]) > SAME_CORNER_M


def _crossing_edges_of_few(points: tuple[Point, ...]) -> tuple[int, int] | None:
    """The first two for few corners: every edge with every other: arrays would take longer."""
    n = len(points)
    for first in range(n - 2):
        a, b = points[first], points[first + 1]
        for second in range(first + 2, n - (first == 0)):
            if _edges_meet(a, b, points[second], points[(second + 1) % n]):
                return first, second
    return None


def _edges_meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether the segment from a to b meets that from c to d."""
    for axis in (0, 1):
        if max(a[axis], b[axis]) < min(c[axis], d[axis]):
            return False
        if max(c[axis], d[axis]) < min(a[axis], b[axis]):
            return False

    def side(p: Point, q: Point, r: Point) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    def between(p: Point, q: Point, r: Point) -> bool:
        return min(p[0], q[0]) <= r[0] <= max(p[0], q[0]) and min(p[1], q[1]) <= r[1] <= max(
            p[1], q[1]
        )

    s1, s2, s3, s4 = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    return (
        (s1 * s2 < 0.0 and s3 * s4 < 0.0)
        or (s1 == 0.0 and between(a, b, c))
        or (s2 == 0.0 and between(a, b, d))
        or (s3 == 0.0 and between(c, d, a))
        or (s4 == 0.0 and between(c, d, b))
    )


def crossing_edges(points: tuple[Point, ...]) -> tuple[int, int] | None:
    """Indices of the first two edges of the ring that cross or touch and are not neighbours."""
    if len(points) <= _FEW_CORNERS:
        return _crossing_edges_of_few(points)
    return _crossing_edges_of_many(points)


def _crossing_edges_of_many(points: tuple[Point, ...]) -> tuple[int, int] | None:
    """The same for many corners.

    Only edges that overlap along x are compared, found in the order of their least x.
    """
    begins = np.array(points)
    ends = np.roll(begins, -1, axis=0)
    n = len(points)
    low, high = np.minimum(begins, ends), np.maximum(begins, ends)
    order = np.argsort(low[:, 0], kind="stable")
    reach = np.searchsorted(low[order, 0], high[order, 0], side="right")
    counts = reach - np.arange(n) - 1
    place = np.repeat(np.arange(n), counts)
    one = order[place]
    other = order[np.arange(len(place)) - np.repeat(np.cumsum(counts) - counts, counts) + place + 1]
    level = (low[one, 1] <= high[other, 1]) & (low[other, 1] <= high[one, 1])
    first, second = np.minimum(one, other)[level], np.maximum(one, other)[level]
    apart = (second - first > 1) & (second - first < n - 1)
    first, second = first[apart], second[apart]
    meeting = _segments_meet(begins[first], ends[first], begins[second], ends[second])
    pairs = sorted(zip(first[meeting].tolist(), second[meeting].tolist(), strict=True))
    return pairs[0] if pairs else None


def _segments_meet(a: _Floats, b: _Floats, c: _Floats, d: _Floats) -> NDArray[np.bool_]:
    """Whether segments from a to b meet those from c to d, all (N, 2); bool (N,)."""

    def side(p: _Floats, q: _Floats, r: _Floats) -> _Floats:
        to_q, to_r = q - p, r - p
        turned: _Floats = to_q[..., 0] * to_r[..., 1] - to_q[..., 1] * to_r[..., 0]
        return turned

    def between(p: _Floats, q: _Floats, r: _Floats) -> NDArray[np.bool_]:
        within = (np.minimum(p, q) <= r) & (r <= np.maximum(p, q))
        inside: NDArray[np.bool_] = within[..., 0] & within[..., 1]
        return inside

    s1, s2, s3, s4 = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    meet: NDArray[np.bool_] = (
        ((s1 * s2 < 0) & (s3 * s4 < 0))
        | ((s1 == 0) & between(a, b, c))
        | ((s2 == 0) & between(a, b, d))
        | ((s3 == 0) & between(c, d, a))
        | ((s4 == 0) & between(c, d, b))
    )
    return meet
