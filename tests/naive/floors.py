"""The cells that a body may go to, the long way: every cell against all others and barriers.

Where a body stands in a cell, its anchor, is taken as given, and so is the bend of a step that is
not straight. Whether they are any good is looked into here, with all barriers there are.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Body
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.traversal._anchor_kernels import anchor_of
from esplanade.planning.traversal._way_kernels import bend_between
from esplanade.planning.traversal.cache import find_traversability
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.traversability import Traversability
from tests.naive.geometry import Point, point_segment_distance, segment_distance
from tests.naive.waves import dijkstra

Barrier = NDArray[np.void]
COMPASS = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))
HAIR = 1e-4
FLAT_SLOPE = 0.35
LINK_ROOM_M = 0.5
SLACK_M = 0.007
EXACT_M = 1e-3
LOW_ROOM_M = 0.13


def nearest_points(way: tuple[Point, Point], line: tuple[Point, Point]) -> tuple[Point, Point]:
    """The points of two segments that do not cross where they are nearest."""
    pairs = [(foot_on(end, *way), end) for end in line] + [
        (end, foot_on(end, *line)) for end in way
    ]
    return min(pairs, key=lambda pair: math.dist(*pair))


def foot_on(point: Point, a: Point, b: Point) -> Point:
    """The point of a segment that is nearest to a point."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    u = 0.0 if square == 0.0 else ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / square
    u = min(1.0, max(0.0, u))
    return a[0] + u * dx, a[1] + u * dy


def line_of(barrier: Barrier) -> tuple[Point, Point]:
    """The two ends of a barrier on the plan."""
    x0, y0, x1, y1 = (float(barrier[name]) for name in ("x0", "y0", "x1", "y1"))
    return (x0, y0), (x1, y1)


class Floors:
    """The floors of a zone and a body, one question at a time."""

    def __init__(self, arrays: LayeredArrays, barriers: Barrier, body: Body) -> None:
        self.arrays, self.barriers, self.body = arrays, barriers, body
        self.cells = {
            tuple(place): cell
            for cell, place in enumerate(arrays.places.tolist())
            if math.isfinite(arrays.floors[cell])
        }

    def floor(self, cell: int) -> float:
        return float(self.arrays.floors[cell])

    def ceiling(self, cell: int) -> float:
        return float(self.arrays.ceilings[cell])

    def centre(self, cell: int) -> Point:
        _, j, i = self.arrays.places[cell].tolist()
        a = self.arrays
        return a.x0 + (i + 0.5) * a.cell_m, a.y0 + (j + 0.5) * a.cell_m

    @cached_property
    def feet(self) -> Traversability:
        """The ground as kernels find it; anchors and bends of it are taken as given."""
        return find_traversability(self.arrays, self.barriers, self.body)

    def anchor(self, cell: int) -> Point:
        """The point of a cell that paths go through."""
        feet = self.feet
        return anchor_of(feet.arrays, feet.near.first, feet.offsets, cell)

    def height_to_climb(self, barrier: Barrier, *floors: float) -> float:
        """Height that the body has to climb to get past a barrier."""
        if barrier["bottom_m"] >= max(floors) + self.body.height_m - HAIR:
            return 0.0
        return max(0.0, min(float(barrier["top_m"]) - min(floors), float(barrier["climb_m"])))

    def stops_at(self, position: Point, floor: float, step_m: float) -> Iterator[float]:
        """Distances to barriers that stop a body which can step no higher than `step_m`."""
        for barrier in self.barriers:
            if self.height_to_climb(barrier, floor) > step_m + HAIR:
                yield point_segment_distance(position, *line_of(barrier))

    def may_step(self, a: int, b: int) -> bool:
        """Reachability of sec. 4.1 between two linked cells."""
        low, high = sorted((self.floor(a), self.floor(b)))
        if high - low > self.body.step_on_m + HAIR:
            return False
        if min(self.ceiling(a), self.ceiling(b)) - high < self.body.height_m - HAIR:
            return False
        fits = all(self.fits_at(self.anchor(c), self.floor(c)) for c in (a, b))
        return fits and len(self.way_between(a, b)) > 0

    def fits_at(self, position: Point, floor: float) -> bool:
        """Whether a body has its exact radius at a position, or the distance of low obstacles."""
        return all(
            point_segment_distance(position, *line_of(barrier))
            >= self.distance_from(barrier, floor) + SLACK_M - EXACT_M
            for barrier in self.barriers
            if self.height_to_climb(barrier, floor) > self.body.step_on_m + HAIR
        )

    def way_between(self, a: int, b: int) -> tuple[Point, ...]:
        """The points of a step between two cells, one bend included; none if barriers bar it.

        What the body passes below from the lower floor matters from the middle of a straight step.
        """
        low, high = sorted((a, b), key=self.floor)
        p, q = self.anchor(low), self.anchor(high)
        middle = 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])
        rises = self.floor(high) - self.floor(low) >= HAIR
        floors = self.floor(low), self.floor(high)

        def part(barrier: Barrier) -> tuple[Point, Point]:
            above = barrier["bottom_m"] >= floors[0] + self.body.height_m - HAIR
            return (middle, q) if rises and above else (p, q)

        if all(self.passes(barrier, *part(barrier), *floors) for barrier in self.barriers):
            return p, q
        feet = self.feet
        found, x, y = bend_between(feet.arrays, feet.near, feet.body, feet.offsets, a, b)
        bent = p, (x, y), q
        return bent if found == 2 and self.keeps_clear(bent, *floors) else ()

    def keeps_clear(self, way: tuple[Point, ...], *floors: float) -> bool:
        """Whether a body on its way over some floors keeps its distance from all barriers."""
        return all(
            self.passes(barrier, p, q, *floors)
            for barrier in self.barriers
            for p, q in pairwise(way)
        )

    def passes(self, barrier: Barrier, p: Point, q: Point, *floors: float) -> bool:
        """Whether a body passes a barrier between two points, with room to give way if need be."""
        need, apart = (
            self.distance_from(barrier, *floors),
            segment_distance(p, q, *line_of(barrier)),
        )
        if apart < need or need <= 1e-9 or apart >= need + SLACK_M - EXACT_M:
            return apart >= need
        c, end = nearest_points((p, q), line_of(barrier))
        part = (need + SLACK_M) / math.dist(c, end)
        aside = end[0] + part * (c[0] - end[0]), end[1] + part * (c[1] - end[1])
        return self.fits_at(aside, max(floors))

    def distance_from(self, barrier: Barrier, *floors: float) -> float:
        """The distance of the body's centre from a barrier, which it may never cross."""
        if self.height_to_climb(barrier, *floors) <= self.body.step_on_m + HAIR:
            return -math.inf
        step = self.height_to_climb(barrier, max(floors))
        if step > self.body.leg_length_m + HAIR:
            return self.body.radius_m - SLACK_M
        if step > self.body.step_on_m + HAIR:
            return min(self.body.radius_m, LOW_ROOM_M) - SLACK_M
        return 1e-9

    def steps(self) -> dict[int, dict[int, int]]:
        """For each cell where each of its links leads that the body may follow."""
        return {
            cell: {
                d: other
                for d, other in enumerate(self.arrays.links[cell].tolist())
                if other >= 0 and self.may_step(cell, other)
            }
            for cell in self.cells.values()
        }

    def around(self, cell: int) -> Iterator[tuple[int, int, float]]:
        """Rows, columns and distances of the centres of other cells that the disc touches."""
        a = self.arrays
        _, j, i = a.places[cell].tolist()
        for jj in range(a.ny):
            for ii in range(a.nx):
                gaps = [max(0.0, abs(v) - 0.5) * a.cell_m for v in (jj - j, ii - i)]
                if (jj, ii) != (j, i) and math.hypot(*gaps) < self.body.radius_m - 1e-6:
                    yield jj, ii, a.cell_m * math.hypot(jj - j, ii - i)

    def classify(self, cell: int) -> Stability:
        """The five classes of sec. 4.2."""
        by_heights = self._by_heights(cell)
        floor, leg = self.floor(cell), self.body.leg_length_m + HAIR
        flat = FLAT_SLOPE * self.arrays.cell_m + HAIR
        found = by_heights
        for barrier in self.barriers:
            line = line_of(barrier)
            if point_segment_distance(self.anchor(cell), *line) >= self.body.radius_m - SLACK_M:
                continue
            step = self.height_to_climb(barrier, floor)
            if 0.0 < barrier["climb_m"] <= self.body.step_on_m:
                continue
            if step > leg:
                return Stability.FORBIDDEN
            if step > flat and found == Stability.STABLE:
                found = Stability.UNSTABLE
        return found

    def _by_heights(self, cell: int) -> Stability:
        layer = int(self.arrays.places["layer"][cell])
        floor, ceiling = self.floor(cell), self.ceiling(cell)
        height, leg = self.body.height_m - HAIR, self.body.leg_length_m + HAIR
        if ceiling - floor < height:
            return Stability.FORBIDDEN
        around = list(self.around(cell))
        own = [(self.cells.get((layer, j, i)), away) for j, i, away in around]

        def room(other: int) -> float:
            return min(ceiling, self.ceiling(other)) - max(floor, self.floor(other))

        def blocks(other: int | None) -> bool:
            return (
                other is None or abs(self.floor(other) - floor) > leg or room(other) < LINK_ROOM_M
            )

        if any(blocks(other) for other, _ in own):
            for layers, found in (
                (range(layer + 1, len(self.arrays.pages)), Stability.UP_STAIR),
                (range(layer), Stability.DOWN_STAIR),
            ):
                others = [self.cells.get((m, j, i)) for m in layers for j, i, _ in around]
                if any(o is not None and abs(self.floor(o) - floor) <= leg for o in others):
                    return found
        if any(
            not blocks(other)
            and room(other) >= height
            and abs(self.floor(other) - floor) > FLAT_SLOPE * away + HAIR
            for other, away in own
        ):
            return Stability.UNSTABLE
        return Stability.STABLE


def ways_left(
    steps: dict[int, dict[int, int]], classes: NDArray[np.uint8], goal: int
) -> dict[int, float]:
    """Shortest ways to a goal, in cells, over steps between cells that are not Forbidden."""
    ways: dict[int, dict[int, float]] = {cell: {} for cell in steps}
    for cell, links in steps.items():
        for d, other in links.items():
            if classes[cell] and classes[other]:
                ways[other][cell] = 99 / 70 if d % 2 else 1.0
    return dijkstra(ways, goal)


def legal_ways(
    steps: dict[int, dict[int, int]], classes: NDArray[np.uint8], start: int, most: int
) -> dict[int, float]:
    """Shortest legal ways from a start, in cells, by trying all states (cell, count)."""
    ways: dict[tuple[int, int], dict[tuple[int, int], float]] = {}
    queue = deque([(start, 0)])
    while queue:
        state = queue.popleft()
        if state in ways:
            continue
        ways[state] = {}
        for d, other in steps[state[0]].items():
            count = 0 if classes[other] == Stability.STABLE else state[1] + 1
            if classes[other] and count < most:
                ways[state][other, count] = 99 / 70 if d % 2 else 1.0
                queue.append((other, count))
    shortest: dict[int, float] = {}
    for (cell, _), length in dijkstra(ways, (start, 0)).items():
        shortest[cell] = min(length, shortest.get(cell, math.inf))
    return shortest
