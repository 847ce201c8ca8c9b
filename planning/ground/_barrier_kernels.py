"""Barriers near cells, on bare arrays: lists by cell, and what a barrier is to a body."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._geometry_kernels import segments_cross
from esplanade.planning.ground.layered import LINK_M, LayeredArrays, cell_index

HAIR_M = 1e-4
"""Heights and lengths that differ by less are equal: floors are rounded to float32."""


class NearBarriers(NamedTuple):
    """For each cell the barriers that pass near it: linked lists."""

    barriers: NDArray[np.float64]
    """(S, 7): x0, y0, x1, y1, z0, z1, rise, metres. It stops a body that stands at z iff
    z0 < z + height and z1 > z + step-on and step-on < rise."""
    first: NDArray[np.int32]
    """(N,): a cell's first entry, -1: none."""
    entries: NDArray[np.int32]
    """(E, 2): row of a barrier, next entry of the same cell or -1."""
    reach_m: float
    """Barriers that pass within so much of a cell's centre are listed."""


class Measures(NamedTuple):
    """A body's measures."""

    radius_m: float
    height_m: float
    step_on_m: float
    leg_length_m: float


@inlined
def point_to_segment(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance from a point to a segment."""
    dx = bx - ax
    dy = by - ay
    length2 = dx * dx + dy * dy
    u = 0.0
    if length2 > 0.0:
        u = min(1.0, max(0.0, ((px - ax) * dx + (py - ay) * dy) / length2))
    ex = px - ax - u * dx
    ey = py - ay - u * dy
    return float(np.sqrt(ex * ex + ey * ey))


@inlined
def to_raise(barrier: NDArray[np.float64], lowest: float, highest: float, height: float) -> float:
    """How high a body must step to pass a barrier; 0: it passes below it, or nothing is there.

    `lowest` and `highest` are the floors on either side.
    """
    if barrier[4] >= highest + height - HAIR_M:
        return 0.0
    return float(max(0.0, min(barrier[5] - lowest, barrier[6])))


@inlined
def crosses(barrier: NDArray[np.float64], ax: float, ay: float, bx: float, by: float) -> bool:
    """Whether the way from a to b meets a barrier, touching included."""
    return segments_cross(ax, ay, bx, by, barrier[0], barrier[1], barrier[2], barrier[3])


@inlined
def way_to_barrier(
    barrier: NDArray[np.float64], ax: float, ay: float, bx: float, by: float
) -> float:
    """Distance between a barrier and the way from a to b, which do not cross."""
    px, py, qx, qy = barrier[0], barrier[1], barrier[2], barrier[3]
    return min(
        point_to_segment(ax, ay, px, py, qx, qy),
        point_to_segment(bx, by, px, py, qx, qy),
        point_to_segment(px, py, ax, ay, bx, by),
        point_to_segment(qx, qy, ax, ay, bx, by),
    )


@kernel
def list_barriers(
    arrays: LayeredArrays,
    barriers: NDArray[np.float64],
    body: Measures,
    reach: float,
    first: NDArray[np.int32],
) -> NDArray[np.int32]:
    """List for each cell the barriers within `reach` of its centre that might matter to a body.

    `first` (N,) must be preset to -1; returns the entries, int32 (E, 2).
    """
    entries = np.empty((64 * len(barriers) + 8, 2), dtype=np.int32)
    used = 0
    layers = arrays.pages.shape[0]
    cell_m = arrays.cell_m
    for s in range(len(barriers)):
        ax, ay, bx, by, z0, z1, rise = barriers[s]
        if 0.0 < rise <= body.step_on_m:
            continue
        i0 = max(0, int((min(ax, bx) - reach - arrays.x0) / cell_m))
        i1 = min(arrays.nx - 1, int((max(ax, bx) + reach - arrays.x0) / cell_m))
        j0 = max(0, int((min(ay, by) - reach - arrays.y0) / cell_m))
        j1 = min(arrays.ny - 1, int((max(ay, by) + reach - arrays.y0) / cell_m))
        for j in range(j0, j1 + 1):
            y = arrays.y0 + (j + 0.5) * cell_m
            for i in range(i0, i1 + 1):
                x = arrays.x0 + (i + 0.5) * cell_m
                if point_to_segment(x, y, ax, ay, bx, by) > reach:
                    continue
                for layer in range(layers):
                    cell = cell_index(arrays, layer, j, i)
                    if cell < 0:
                        continue
                    floor = arrays.floors[cell]
                    if z0 >= floor + LINK_M + body.height_m or z1 <= floor:
                        continue
                    if used == len(entries):
                        wider = np.empty((2 * used, 2), dtype=np.int32)
                        wider[:used] = entries
                        entries = wider
                    entries[used, 0] = s
                    entries[used, 1] = first[cell]
                    first[cell] = used
                    used += 1
    return entries[:used].copy()
