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
    anchors: NDArray[np.float32]
    """(N, 2): the point of each cell that paths go through, metres: the centre if the body fits
    there, else where it has most room."""
    steps: NDArray[np.uint8]
    """(N,): the links that the body may follow; bit d stands for link d."""
    classes: NDArray[np.uint8]
    """(N,): `Stability` of each cell."""
    edge_cells: int
    """M: fewer cells than these in a row may lie on edges."""
