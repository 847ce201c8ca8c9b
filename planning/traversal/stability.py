"""How a body stands in each cell: the five classes of Huang & Li, sec. 4.2."""

from __future__ import annotations

import math
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._barrier_kernels import NearBarriers
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal import _stability_kernels as kernels
from esplanade.planning.traversal._reachability_kernels import Box
from esplanade.planning.traversal.reachability import measures_of, whole


class Stability(IntEnum):
    """What lies within a body's radius of a cell."""

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


def touched_cells(radius_m: float, cell_m: float) -> NDArray[np.int64]:
    """Rows and columns (K, 2) from a cell to all others that a disc on its centre touches."""
    reach = math.ceil(radius_m / cell_m + 0.5)
    away = cell_m * np.maximum(0.0, np.abs(np.arange(-reach, reach + 1)) - 0.5)
    rows, columns = np.nonzero(np.hypot(away[:, None], away[None, :]) < radius_m - 1e-6)
    around = (rows != reach) | (columns != reach)
    touched: NDArray[np.int64] = np.stack([rows, columns], axis=1)[around] - reach
    return touched


def classify(
    arrays: LayeredArrays,
    near: NearBarriers,
    body: Body,
    out: NDArray[np.uint8] | None = None,
    box: Box | None = None,
) -> NDArray[np.uint8]:
    """The `Stability` of each cell for a body, uint8 (N,).

    With `box`, only those tiles of `out` are written anew. Cost O(cells x cells touched); floors
    without any edge cost less.

    Notes
    -----
    Huang & Li, sec. 4.2, with heights compared between cells that the body's disc touches. Where
    the paper leaves open what is meant:

    - ground that rises by less than `RAMP_SLOPE` is flat, else no ramp could be longer than M;
    - a hole in the layer is an obstacle, what lies beyond the bounds is not;
    - the layer above is any higher layer, as a way may lead on from any layer to any other;
    - walls are Forbidden whatever other layers offer; low ones that a leg passes are edges;
    - what is too low for the body's head is an obstacle like any other.
    """
    classes = np.zeros(len(arrays.floors), dtype=np.uint8) if out is None else out
    kernels.classify(
        arrays,
        near,
        measures_of(body),
        touched_cells(body.radius_m, arrays.cell_m),
        box or whole(arrays),
        classes,
    )
    return classes
