"""STABLE_BFP: best-first search for a way that stays on edges only briefly.

Huang & Li, sec. 4.3, fig. 6. A body that is Unstable, or on an Up- or Down-stair, carries the
count of such cells in a row, and may go on while that is below M. It sets out with a count of 0,
wherever it stands.
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
    """A way from cell to cell, and how it was found."""

    cells: NDArray[np.int32]
    """(K,), from start to goal; none if there is no way."""
    counts: NDArray[np.int32]
    """(K,): cells on edges in a row, up to and with this one."""
    expansions: int


def stable_bfp(
    traversability: Traversability,
    left: NDArray[np.int32],
    start: int,
    goal: int,
    longer: float = math.inf,
) -> CellPath:
    """Search the way from one cell to another; `left` is the goal's potential.

    With `longer` only ways are looked at that are at most so many times as long as the shortest
    that there would be without M: as far as `spread_toward` knows the potential.

    Notes
    -----
    Our departure from fig. 6: states are ordered by way so far + potential, not by potential
    alone. Where M forbids nothing the two find the same; where it does, ours is the shortest way
    that M allows. The search is complete: it fails only if every state that can be reached was
    seen, or could do no more than another that was. Cost O(states log states), in most cases
    O(length of the way).
    """
    return CellPath(*kernels.search(traversability, left, start, goal, longer * float(left[start])))
