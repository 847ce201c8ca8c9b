"""STABLE_BFP: best-first search for a path that stays on edges only briefly.

Huang & Li, sec. 4.3, fig. 6. The search counts the cells in a row that are Unstable, Up-stair or
Down-stair; the count has to stay below M. It is 0 at the start, wherever the body stands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.routes import _stable_bfp_kernels as kernels
from esplanade.planning.traversal.traversability import Traversability


@dataclass(frozen=True)
class CellPath:
    """A path from cell to cell, and the work of the search."""

    cells: NDArray[np.int32]
    """(K,): cells from start to goal; K is 0 if there is no path."""
    counts: NDArray[np.int32]
    """(K,): cells on edges in a row, up to and with each cell."""
    expansions: int
    """Number of states that the search looked at."""


def stable_bfp(
    traversability: Traversability,
    distances: NDArray[np.int32],
    start: int,
    goal: int,
    longer: float = math.inf,
) -> CellPath:
    """Search a path from one cell to another.

    Parameters
    ----------
    traversability : Traversability
    distances : int32 (N,), in 1/70 of a cell
        The goal's potential, of `spread_wave` or `spread_toward`.
    start, goal : cells
    longer : float
        Only paths are considered that are at most this many times as long as the shortest path
        without M; `spread_toward` knows the potential for these.

    Notes
    -----
    Our departure from fig. 6: states are ordered by distance so far + potential, not by potential
    alone. Where M forbids nothing the two find the same path; otherwise ours is the shortest path
    that M allows. The search is complete: it fails only if every state that can be reached was
    looked at, or could do no more than another that was. Cost O(states log states), in most cases
    O(length of the path).
    """
    longest = longer * float(distances[start])
    return CellPath(*kernels.search(traversability, distances, start, goal, longest))
