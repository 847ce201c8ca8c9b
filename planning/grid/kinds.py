"""Where the kinds of body of a grid fit, in the arrays that kernels read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from esplanade.planning.grid._grid_kernels import MEASURES, KindArrays
from esplanade.planning.ground._barrier_kernels import LISTED
from esplanade.planning.ground.barriers import Barriers
from esplanade.planning.traversal.traversability import Traversability


def kind_arrays(barriers: Barriers, cells: int, found: Sequence[Traversability]) -> KindArrays:
    """The arrays of kinds of body, row by row, on so many cells. Cost O(cells x kinds).

    `barriers` (S,) are those that the lists of the traversabilities refer to.
    """
    anchors = np.empty((len(found), cells, 2), dtype=np.float32)
    steps = np.empty((len(found), cells), dtype=np.uint8)
    first = np.empty((len(found), cells), dtype=np.int32)
    measures = np.empty(len(found), dtype=MEASURES)
    entries = np.empty(sum(len(one.near.entries) for one in found), dtype=LISTED)
    used = 0
    for row, one in enumerate(found):
        anchors[row], steps[row] = one.anchors, one.steps
        measures[row] = (*one.body, one.near.reach_m)
        heads, listed = one.near.first, one.near.entries
        first[row] = np.where(heads < 0, -1, heads + used)
        own = entries[used : used + len(listed)]
        own["barrier"] = listed["barrier"]
        own["next"] = np.where(listed["next"] < 0, -1, listed["next"] + used)
        used += len(listed)
    return KindArrays(anchors, steps, first, entries, barriers, measures)
