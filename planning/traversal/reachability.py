"""Reachability: the neighbours that a body may step to from each cell (Huang & Li, sec. 4.1).

A cell reaches its neighbour if the body can step over the difference in height and has room for
its height above both. Our departure: no wall may stand between the two, since our walls are lines,
while the obstacles of the paper are cells.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._barrier_kernels import Measures, NearBarriers, list_barriers
from esplanade.planning.ground.barriers import Barriers
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal import _reachability_kernels as kernels
from esplanade.planning.traversal._anchor_kernels import ANY, place_anchors
from esplanade.planning.traversal.tiles import CellBox, all_cells, wider

_REACH_CELLS = 1.1
"""Anchors are pushed, and links lead, no further than this many cells from a centre."""


def measures_of(body: Body) -> Measures:
    """The measures of a body, for kernels."""
    return Measures(
        float(body.radius_m), float(body.height_m), float(body.step_on_m), float(body.leg_length_m)
    )


def near_barriers(arrays: LayeredArrays, barriers: Barriers, body: Body) -> NearBarriers:
    """The barriers of each cell that a body in it could touch, or cross on a step out of it.

    Cost O(barriers x cells near one). `barriers` (S,) are shared, not copied: a door that opens or
    closes changes its row in place, with a climb of 0 while it is open.
    """
    reach = body.radius_m + _REACH_CELLS * arrays.cell_m
    first = np.full(len(arrays.floors), -1, dtype=np.int32)
    entries = list_barriers(arrays, barriers, measures_of(body), reach, first)
    return NearBarriers(barriers, first, entries, reach)


def reachable_steps(
    arrays: LayeredArrays, near: NearBarriers, body: Body
) -> tuple[NDArray[np.uint8], NDArray[np.int8]]:
    """The links that a body may follow, uint8 (N,), and where it has room in cells, int8 (E, 2).

    Bit d of the former stands for link d; the latter is as `Traversability.offsets`. Cost O(cells +
    barriers near cells).
    """
    cells, box = len(arrays.floors), all_cells(arrays)
    steps = np.zeros(cells, dtype=np.uint8)
    offsets = np.zeros((len(near.entries), 2), dtype=np.int8)
    rooms = np.empty(cells, dtype=np.float32)
    measures = measures_of(body)
    place_anchors(arrays, near, measures, box, ANY, offsets, rooms)
    kernels.step_bits(arrays, near, measures, offsets, rooms, box, ANY, steps)
    return steps, offsets


def renew_steps(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Body,
    row: int,
    box: CellBox,
    out: tuple[NDArray[np.uint8], NDArray[np.int8]],
) -> None:
    """Derive again, in place, what `reachable_steps` has returned, after one barrier has changed.

    `row` is the barrier's; all cells that list it lie in `box`.
    """
    steps, offsets = out
    rooms = np.empty(len(arrays.floors), dtype=np.float32)
    measures = measures_of(body)
    place_anchors(arrays, near, measures, wider(arrays, box, 1), row, offsets, rooms)
    # Links between changed cells and others are written in either of the two.
    kernels.step_bits(arrays, near, measures, offsets, rooms, wider(arrays, box, 1), row, steps)


def reachable_from(
    arrays: LayeredArrays, steps: NDArray[np.uint8], cells: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Whether steps lead to each cell from any of some cells (K,), bool (N,)."""
    reached = np.zeros(len(steps), dtype=np.bool_)
    kernels.flood(arrays.links, steps, np.asarray(cells, dtype=np.int64).reshape(-1), reached)
    return reached
