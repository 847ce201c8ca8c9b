"""Plane geometry the long way: by angles, by exact fractions, by trying many moments."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

Point = tuple[float, float]


def point_segment_distance(p: Point, a: Point, b: Point) -> float:
    """To the nearer end where the angle there is blunt, else by the height of the triangle."""
    ab, ap, bp = ((w[0] - v[0], w[1] - v[1]) for v, w in ((a, b), (a, p), (b, p)))
    if a == b or ap[0] * ab[0] + ap[1] * ab[1] <= 0.0:
        return math.hypot(*ap)
    if bp[0] * ab[0] + bp[1] * ab[1] >= 0.0:
        return math.hypot(*bp)
    twice_area = abs(ab[0] * ap[1] - ab[1] * ap[0])
    return twice_area / math.hypot(*ab)


def segments_meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether two closed segments share a point, decided without any rounding."""
    for axis in (0, 1):
        if max(a[axis], b[axis]) < min(c[axis], d[axis]):
            return False
        if max(c[axis], d[axis]) < min(a[axis], b[axis]):
            return False
    return _side(a, b, c) * _side(a, b, d) <= 0 and _side(c, d, a) * _side(c, d, b) <= 0


def _side(p: Point, q: Point, r: Point) -> int:
    (px, py), (qx, qy), (rx, ry) = [(Fraction(x), Fraction(y)) for x, y in (p, q, r)]
    turn = (qx - px) * (ry - py) - (qy - py) * (rx - px)
    return (turn > 0) - (turn < 0)


def segment_distance(a: Point, b: Point, c: Point, d: Point) -> float:
    """Smallest distance between two segments."""
    if segments_meet(a, b, c, d):
        return 0.0
    return min(
        point_segment_distance(a, c, d),
        point_segment_distance(b, c, d),
        point_segment_distance(c, a, b),
        point_segment_distance(d, a, b),
    )


def closest_approach(relative: Point, change: Point, moments: int = 20001) -> float:
    """Smallest distance of a relative position that changes evenly, over many moments."""
    u = np.linspace(0.0, 1.0, moments)
    return float(np.hypot(relative[0] + u * change[0], relative[1] + u * change[1]).min())


def inside(p: Point, ring: list[Point]) -> bool:
    """Whether the corners of a ring, seen from a point, turn once around it."""
    turned = 0.0
    for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
        turn = math.atan2(b[1] - p[1], b[0] - p[0]) - math.atan2(a[1] - p[1], a[0] - p[0])
        turned += (turn + math.pi) % (2.0 * math.pi) - math.pi
    return abs(turned) > math.pi
