"""Stability of a body in each cell: the five classes of Huang & Li, sec. 4.2."""

from __future__ import annotations

import math
from enum import IntEnum
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._barrier_kernels import NearBarriers
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal import _stability_kernels as kernels
from esplanade.planning.traversal.reachability import measures_of
from esplanade.planning.traversal.tiles import TileBox, all_tiles

_KINDS_KEPT = 256


class Stability(IntEnum):
    """Class of a cell for a body, by the ground within the body's radius."""

    FORBIDDEN = kernels.FORBIDDEN
    """An obstacle: a difference in height above leg length, a wall, a ceiling too low, a hole."""
    STABLE = kernels.STABLE
    """Flat ground all around."""
    UNSTABLE = kernels.UNSTABLE
    """A difference in height up to leg length: the edge of a step or platform."""
    UP_STAIR = kernels.UP_STAIR
    """Forbidden by its own layer, but one above has a floor within leg length."""
    DOWN_STAIR = kernels.DOWN_STAIR
    """The same with a layer below."""


@lru_cache(maxsize=_KINDS_KEPT)
def touched_cells(radius_m: float, cell_m: float) -> NDArray[np.void]:
    """Offsets (K,) of `OFFSET` from a cell to all others that a disc on its centre touches.

    The array is shared by all who ask for it, and nobody writes to it.
    """
    reach = math.ceil(radius_m / cell_m + 0.5)
    away = cell_m * np.maximum(0.0, np.abs(np.arange(-reach, reach + 1)) - 0.5)
    rows, columns = np.nonzero(np.hypot(away[:, None], away[None, :]) < radius_m - 1e-6)
    others = (rows != reach) | (columns != reach)
    touched = np.empty(np.count_nonzero(others), dtype=kernels.OFFSET)
    touched["rows"] = rows[others] - reach
    touched["columns"] = columns[others] - reach
    return touched


def classify(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Body,
    anchors: NDArray[np.int8],
    out: NDArray[np.uint8] | None = None,
    box: TileBox | None = None,
) -> NDArray[np.uint8]:
    """The `Stability` of each cell for a body, uint8 (N,).

    With `box`, only those tiles of `out` are written again. Cost O(cells x cells touched); floors
    without any edge cost less.

    Notes
    -----
    Huang & Li, sec. 4.2, with heights compared between cells that the body's disc touches. The
    paper leaves some points open; here

    - ground that rises by less than `RAMP_SLOPE` is flat, or no ramp could be longer than M;
    - a hole in the layer is an obstacle, the ground beyond the bounds is not;
    - the layer above is any higher layer, since a path may lead from any layer to any other;
    - walls make a cell Forbidden on any layer; walls lower than leg length are edges;
    - a ceiling too low for the body's head is an obstacle like any other.
    """
    classes = np.zeros(len(arrays.floors), dtype=np.uint8) if out is None else out
    kernels.classify(
        arrays,
        near,
        measures_of(body),
        anchors,
        touched_cells(body.radius_m, arrays.cell_m),
        box or all_tiles(arrays),
        classes,
    )
    return classes
