"""The potential of a goal for a body on its feet: NF1 over what is reachable, across layers.

Huang & Li, sec. 4.1, after Barraquand & Latombe. A diagonal step counts the square root of two
straight ones, and the wave keeps off Forbidden cells, so that going down the potential is the
shortest way as long as M does not forbid it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from planning import _wavefront_kernels as kernels
from planning._footing import Footing

UNREACHED = kernels.UNREACHED


def spread_wave(footing: Footing, goal: int, start: int = -1) -> NDArray[np.int32]:
    """The way left from every cell to a goal, int32 (N,), in 1/70 of a cell; `UNREACHED`: no way.

    With a `start`, the wave stops there, and cells further away are not told from those without
    any way. Cost O(cells reached).
    """
    left = np.empty(len(footing.steps), dtype=np.int32)
    kernels.spread(footing.arrays.links, footing.steps, footing.classes, goal, start, left)
    return left


def metres(footing: Footing, left: NDArray[np.int32]) -> NDArray[np.float32]:
    """The same in metres, float32 (N,), inf where no way leads."""
    ways = left.astype(np.float32) * np.float32(footing.arrays.cell_m / kernels.STRAIGHT)
    ways[left == UNREACHED] = np.inf
    return ways
