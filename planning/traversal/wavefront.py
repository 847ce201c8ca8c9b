"""The potential of a goal cell: NF1 over the cells that a body can reach, across layers.

Huang & Li, sec. 4.1, after Barraquand & Latombe. A diagonal step counts the square root of two
straight ones, and the wave keeps off Forbidden cells, so that the steepest descent of the
potential is the shortest path as long as M does not forbid it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.traversal import _wavefront_kernels as kernels
from esplanade.planning.traversal.traversability import Traversability

UNREACHED = kernels.UNREACHED


def spread_wave(traversability: Traversability, goal: int) -> NDArray[np.int32]:
    """Distance from every cell to a goal cell, int32 (N,), in 1/70 of a cell.

    It is `UNREACHED` where no path leads to the goal. Cost O(cells reached).
    """
    distances = np.empty(len(traversability.steps), dtype=np.int32)
    kernels.spread(
        traversability.arrays.links, traversability.steps, traversability.classes, goal, distances
    )
    return distances


def spread_toward(
    traversability: Traversability, goal: int, start: int, longer: float = 1.0
) -> NDArray[np.int32]:
    """`spread_wave` for one start: exact there and along a shortest path from it to the goal.

    With `longer` > 1 it is exact along all paths from the start that are at most `longer` times as
    long as the shortest. Elsewhere it is exact, too much or `UNREACHED`. In the open few cells are
    looked at besides those of the path.
    """
    distances = np.empty(len(traversability.steps), dtype=np.int32)
    kernels.spread_toward(traversability, goal, start, longer, distances)
    return distances


def number_regions(traversability: Traversability) -> NDArray[np.int32]:
    """Numbers of the regions that steps connect, int32 (N,); -1 in Forbidden cells.

    A path leads from one cell to another, as far as M allows, if and only if both are in one
    region. Cost O(cells).
    """
    regions = np.empty(len(traversability.steps), dtype=np.int32)
    kernels.number_regions(
        traversability.arrays.links, traversability.steps, traversability.classes, regions
    )
    return regions


def metres(traversability: Traversability, distances: NDArray[np.int32]) -> NDArray[np.float32]:
    """Distances (N,) of `spread_wave` in metres, float32 (N,); inf where no path leads."""
    unit_m = np.float32(traversability.arrays.cell_m / kernels.STRAIGHT)
    in_metres = distances.astype(np.float32) * unit_m
    in_metres[distances == UNREACHED] = np.inf
    return in_metres
