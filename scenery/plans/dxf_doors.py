"""Doors as drawings show them: a line across the opening, or a leaf that stands open and its swing.

The arc of a swing begins where the leaf stands and ends where it closes, and its middle is the
hinge: the doorway is from the hinge to the end of the arc at which no leaf is drawn.
"""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from esplanade.scenery.plans.storey import Line, Point

_NEAR_M: Final = 0.15
"""Leaves are drawn with a thickness, beside the hinge and the end of the arc."""


class Stroke(NamedTuple):
    """A line of a door; an arc has the point around which it goes."""

    points: list[Point]
    centre: Point | None = None


def doorways(strokes: Sequence[Stroke], *, is_block: bool) -> list[Line]:
    """The doorways that strokes show; those of one block without an arc show a single one."""
    arcs = [stroke for stroke in strokes if stroke.centre is not None]
    lines = [stroke for stroke in strokes if stroke.centre is None]
    if arcs:
        found = [_closed(arc, lines) for arc in arcs]
        if is_block:
            return found
        leaves = [stroke for stroke in lines if not any(_of_swing(stroke, arc) for arc in arcs)]
        return [*found, *((line.points[0], line.points[-1]) for line in leaves)]
    if is_block:
        return _longest([point for stroke in lines for point in stroke.points])
    return [
        (line.points[0], line.points[-1]) for line in lines if line.points[0] != line.points[-1]
    ]


def _closed(arc: Stroke, lines: Sequence[Stroke]) -> Line:
    """From the hinge to where the leaf closes."""
    hinge = arc.centre or arc.points[0]
    ends = arc.points[0], arc.points[-1]
    leaves = [stroke for stroke in lines if _of_swing(stroke, arc)]
    away = [
        min((math.dist(end, p) for leaf in leaves for p in leaf.points), default=0.0)
        for end in ends
    ]
    return hinge, ends[0] if away[0] > away[1] else ends[1]


def _of_swing(stroke: Stroke, arc: Stroke) -> bool:
    """Whether a line is the leaf of a swing: it has a point at the hinge and one at its end."""
    hinge = arc.centre or arc.points[0]
    at_hinge = any(math.dist(point, hinge) < _NEAR_M for point in stroke.points)
    ends = arc.points[0], arc.points[-1]
    return at_hinge and any(math.dist(p, end) < _NEAR_M for p in stroke.points for end in ends)


def _longest(points: Sequence[Point]) -> list[Line]:
    """The two points of a block that are furthest from each other, if any are apart."""
    if len(points) > 400:
        points = points[:: len(points) // 200]
    pairs = [(math.dist(a, b), a, b) for i, a in enumerate(points) for b in points[i + 1 :]]
    longest = max(pairs, default=(0.0, (0.0, 0.0), (0.0, 0.0)))
    return [(longest[1], longest[2])] if longest[0] > 0.0 else []
