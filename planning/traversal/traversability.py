"""Traversability: everything that decides where one body may go, for kernels."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._barrier_kernels import Measures, NearBarriers
from esplanade.planning.ground.layered import LayeredArrays


class Traversability(NamedTuple):
    """The floors of a zone, and where one body may go on them."""

    arrays: LayeredArrays
    near: NearBarriers
    body: Measures
    offsets: NDArray[np.int8]
    """(E, 2), in the row of the first entry of a cell's list of barriers: how far the point of the
    cell that paths go through lies off the centre, in 1/254 of a cell: 0 if the body fits at the
    centre, else where it has room; `anchor_of` has the point."""
    steps: NDArray[np.uint8]
    """(N,): the links that the body may follow; bit d stands for link d."""
    classes: NDArray[np.uint8]
    """(N,): `Stability` of each cell."""
    edge_cells: int
    """M: fewer cells than these in a row may lie on edges."""
