"""Blends from one step's poses to the next one's by Bezier weights (Jing et al. 2015, eq. (14))."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import BPoly

Floats = NDArray[np.float64]


def bernstein(count: int, u: ArrayLike) -> Floats:
    """Weights (..., count) of `count` controls at shares u (...) in [0, 1]; they sum to 1."""
    if count < 1:
        raise ValueError(f"count must be at least 1, got {count}")
    share = np.asarray(u, dtype=np.float64)
    if not np.all((share >= 0.0) & (share <= 1.0)):
        raise ValueError("u must lie between 0 and 1")
    weights: Floats = BPoly(np.eye(count)[:, None], [0.0, 1.0])(share)
    return weights


def blend(controls: ArrayLike, u: ArrayLike) -> Floats:
    """Poses between the first and the last of a row of controls.

    Parameters
    ----------
    controls : float64 (K, N, J)
        Joint angles of N walkers at this phase of their cycle, for each of K step lengths.
    u : float64 (N,), in [0, 1]
        How far each has come in its step.

    Returns
    -------
    float64 (N, J)

    Notes
    -----
    Exactly the first control at u = 0 and the last one at 1, whatever lies between; so the ends of
    a step, and with them its length, are those that were asked for.
    """
    poses = np.asarray(controls, dtype=np.float64)
    mixed: Floats = np.einsum("nk,knj->nj", bernstein(len(poses), u), poses)
    return mixed


def blend_level(before: ArrayLike, after: ArrayLike, u: ArrayLike) -> Floats:
    """`blend` of before, before, after, after: it begins and ends with no change of its own.

    So where two steps meet, joints go on with the speed of their curves. The weights are 1 - S and
    S with S = 3 u^2 - 2 u^3.
    """
    return blend(np.stack((before, before, after, after)), u)
