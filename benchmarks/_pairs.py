"""Random pairs of points on the ground of a mesh, and the answers of two planners to them."""

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
"""Shorter paths have no meaningful ratio of lengths, as either end may be moved by 0.5 m."""


@dataclass(frozen=True)
class Answer:
    """The answer of a planner to one pair."""

    stands: tuple[bool, bool]
    """Whether the body can stand at the start and at the goal."""
    points: Floats
    """The path, float64 (N, 3), metres; it is empty if there is none."""
    us: float
    """The time that the query took, microseconds."""

    @property
    def found(self) -> bool:
        """Whether a complete path was found."""
        return len(self.points) > 0

    @property
    def length_m(self) -> float:
        """The length on the map; heights are left out because the planners treat stairs
        differently."""
        return float(np.hypot(*np.diff(self.points[:, :2], axis=0).T).sum())


class Finders(StrEnum):
    """The planners that find a path for a pair."""

    BOTH = "both"
    NEITHER = "neither"
    ONLY_OURS = "only ours"
    ONLY_THEIRS = "only theirs"


def finders_of(ours: Answer, theirs: Answer) -> Finders:
    """The planners that found a path."""
    if ours.found:
        return Finders.BOTH if theirs.found else Finders.ONLY_OURS
    return Finders.ONLY_THEIRS if theirs.found else Finders.NEITHER


def ground_points(triangles: Floats, count: int, random: np.random.Generator) -> Floats:
    """Random points (count, 3), metres, evenly spread over the triangles that are not too steep.

    `triangles` is float64 (T, 3, 3), metres, z up.

    Raises
    ------
    ValueError
        No triangle faces up.
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
    """Random pairs (count, 2, 3) of different points on which a body can stand.

    `known` says of each of the points (N, 3) whether that is so, bool (N,).

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
    """Our length over theirs, for every pair with two paths that are long enough, float64 (M,)."""
    return np.array(
        [
            mine.length_m / other.length_m
            for mine, other in zip(ours, theirs, strict=True)
            if mine.found and other.found and min(mine.length_m, other.length_m) >= SHORTEST_M
        ]
    )


def last_reached(path: Floats, reaches: Callable[[Floats], bool], step_m: float = 0.1) -> Floats:
    """The last point (3,) of a path (N, 3) that a planner reaches, metres.

    It is found by bisection, to within `step_m`; the start counts as reached.
    """
    legs = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(legs)])
    marks = np.linspace(0.0, along[-1], max(2, math.ceil(along[-1] / step_m) + 1))
    points = np.stack([np.interp(marks, along, path[:, axis]) for axis in range(3)], axis=1)
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
    """The 5th, 50th and 95th percentile, for tables and JSON; None if there are no values."""
    if len(values) == 0:
        return {"p5": None, "p50": None, "p95": None}
    p5, p50, p95 = np.percentile(values, (5.0, 50.0, 95.0)).tolist()
    return {"p5": p5, "p50": p50, "p95": p95}
