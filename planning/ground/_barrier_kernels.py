"""Barriers near cells, on bare arrays: lists by cell, and what a barrier is to a body."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._geometry_kernels import TOLERANCE_M, point_segment_distance
from esplanade.planning.ground.layered import LINK_M, LayeredArrays, cell_index

LISTED = np.dtype([("barrier", "i4"), ("next", "i4")])
"""An entry of a linked list: the row of a barrier, and the next entry of the same cell or -1."""


class NearBarriers(NamedTuple):
    """A linked list of the barriers that pass near it, for each of N cells."""

    barriers: NDArray[np.void]
    """(S,) of `BARRIER`; a door that opens or closes changes its row in place."""
    first: NDArray[np.int32]
    """(N,): the first entry of each cell, -1 without any."""
    entries: NDArray[np.void]
    """(E,) of `LISTED`."""
    reach_m: float
    """A cell lists the barriers that pass within this distance of its centre."""


class Measures(NamedTuple):
    """Measures of a `Body`, in metres."""

    radius_m: float
    height_m: float
    step_on_m: float
    leg_length_m: float


@inlined
def point_barrier_distance(barrier: np.void, x: float, y: float) -> float:
    """Distance on the plan from a point to a barrier."""
    return point_segment_distance(x, y, barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"])


@inlined
def height_to_climb(barrier: np.void, lowest: float, highest: float, height: float) -> float:
    """Height that a body has to climb to pass a barrier, in metres.

    It is 0 where the body passes below the barrier, and where the barrier is an open door.
    `lowest` and `highest` are the heights of the floors on either side.
    """
    if barrier["bottom_m"] >= highest + height - TOLERANCE_M:
        return 0.0
    return float(max(0.0, min(barrier["top_m"] - lowest, barrier["climb_m"])))


@inlined
def segment_barrier_distance(barrier: np.void, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance on the plan between a barrier and the segment ab, if the two do not cross."""
    px, py, qx, qy = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
    return min(
        point_segment_distance(ax, ay, px, py, qx, qy),
        point_segment_distance(bx, by, px, py, qx, qy),
        point_segment_distance(px, py, ax, ay, bx, by),
        point_segment_distance(qx, qy, ax, ay, bx, by),
    )


@kernel
def list_barriers(
    arrays: LayeredArrays,
    barriers: NDArray[np.void],
    body: Measures,
    reach: float,
    first: NDArray[np.int32],
) -> NDArray[np.void]:
    """List for each cell the barriers within `reach` of its centre that may matter to a body.

    `first` (N,) must be preset to -1. Returns the entries, (E,) of `LISTED`. Barriers that the
    body can climb are left out, except open doors, since these may close.
    """
    entries = np.empty(64 * len(barriers) + 8, dtype=LISTED)
    used = 0
    layers = arrays.pages.shape[0]
    cell_m = arrays.cell_m
    for s in range(len(barriers)):
        barrier = barriers[s]
        ax, ay, bx, by = barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"]
        if 0.0 < barrier["climb_m"] <= body.step_on_m:
            continue
        i0 = max(0, int((min(ax, bx) - reach - arrays.x0) / cell_m))
        i1 = min(arrays.nx - 1, int((max(ax, bx) + reach - arrays.x0) / cell_m))
        j0 = max(0, int((min(ay, by) - reach - arrays.y0) / cell_m))
        j1 = min(arrays.ny - 1, int((max(ay, by) + reach - arrays.y0) / cell_m))
        for j in range(j0, j1 + 1):
            y = arrays.y0 + (j + 0.5) * cell_m
            for i in range(i0, i1 + 1):
                x = arrays.x0 + (i + 0.5) * cell_m
                if point_segment_distance(x, y, ax, ay, bx, by) > reach:
                    continue
                for layer in range(layers):
                    cell = cell_index(arrays, layer, j, i)
                    if cell < 0:
                        continue
                    floor = arrays.floors[cell]
                    if (
                        barrier["bottom_m"] >= floor + LINK_M + body.height_m
                        or barrier["top_m"] <= floor
                    ):
                        continue
                    if used == len(entries):
                        wider = np.empty(2 * used, dtype=LISTED)
                        wider[:used] = entries
                        entries = wider
                    entries[used]["barrier"] = s
                    entries[used]["next"] = first[cell]
                    first[cell] = used
                    used += 1
    return entries[:used].copy()
