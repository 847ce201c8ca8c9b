"""The potential of a goal for a body on its feet: NF1 over what is reachable, across layers.

Huang & Li, sec. 4.1, after Barraquand & Latombe. A diagonal step counts the square root of two
straight ones, and the wave keeps off Forbidden cells, so that going down the potential is the
shortest way as long as M does not forbid it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.traversal import _wavefront_kernels as kernels
from esplanade.planning.traversal.traversability import Traversability

UNREACHED = kernels.UNREACHED


def spread_wave(traversability: Traversability, goal: int) -> NDArray[np.int32]:
    """The way left from every cell to a goal, int32 (N,), in 1/70 of a cell; `UNREACHED`: no way.

    Cost O(cells reached).
    """
    left = np.empty(len(traversability.steps), dtype=np.int32)
    kernels.spread(
        traversability.arrays.links, traversability.steps, traversability.classes, goal, left
    )
    return left


def spread_toward(
    traversability: Traversability, goal: int, start: int, longer: float = 1.0
) -> NDArray[np.int32]:
    """The same for one start: exact there and along a shortest way from it to the goal.

    With `longer` > 1 it is exact on all ways from the start that are at most so many times as
    long as the shortest. Elsewhere it is exact, too much or `UNREACHED`. In the open little else
    than the way itself is looked at.
    """
    left = np.empty(len(traversability.steps), dtype=np.int32)
    kernels.spread_toward(traversability, goal, start, longer, left)
    return left


def number_regions(traversability: Traversability) -> NDArray[np.int32]:
    """Numbers of the regions that steps hold together, int32 (N,); -1: Forbidden.

    A way leads from cell to cell, as far as M allows, if and only if both are of one region.
    Cost O(cells).
    """
    regions = np.empty(len(traversability.steps), dtype=np.int32)
    kernels.number_regions(
        traversability.arrays.links, traversability.steps, traversability.classes, regions
    )
    return regions


def metres(traversability: Traversability, left: NDArray[np.int32]) -> NDArray[np.float32]:
    """The same in metres, float32 (N,), inf where no way leads."""
    ways = left.astype(np.float32) * np.float32(traversability.arrays.cell_m / kernels.STRAIGHT)
    ways[left == UNREACHED] = np.inf
    return ways
