"""Gaps in the floors of meshes that bodies step across, on bare arrays.

Floors are often drawn room by room, with a slit under each wall and threshold. Where the centre of
a column falls into a slit, the floor is missing; it is put back between two neighbours. So it is
where the centre falls on the steep side of a step: there is the floor above or that below.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._ledge_kernels import LEAST_STEP_M
from esplanade.planning.ground._surface_kernels import LEAST_HEADROOM_M, Raster
from esplanade.planning.ground.layered import LINK_M

GAP = np.dtype([("column", "i4"), ("floor", "f4"), ("ceiling", "f4")])
"""A surface over a gap: its column of the grid, its floor and its ceiling in metres."""

_SAME_M = 1e-2
"""A hit that is further below or above two floors does not lie between them."""


class ColumnSurfaces(NamedTuple):
    """S standing surfaces by column (CSR), lowest first."""

    starts: NDArray[np.int32]
    """(columns + 1,): where the surfaces of each column begin."""
    floors: NDArray[np.float32]
    """(S,): heights of the floors, metres."""
    ceilings: NDArray[np.float32]
    """(S,): heights of the ceilings, metres."""


class Hits(NamedTuple):
    """Heights (H,) where the verticals through columns meet triangles, by column, lowest first."""

    starts: NDArray[np.int64]
    """(columns + 1,): where the hits of each column begin."""
    heights: NDArray[np.float32]


@inlined
def _next_above(heights: NDArray[np.float32], first: int, last: int, z: float) -> float:
    """Height of the next hit above a gap at height z; -inf if a hit lies in the gap or near it."""
    for k in range(first, last):
        if heights[k] > z - LEAST_HEADROOM_M:
            return float(heights[k]) if heights[k] >= z + LEAST_HEADROOM_M else -np.inf
    return np.inf


@inlined
def _over_side(
    heights: NDArray[np.float32], first: int, last: int, low: float, high: float
) -> tuple[float, float]:
    """The floor over the steep side of a step, and the height of the next hit above the step.

    The floor is `low` or `high`, whichever is nearer to the highest hit between them; nan where
    there is none.
    """
    side, above = np.nan, np.inf
    for k in range(first, last):
        if heights[k] > high + _SAME_M:
            above = float(heights[k])
            break
        if heights[k] >= low - _SAME_M:
            side = float(heights[k])
    if np.isnan(side):
        return np.nan, above
    return (low if side - low < high - side + _SAME_M else high), above


@kernel
def find_gaps(raster: Raster, hits: Hits, surfaces: ColumnSurfaces, out: NDArray[np.void]) -> int:
    """Find columns without a floor of their own between two floors that bodies step between.

    These lie west and east or south and north; there is nothing in the column where they are level,
    else the side of the step. Sides of steps may lie aslant between two floors, too. `out` (G,) of
    `GAP` has room for four gaps of each surface. Returns the number of gaps.
    """
    starts, floors, ceilings = surfaces
    count = 0
    for c in range(raster.ny * raster.nx):
        j, i = c // raster.nx, c % raster.nx
        since = count
        for axis in range(4):
            across = axis == 1 or 0 < i < raster.nx - 1
            if across and (axis == 0 or 0 < j < raster.ny - 1):
                apart = 1 if axis == 0 else raster.nx + (0, 0, 1, -1)[axis]
                for a in range(starts[c - apart], starts[c - apart + 1]):
                    for b in range(starts[c + apart], starts[c + apart + 1]):
                        low = float(min(floors[a], floors[b]))
                        high = float(max(floors[a], floors[b]))
                        if high - low > LINK_M + _SAME_M:
                            continue
                        first, last = hits.starts[c], hits.starts[c + 1]
                        if high - low <= LEAST_STEP_M:
                            if axis > 1:
                                continue
                            z = high = 0.5 * (low + high)
                            above = _next_above(hits.heights, first, last, z)
                        else:
                            z, above = _over_side(hits.heights, first, last, low, high)
                        free = not np.isnan(z)
                        for k in range(since, count):
                            free &= abs(out[k]["floor"] - z) >= LEAST_HEADROOM_M
                        for s in range(starts[c], starts[c + 1]):
                            free &= abs(floors[s] - z) >= LEAST_HEADROOM_M
                        ceiling = min(above, ceilings[a], ceilings[b])
                        if free and ceiling - high >= LEAST_HEADROOM_M:
                            out[count]["column"] = c
                            out[count]["floor"] = z
                            out[count]["ceiling"] = ceiling
                            count += 1
    return count


@kernel
def insert_gaps(before: ColumnSurfaces, gaps: NDArray[np.void], after: ColumnSurfaces) -> None:
    """Fill `after` with surfaces and with the gaps (G,) of `GAP` that `find_gaps` found."""
    starts, floors, ceilings = after
    n = 0
    k = 0
    for c in range(len(starts) - 1):
        starts[c] = n
        for s in range(before.starts[c], before.starts[c + 1]):
            floors[n] = before.floors[s]
            ceilings[n] = before.ceilings[s]
            n += 1
        while k < len(gaps) and gaps[k]["column"] == c:
            floor = gaps[k]["floor"]
            m = n
            while m > starts[c] and floors[m - 1] > floor:
                floors[m] = floors[m - 1]
                ceilings[m] = ceilings[m - 1]
                m -= 1
            floors[m] = floor
            ceilings[m] = gaps[k]["ceiling"]
            if m > starts[c]:
                ceilings[m - 1] = min(ceilings[m - 1], floor)
            n += 1
            k += 1
    starts[len(starts) - 1] = n
