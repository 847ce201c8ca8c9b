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
    steps = np.empty((len(found), cells), dtype=np.uint8)
    first = np.empty((len(found), cells), dtype=np.int32)
    measures = np.empty(len(found), dtype=MEASURES)
    entries = np.empty(sum(len(one.near.entries) for one in found), dtype=LISTED)
    offsets = np.empty((len(entries), 2), dtype=np.int8)
    used = 0
    for row, one in enumerate(found):
        steps[row], first[row] = one.steps, one.near.first
        measures[row] = (*one.body, one.near.reach_m, used)
        entries[used : used + len(one.near.entries)] = one.near.entries
        offsets[used : used + len(one.offsets)] = one.offsets
        used += len(one.near.entries)
    return KindArrays(offsets, steps, first, entries, barriers, measures)


def shared_with(kinds: KindArrays, row: int, one: Traversability) -> Traversability:
    """A traversability that is the same, with its arrays in a row of those of kinds of body."""
    begin = int(kinds.measures["entries"][row])
    end = begin + len(one.near.entries)
    near = one.near._replace(first=kinds.first[row], entries=kinds.entries[begin:end])
    return one._replace(offsets=kinds.offsets[begin:end], steps=kinds.steps[row], near=near)


def moved(kinds: KindArrays, found: Sequence[Traversability]) -> KindArrays:
    """The arrays of kinds of body once a door has moved, row by row."""
    offsets, steps = np.empty_like(kinds.offsets), np.empty_like(kinds.steps)
    for row, one in enumerate(found):
        steps[row] = one.steps
        begin = int(kinds.measures["entries"][row])
        offsets[begin : begin + len(one.offsets)] = one.offsets
    return kinds._replace(offsets=offsets, steps=steps)
