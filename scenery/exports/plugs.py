"""Undersides in holes of a single cell, so that who reads the mesh does not close them.

Readers of meshes put floor over slits that are no wider than a cell (`find_gaps` in
`planning/ground`), for whoever drew them drew rooms one by one. Here a hole is meant: something
solid stands in it. A face that looks down carries nobody, and says that there is something.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground._ledge_kernels import LEAST_STEP_M
from esplanade.planning.ground._surface_kernels import LEAST_HEADROOM_M
from esplanade.scenery.exports.layers import LayerCells

Floats = NDArray[np.float64]

_MOST_BY_PAIRS: Final = 12
"""With more layers than these, both sides of a hole are looked for in one layer only."""


def plugs_of(layers: Sequence[LayerCells]) -> Floats:
    """Rows, columns and heights (P, 3) of single cells without a floor between two level ones."""
    found = [np.empty((0, 3))]
    for one in layers:
        others = layers if len(layers) <= _MOST_BY_PAIRS else (one,)
        for other in others:
            found.append(_between(one.floors, other.floors))
            found.append(_between(one.floors.T, other.floors.T)[:, [1, 0, 2]])
    plugs = np.unique(np.concatenate(found), axis=0)
    rows, columns = plugs[:, :2].astype(np.int64).T
    free = np.ones(len(plugs), dtype=np.bool_)
    for layer in layers:
        # A floor as near as this leaves no room for another one.
        free &= ~(np.abs(layer.floors[rows, columns] - plugs[:, 2]) < LEAST_HEADROOM_M)
    return plugs[free]


def _between(west: Floats, east: Floats) -> Floats:
    """Rows, columns and heights of cells between one floor to the west and one to the east."""
    left, right = west[:, :-2], east[:, 2:]
    rows, columns = np.nonzero(np.abs(left - right) <= LEAST_STEP_M)
    height = 0.5 * (left[rows, columns] + right[rows, columns])
    return np.stack([rows, columns + 1, height], axis=1)
