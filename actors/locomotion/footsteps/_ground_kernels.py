"""The ground under feet, one foot after the other: its height, and the treads to put a foot on."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from esplanade.actors.locomotion.planted.footprints import HEADING, Z
from esplanade.planning.compiled.arrays import Bools, Floats, Ints
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, surface_at

NEAR_M = 0.6

_HEADROOM_M = 0.05
"""A higher solid whose bottom is less than this above a top buries it."""
_SAME_M = 1e-3
"""Tops that differ by less are one."""
_EVEN_M = 0.03
"""Heel and toe whose heights differ by less are on one tread, or on a slope."""
_TOE_SHARE = 0.85
"""Share of a foot, from the heel, that must be on its tread."""
_SHIFTS_M = np.array([0.0, *(s * k * 0.025 for k in range(1, 9) for s in (1.0, -1.0))])
"""Distances by which a foot may be moved along itself to be on one tread, the least first."""


class SolidArrays(NamedTuple):
    """S solids, with an index of those about each bucket of the map."""

    corners: Floats
    """(K, 2), metres: the rings, one after the other."""
    begins: Ints
    """(S + 1,): the corner with which the ring of each begins."""
    boxes: Floats
    """(S, 4), metres: least x, least y, greatest x, greatest y."""
    bottoms: Floats
    """(S,), metres."""
    tops: Floats
    """(S,), metres: of a ramp at its end."""
    ramps: Floats
    """(S, 6): x, y where a ramp begins, the way to its end, the square of its length, and the
    height at its beginning."""
    sloped: Bools
    """(S,): whether the top is a ramp."""
    carries: Bools
    """(S,): whether one can stand on it."""
    first: Ints
    """(nx * ny + 1,): the place of the first member of each bucket, row by row."""
    members: Ints
    """(M,): solids whose box meets a bucket, ascending in each."""
    x0: float
    y0: float
    per_m: float
    """Buckets a metre."""
    nx: int
    ny: int
    most: int
    """Largest number of members of a bucket."""


class GroundArrays(NamedTuple):
    """The standing surfaces of a zone."""

    flat: bool
    """Whether all of it is at height 0."""
    exact: bool
    """Whether the solids say it; else only the cells do."""
    solids: SolidArrays
    grid: GridArrays


class Covering(NamedTuple):
    """Memory for the solids over one point."""

    solids: Ints
    tops: Floats


@kernel
def new_covering(ground: GroundArrays) -> Covering:
    """Memory for as many solids as may be over one point."""
    return Covering(np.empty(ground.solids.most, np.int64), np.empty(ground.solids.most))


@inlined
def _bucket(solids: SolidArrays, x: float, y: float) -> int:
    """The bucket that holds a point, or is the nearest to it."""
    i = int(min(max((x - solids.x0) * solids.per_m, 0.0), solids.nx - 1.0))
    j = int(min(max((y - solids.y0) * solids.per_m, 0.0), solids.ny - 1.0))
    return j * solids.nx + i


@inlined
def _covers(solids: SolidArrays, s: int, x: float, y: float) -> bool:
    """Whether a point lies inside the ring of a solid."""
    box = solids.boxes[s]
    if x < box[0] or y < box[1] or x > box[2] or y > box[3]:
        return False
    inside = False
    begin, end = solids.begins[s], solids.begins[s + 1]
    before = end - 1
    for k in range(begin, end):
        x0, y0 = solids.corners[k, 0], solids.corners[k, 1]
        x1, y1 = solids.corners[before, 0], solids.corners[before, 1]
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) * (x1 - x0) / (y1 - y0):
            inside = not inside
        before = k
    return inside


@inlined
def _top_at(solids: SolidArrays, s: int, x: float, y: float) -> float:
    """Height of the top of a solid at a point."""
    top = solids.tops[s]
    if not solids.sloped[s]:
        return float(top)
    ramp = solids.ramps[s]
    along = (x - ramp[0]) * ramp[2] + (y - ramp[1]) * ramp[3]
    share = min(1.0, max(0.0, along / ramp[4]))
    return float(ramp[5] + share * (top - ramp[5]))


@inlined
def height_at(ground: GroundArrays, covering: Covering, x: float, y: float, near_m: float) -> float:
    """Height of the ground at a point; nan where there is none within NEAR_M of a height.

    Of several surfaces the one nearest to that height is meant.
    """
    if ground.flat:
        return 0.0
    if not ground.exact:
        cell = surface_at(ground.grid, x, y, near_m)
        floor = float(ground.grid.layered.floors[cell]) if cell >= 0 else np.nan
        return floor if abs(floor - near_m) <= NEAR_M else np.nan
    solids = ground.solids
    count = 0
    bucket = _bucket(solids, x, y)
    for m in range(solids.first[bucket], solids.first[bucket + 1]):
        s = solids.members[m]
        if _covers(solids, s, x, y):
            covering.solids[count] = s
            covering.tops[count] = _top_at(solids, s, x, y)
            count += 1
    best, least = np.nan, np.inf
    for k in range(count + 1):
        top = 0.0
        if k < count:
            if not solids.carries[covering.solids[k]]:
                continue
            top = covering.tops[k]
        away = abs(top - near_m)
        if away >= least:
            continue
        buried = False
        for other in range(count):
            under = solids.bottoms[covering.solids[other]] < top + _HEADROOM_M
            buried = buried or (under and covering.tops[other] > top + _SAME_M)
        if not buried:
            best, least = top, away
    return best if least <= NEAR_M else np.nan


@inlined
def settle_foot(ground: GroundArrays, covering: Covering, footprint: Floats, foot_m: float) -> bool:
    """Put a foot (4,) on the ground, in place; whether there is any. See `Ground.settle`."""
    if ground.flat:
        footprint[Z] = 0.0
        return True
    cos, sin = math.cos(footprint[HEADING]), math.sin(footprint[HEADING])
    x, y, near_m = footprint[0], footprint[1], footprint[Z]
    toe_m = _TOE_SHARE * foot_m
    first = np.nan
    for k in range(len(_SHIFTS_M)):
        heel_x, heel_y = x + _SHIFTS_M[k] * cos, y + _SHIFTS_M[k] * sin
        heel, toe = np.nan, np.nan
        for end in range(2):
            at = end * toe_m
            found = height_at(ground, covering, heel_x + at * cos, heel_y + at * sin, near_m)
            if end == 0:
                heel = found
            else:
                toe = found
        if abs(heel - toe) < _EVEN_M:
            footprint[0], footprint[1] = heel_x, heel_y
            footprint[Z] = 0.5 * (heel + toe)
            return True
        if k == 0:
            first = heel
    if math.isnan(first):
        return False
    footprint[Z] = first
    return True


@kernel
def fill_heights(ground: GroundArrays, points: Floats, near_m: Floats, out: Floats) -> None:
    """Write the heights of the ground at points (N, 2) near heights (N,) to out (N,)."""
    covering = new_covering(ground)
    for i in range(len(points)):
        out[i] = height_at(ground, covering, points[i, 0], points[i, 1], near_m[i])


@kernel
def settle_feet(ground: GroundArrays, footprints: Floats, foot_m: Floats, found: Bools) -> None:
    """Put feet (N, 4) on the ground, in place, and write to found (N,) whether there is any."""
    covering = new_covering(ground)
    for i in range(len(footprints)):
        found[i] = settle_foot(ground, covering, footprints[i], foot_m[i])
