"""Gaps in the floors of meshes that everybody steps across, on bare arrays.

Floors are often drawn room by room, with a slit under each wall and threshold. Where the centre of
a column falls into one, the floor is missing there; it is put back between two neighbours.
"""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._ledge_kernels import LEAST_STEP_M
from esplanade.planning.ground._surface_kernels import LOWEST_M, Raster


@inlined
def _next_above(heights: NDArray[np.float32], first: int, last: int, z: float) -> float:
    """What comes next above a gap at height z; -inf if anything is in it or close to it."""
    for k in range(first, last):
        if heights[k] > z - LOWEST_M:
            return float(heights[k]) if heights[k] >= z + LOWEST_M else -np.inf
    return np.inf


@kernel
def find_gaps(
    raster: Raster,
    hits: tuple[NDArray[np.int64], NDArray[np.float32]],
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
    columns: NDArray[np.int32],
    surfaces: NDArray[np.float32],
) -> int:
    """Where a column has nothing between two floors, west and east or south and north, on a level.

    `hits` (starts, heights) are what the vertical through each column meets, in order. Of
    each gap `columns` (G,) receive the column, `surfaces` (G, 2) floor and ceiling; there is room
    enough for two of each floor. Returns how many there are.
    """
    hit_starts, heights = hits
    count = 0
    for c in range(raster.ny * raster.nx):
        j, i = c // raster.nx, c % raster.nx
        since = count
        for axis in range(2):
            if (0 < i < raster.nx - 1) if axis == 0 else (0 < j < raster.ny - 1):
                apart = 1 if axis == 0 else raster.nx
                for a in range(starts[c - apart], starts[c - apart + 1]):
                    for b in range(starts[c + apart], starts[c + apart + 1]):
                        if abs(floors[a] - floors[b]) > LEAST_STEP_M:
                            continue
                        z = 0.5 * (floors[a] + floors[b])
                        free = True
                        for k in range(since, count):
                            free &= abs(surfaces[k, 0] - z) >= LOWEST_M
                        above = _next_above(heights, hit_starts[c], hit_starts[c + 1], z)
                        ceiling = min(above, ceilings[a], ceilings[b])
                        if free and ceiling - z >= LOWEST_M:
                            columns[count] = c
                            surfaces[count] = (z, ceiling)
                            count += 1
    return count


@kernel
def put_in(
    starts: NDArray[np.int32],
    heights: tuple[NDArray[np.float32], NDArray[np.float32]],
    columns: NDArray[np.int32],
    surfaces: NDArray[np.float32],
    new_starts: NDArray[np.int32],
    new_heights: tuple[NDArray[np.float32], NDArray[np.float32]],
) -> None:
    """Put surfaces of `find_gaps` among (floors, ceilings) that are listed by column (CSR)."""
    floors, ceilings = new_heights
    n = 0
    k = 0
    for c in range(len(starts) - 1):
        new_starts[c] = n
        for s in range(starts[c], starts[c + 1]):
            floors[n] = heights[0][s]
            ceilings[n] = heights[1][s]
            n += 1
        while k < len(columns) and columns[k] == c:
            m = n
            while m > new_starts[c] and floors[m - 1] > surfaces[k, 0]:
                floors[m] = floors[m - 1]
                ceilings[m] = ceilings[m - 1]
                m -= 1
            floors[m] = surfaces[k, 0]
            ceilings[m] = surfaces[k, 1]
            if m > new_starts[c]:
                ceilings[m - 1] = min(ceilings[m - 1], surfaces[k, 0])
            n += 1
            k += 1
    new_starts[len(starts) - 1] = n
