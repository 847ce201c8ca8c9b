"""Meetings with certain obstacles, by looking at every other actor and at many moments."""

from __future__ import annotations

import math

import numpy as np

from planning._reservation_kernels import Reservations
from tests.naive.geometry import Point, closest_approach


def conflict(
    r: Reservations, margin_m: float, me: int, layer: int, k: int, a: Point, b: Point
) -> tuple[bool, int]:
    """Whether a move meets someone of smaller rank, and how many of larger rank it meets."""
    blocked = False
    soft = 0
    for other in range(len(r.layers)):
        if other == me or r.layers[other] != layer:
            continue
        before = np.subtract(a, r.paths[other, k])
        after = np.subtract(b, r.paths[other, k + 1])
        nearest = closest_approach(tuple(before), tuple(after - before))
        apart = nearest >= math.hypot(*before) - 1e-9 and math.hypot(*after) > math.hypot(*before)
        if nearest >= r.radii[me] + r.radii[other] + margin_m or apart:
            continue
        if r.ranks[other] < r.ranks[me]:
            blocked = True
        else:
            soft += 1
    return blocked, soft
