"""Clearances: the distance of each cell to the barriers that stop a kind of body."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.grid._walking_kernels import lower_to_barriers
from esplanade.planning.ground._geometry_kernels import BarrierIndex
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal.reachability import measures_of

CLEARANCE_CAP_M = 3.0
"""Greatest clearance that is kept: anything further away makes no difference."""
Box = tuple[float, float, float, float]
"""x0, y0, x1, y1 in metres."""

_BODY_STEP_M = 0.05
_RADIUS_STEP_M = 0.01
_FINE_STEP_M = 0.01
_LOW_STEP_M = 0.1
"""Wheels that step over a few centimetres get up ramps, whose cells rise by that much."""
_ALMOST = 1e-9
_ROUNDING_M = 1e-4


def kind_of(body: Body) -> Body:
    """The kind of a body: it is nowhere where the body is not, and shared by bodies much alike.

    The radius is rounded up to 1 cm, the height up to 5 cm, the steps that it takes down to 5 cm,
    or to 1 cm below 10 cm; M is ignored.
    """
    return replace(
        body,
        radius_m=_rounded(body.radius_m, math.ceil, -_ALMOST, _RADIUS_STEP_M),
        height_m=_rounded(body.height_m, math.ceil, -_ALMOST),
        step_on_m=_rounded_step(body.step_on_m),
        leg_length_m=_rounded_step(body.leg_length_m),
        edge_cells=Body.edge_cells,
    )


def _rounded_step(metres: float) -> float:
    fine = metres < _LOW_STEP_M
    return _rounded(metres, math.floor, _ALMOST, _FINE_STEP_M if fine else _BODY_STEP_M)


def _rounded(
    metres: float, to_whole: Callable[[float], int], slack: float, step_m: float = _BODY_STEP_M
) -> float:
    return round(to_whole(metres / step_m + slack) * step_m, 9)


def write_clearance(
    arrays: GridArrays,
    index: BarrierIndex,
    body: Body,
    box: Box,
    cells: NDArray[np.int64],
    out: NDArray[np.float32],
) -> None:
    """Write the clearance of a body in all cells of a box into `out` (N,), metres.

    `cells` are the cells of the box. Clearance is negative in holes and under ceilings that are
    too low.
    """
    out[cells] = CLEARANCE_CAP_M
    lower_to_barriers(arrays, index, measures_of(body), CLEARANCE_CAP_M, box, out)
    room_m = arrays.layered.ceilings[cells] - arrays.layered.floors[cells]
    out[cells[~(room_m >= body.height_m - _ROUNDING_M)]] *= -1.0


def with_row(rows: NDArray[Any], row: int, values: NDArray[Any]) -> NDArray[Any]:
    """A copy of rows (K, N) in which one is (N,), be it one more."""
    if row == len(rows):
        return np.concatenate([rows, values[None]])
    written = rows.copy()
    written[row] = values
    return written


def centres_of(layered: LayeredArrays, places: NDArray[np.void]) -> NDArray[np.float64]:
    """Centres of cells at some places (K,), float64 (K, 2), metres."""
    centres = np.empty((len(places), 2))
    centres[:, 0] = (places["column"] + 0.5) * layered.cell_m + layered.x0
    centres[:, 1] = (places["row"] + 0.5) * layered.cell_m + layered.y0
    return centres


def cells_within(layered: LayeredArrays, box: Box) -> NDArray[np.int64]:
    """The cells, holes included, whose centres lie in a box, int64 (K,)."""
    tile_m = TILE * layered.cell_m
    i0, i1 = (max(0, int((x - layered.x0) // tile_m)) for x in box[::2])
    j0, j1 = (max(0, int((y - layered.y0) // tile_m)) for y in box[1::2])
    pages = layered.pages[:, j0 : j1 + 1, i0 : i1 + 1]
    cells = (pages[pages >= 0].astype(np.int64)[:, None] + np.arange(TILE**2)).ravel()
    near = centres_of(layered, layered.places[cells])
    within: NDArray[np.int64] = cells[((near >= box[:2]) & (near <= box[2:])).all(axis=1)]
    return within
