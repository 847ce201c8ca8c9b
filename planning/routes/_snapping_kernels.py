"""Snapping a point to the nearest place where a body can stand, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel
from esplanade.planning.ground._barrier_kernels import height_to_climb
from esplanade.planning.ground._geometry_kernels import TOLERANCE_M, crosses
from esplanade.planning.ground.layered import cell_index, cell_near
from esplanade.planning.routes._straightening_kernels import is_clear
from esplanade.planning.scene.heights import SAME_SURFACE_M
from esplanade.planning.traversal._anchor_kernels import anchor_of
from esplanade.planning.traversal._stability_kernels import FORBIDDEN
from esplanade.planning.traversal.traversability import Traversability

SNAP_M = 0.5
"""Greatest distance that a body may be moved to where it can stand."""
_INSIDE_M = 1e-3
"""Places this far inside the border of a cell certainly lie in the cell."""


@kernel
def snap(
    traversability: Traversability,
    classes: NDArray[np.uint8],
    x: float,
    y: float,
    z: float,
    through: bool,
) -> tuple[int, float, float]:
    """The cell and place where a body can stand that is nearest to (x, y, z); cell -1 if none.

    It is the point itself if the body fits there, else the nearest place within `SNAP_M`: in a
    cell that is not Forbidden by `classes` (N,), at its side next to the point or at its anchor.
    If there is a floor at the point, the place must lie within one straight step of it, which may
    lead through walls only with `through`; otherwise it may lie anywhere.
    """
    arrays, body = traversability.arrays, traversability.body
    own = cell_near(arrays, x, y, z)
    if own >= 0 and abs(arrays.floors[own] - z) > SAME_SURFACE_M:
        own = -1
    floor, highest = z, SAME_SURFACE_M
    if own >= 0:
        floor, highest = float(arrays.floors[own]), body.step_on_m + TOLERANCE_M
        cx, cy = anchor_of(arrays, traversability.near.first, traversability.offsets, own)
        if classes[own] != FORBIDDEN and is_clear(traversability, own, x, y, cx, cy):
            return own, x, y
    best, found, found_x, found_y = np.inf, -1, x, y
    reach = int(SNAP_M / arrays.cell_m) + 1
    half = 0.5 * arrays.cell_m - _INSIDE_M
    j = int((y - arrays.y0) / arrays.cell_m)
    i = int((x - arrays.x0) / arrays.cell_m)
    for layer in range(arrays.pages.shape[0]):
        for jj in range(j - reach, j + reach + 1):
            for ii in range(i - reach, i + reach + 1):
                cell = cell_index(arrays, layer, jj, ii)
                if cell < 0 or classes[cell] == FORBIDDEN:
                    continue
                rise = abs(arrays.floors[cell] - floor)
                if rise > highest:
                    continue
                cx = arrays.x0 + (ii + 0.5) * arrays.cell_m
                cy = arrays.y0 + (jj + 0.5) * arrays.cell_m
                qx, qy = min(max(x, cx - half), cx + half), min(max(y, cy - half), cy + half)
                anchor_x, anchor_y = anchor_of(
                    arrays, traversability.near.first, traversability.offsets, cell
                )
                if not is_clear(traversability, cell, qx, qy, anchor_x, anchor_y):
                    qx, qy = anchor_x, anchor_y
                aside = np.hypot(qx - x, qy - y)
                away = np.hypot(aside, rise)
                if away >= best or aside > SNAP_M:
                    continue
                if own < 0 or through or _is_one_step(traversability, own, cell, x, y, qx, qy):
                    best, found, found_x, found_y = away, cell, qx, qy
    return found, found_x, found_y


@kernel
def _is_one_step(
    traversability: Traversability, own: int, cell: int, x: float, y: float, cx: float, cy: float
) -> bool:
    """Whether no barrier stops a body between a point and another in a cell, in a straight line."""
    floors, body = traversability.arrays.floors, traversability.body
    lowest = float(min(floors[own], floors[cell]))
    highest = float(max(floors[own], floors[cell]))
    for s in range(len(traversability.near.barriers)):
        barrier = traversability.near.barriers[s]
        step = height_to_climb(barrier, lowest, highest, body.height_m)
        if step > body.step_on_m + TOLERANCE_M and crosses(barrier, x, y, cx, cy):
            return False
    return True
