"""Random pairs of points on the ground of a mesh, and what two planners say of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

STEEPEST_DEG: Final = 45.0
SHORTEST_M: Final = 2.0
"""Ways shorter than this say nothing by their ratio: either end may be moved by 0.5 m."""


@dataclass(frozen=True)
class Answer:
    """What a planner says of a pair: is there ground at either end, the way, and how long it took.

    `points` is float64 (N, 3), empty where there is no way.
    """

    stands: tuple[bool, bool]
    points: Floats
    us: float

    @property
    def found(self) -> bool:
        """Whether a way leads all through."""
        return len(self.points) > 0

    @property
    def length_m(self) -> float:
        """Length on the plan: both take heights of stairs in ways of their own."""
        return float(np.hypot(*np.diff(self.points[:, :2], axis=0).T).sum())


class Verdict(StrEnum):
    """Who finds a way."""

    BOTH = "both"
    NEITHER = "neither"
    ONLY_OURS = "only ours"
    ONLY_THEIRS = "only theirs"


def verdict(ours: Answer, theirs: Answer) -> Verdict:
    """Who of the two finds a way."""
    if ours.found:
        return Verdict.BOTH if theirs.found else Verdict.ONLY_OURS
    return Verdict.ONLY_THEIRS if theirs.found else Verdict.NEITHER


def ground_points(triangles: Floats, count: int, random: np.random.Generator) -> Floats:
    """Points (count, 3) spread evenly over what faces up and is not too steep to stand on.

    `triangles` is float64 (T, 3, 3), z up.
    """
    a, b, c = (triangles[:, k] for k in range(3))
    normals = np.cross(b - a, c - a)
    doubled = np.linalg.norm(normals, axis=1)
    walkable = normals[:, 2] >= math.cos(math.radians(STEEPEST_DEG)) * doubled
    weights = np.where(walkable, doubled, 0.0)
    if not weights.any():
        raise ValueError("no triangle of the mesh faces up: is another axis up?")
    chosen = random.choice(len(triangles), size=count, p=weights / weights.sum())
    u, v = random.random((2, count, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    points: Floats = a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]
    return points


def pairs_of(points: Floats, known: Bools, count: int, random: np.random.Generator) -> Floats:
    """Pairs (count, 2, 3) of different points that are known to be ground.

    Raises
    ------
    ValueError
        Fewer than two points are ground.
    """
    ground = np.flatnonzero(known)
    if len(ground) < 2:
        raise ValueError(f"{len(ground)} of {len(points)} points of the mesh are ground")
    first = random.integers(len(ground), size=count)
    second = (first + random.integers(1, len(ground), size=count)) % len(ground)
    pairs: Floats = points[ground[np.stack([first, second], axis=1)]]
    return pairs


def length_ratios(ours: Sequence[Answer], theirs: Sequence[Answer]) -> Floats:
    """Our length over theirs, for every pair whose ways are both found and long enough."""
    return np.array(
        [
            mine.length_m / other.length_m
            for mine, other in zip(ours, theirs, strict=True)
            if mine.found and other.found and min(mine.length_m, other.length_m) >= SHORTEST_M
        ]
    )


def last_reached(way: Floats, reaches: Callable[[Floats], bool], step_m: float = 0.1) -> Floats:
    """Along another's way (N, 3), how far one gets: the last point (3,) before the first gap.

    Halves the way again and again, so that it takes few questions; the start is taken as reached.
    """
    legs = np.linalg.norm(np.diff(way, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(legs)])
    marks = np.linspace(0.0, along[-1], max(2, math.ceil(along[-1] / step_m) + 1))
    points = np.stack([np.interp(marks, along, way[:, axis]) for axis in range(3)], axis=1)
    reached, beyond = 0, len(points) - 1
    while beyond - reached > 1:
        middle = (reached + beyond) // 2
        if reaches(points[middle]):
            reached = middle
        else:
            beyond = middle
    last: Floats = points[reached]
    return last


def spread(values: Floats | Sequence[float]) -> dict[str, Any]:
    """Median and both fifths of a hundred, for tables and JSON; None where there is no value."""
    if len(values) == 0:
        return {"p5": None, "p50": None, "p95": None}
    p5, p50, p95 = np.percentile(values, (5.0, 50.0, 95.0)).tolist()
    return {"p5": p5, "p50": p50, "p95": p95}
