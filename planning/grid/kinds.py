"""Where the kinds of body of a grid fit, in the arrays that kernels read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

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
    steps, offsets = steps_in(kinds, row)
    begin = int(kinds.measures["entries"][row])
    entries = kinds.entries[begin : begin + len(offsets)]
    near = one.near._replace(first=kinds.first[row], entries=entries)
    return one._replace(offsets=offsets, steps=steps, near=near)


def copied(kinds: KindArrays) -> KindArrays:
    """The same arrays of kinds of body, with copies of what changes when a door moves."""
    return kinds._replace(offsets=kinds.offsets.copy(), steps=kinds.steps.copy())


def steps_in(kinds: KindArrays, row: int) -> tuple[NDArray[np.uint8], NDArray[np.int8]]:
    """The steps (N,) and offsets (E, 2) of one kind of body, as parts of the arrays of all."""
    begins = kinds.measures["entries"]
    end = int(begins[row + 1]) if row + 1 < len(begins) else len(kinds.entries)
    return kinds.steps[row], kinds.offsets[int(begins[row]) : end]
