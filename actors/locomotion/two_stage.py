"""Reaching with a limb and, where that is not enough, with the trunk (Chen et al. 2012, sec. 2).

A chain runs from its main root over the trunk to the sub-root, where the limb begins, and on to the
effector. Stage 1 bends the limb alone; stage 2 turns the trunk too. In place of the paper's cyclic
coordinate descent (CCD) in both stages, stage 1 is its law of cosines: that is where nearly all of
the work is saved. The paper's own and plain CCD are here to be compared with.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.actors.locomotion import _ccd_kernels as kernels
from esplanade.actors.locomotion import skeleton
from esplanade.actors.locomotion._ccd_kernels import Effort
from esplanade.actors.locomotion._hinge_kernels import Hinges, place_all

Floats = NDArray[np.float64]

TOLERANCE: Final = 1e-3
"""Leg lengths: about a millimetre."""
CCD_SWEEPS: Final = 100
TWO_STAGE_SWEEPS: Final = 300
"""Restarts included."""
LIMB_SWEEPS: Final = 10
"""Sweeps of stage 1 when both stages are CCD."""
RESTARTS: Final = 50

_X, _Y, _Z = np.eye(3)
_TRUNK_AXES: Final = (_Y, _X, _Z)
_LUMBAR_DEG: Final = ((-30.0, 30.0), (-20.0, 45.0), (-20.0, 20.0))
_CHEST_DEG: Final = ((-30.0, 30.0), (-20.0, 40.0), (-20.0, 20.0))
"""Turn, lean forward and bend aside of the upper part against the lower one."""
_LEFT_HIP_DEG: Final = ((-45.0, 45.0), (-30.0, 45.0), (-30.0, 120.0))
_LEFT_SHOULDER_DEG: Final = ((-70.0, 70.0), (-30.0, 90.0), (-50.0, 170.0))
"""Turn, lead aside (outwards positive) and flexion of the left limb."""
_KNEE_DEG: Final = (0.0, 150.0)
_ELBOW_DEG: Final = (0.0, 145.0)


class Reach(NamedTuple):
    """What became of N targets."""

    angles: Floats
    """(N, J), radians, within the limits"""
    left: Floats
    """(N,), leg lengths between effector and target"""
    reached: NDArray[np.bool_]
    """(N,)"""
    sweeps: NDArray[np.int64]
    """(N,): passes over the hinges"""
    turned: NDArray[np.int64]
    """(N,): how often a hinge's angle was set"""


def heel_chain(*, left: bool) -> Hinges:
    """From the neck (which holds still) by chest, lumbar joint and pelvis to a heel: 6 + 4 hinges.

    Points are leg lengths from the chest joint, in the axes left, up, forward of the chest.
    """
    side = 1.0 if left else -1.0
    hip = (side * skeleton.HIP_HALF_WIDTH, -skeleton.HIP_DEPTH, 0.0)
    # Seen from above, a lower part turns the other way.
    trunk = [(-high, -low) for low, high in (*_CHEST_DEG, *_LUMBAR_DEG)]
    return _chain(
        links=((0.0, -skeleton.CHEST_HEIGHT, 0.0), hip),
        bones=(skeleton.THIGH, skeleton.SHIN),
        bends=_X,
        limits_deg=[*trunk, *_mirrored(_LEFT_HIP_DEG, side), _KNEE_DEG],
    )


def arm_chain(*, left: bool) -> Hinges:
    """From the pelvis by lumbar and chest joint to a hand: 6 + 4 hinges.

    Points are leg lengths from the lumbar joint, in the axes left, up, forward of the pelvis.
    """
    side = 1.0 if left else -1.0
    shoulder = (
        side * skeleton.SHOULDER_HALF_WIDTH,
        skeleton.NECK_HEIGHT - skeleton.CHEST_HEIGHT,
        0.0,
    )
    return _chain(
        links=((0.0, skeleton.CHEST_HEIGHT, 0.0), shoulder),
        bones=(skeleton.UPPER_ARM, skeleton.FOREARM),
        bends=-_X,
        limits_deg=[
            *_LUMBAR_DEG,
            *_CHEST_DEG,
            *_mirrored(_LEFT_SHOULDER_DEG, side),
            _ELBOW_DEG,
        ],
    )


def reach(
    chain: Hinges,
    targets: ArrayLike,
    start: ArrayLike,
    random: np.random.Generator,
    *,
    tolerance: float = TOLERANCE,
    sweeps: int = TWO_STAGE_SWEEPS,
    restarts: int = RESTARTS,
) -> Reach:
    """Two stages: the limb in closed form, the trunk by CCD, from random poses where limits bar.

    Parameters
    ----------
    chain : of `heel_chain` or `arm_chain`
    targets : float64 (N, 3), leg lengths in the chain's root frame
    start : float64 (J,) or (N, J), radians, brought within the limits first
    random : draws the poses to start anew from, the same for all targets
    tolerance : leg lengths
    sweeps : int
        No more passes over the hinges than this for a target, restarts included.
    restarts : int
        No more new starts than this.

    Returns
    -------
    Reach

    Raises
    ------
    ValueError
        Wrong shape, something not finite, or a measure out of its range.
    """
    if restarts < 0:
        raise ValueError(f"restarts must not be negative, got {restarts}")
    starts = random.uniform(chain.lows, chain.highs, (restarts, len(chain.lows)))
    return _solve(chain, targets, start, Effort(tolerance, sweeps, 0), starts)


def reach_by_ccd(
    chain: Hinges,
    targets: ArrayLike,
    start: ArrayLike,
    *,
    tolerance: float = TOLERANCE,
    sweeps: int = CCD_SWEEPS,
    limb_sweeps: int = 0,
) -> Reach:
    """Plain CCD, for comparison; with `limb_sweeps` the paper's own two stages of CCD."""
    return _solve(chain, targets, start, Effort(tolerance, sweeps, limb_sweeps), None)


def effector(chain: Hinges, angles: ArrayLike) -> Floats:
    """Where the effector is at angles (N, J): float64 (N, 3), in the chain's root frame."""
    poses = np.ascontiguousarray(np.atleast_2d(np.asarray(angles, dtype=np.float64)))
    tips = np.empty((len(poses), 3))
    place_all(chain, poses, tips)
    return tips


def _solve(
    chain: Hinges, targets: ArrayLike, start: ArrayLike, effort: Effort, starts: Floats | None
) -> Reach:
    goals = np.ascontiguousarray(np.asarray(targets, dtype=np.float64))
    if goals.ndim != 2 or goals.shape[1] != 3 or not np.all(np.isfinite(goals)):
        raise ValueError(f"targets must be finite and (N, 3), got shape {goals.shape}")
    count = len(chain.lows)
    given = np.asarray(start, dtype=np.float64)
    if given.shape not in {(count,), (len(goals), count)} or not np.all(np.isfinite(given)):
        raise ValueError(f"start must be finite and ({count},) or (N, {count}), got {given.shape}")
    if not effort.tolerance > 0.0 or effort.sweeps < 1 or effort.limb_sweeps < 0:
        raise ValueError(f"tolerance and sweeps must be positive, got {effort}")
    angles = np.empty((len(goals), count))
    angles[:] = np.clip(given, chain.lows, chain.highs)
    left = np.empty(len(goals))
    work = np.empty((len(goals), 2), dtype=np.int64)
    none = np.empty((0, count))
    kernels.solve_all(
        chain,
        angles,
        goals,
        effort,
        none if starts is None else starts,
        starts is not None,
        left,
        work,
    )
    return Reach(angles, left, left <= effort.tolerance, work[:, 0], work[:, 1])


def _mirrored(
    left_deg: tuple[tuple[float, float], ...], side: float
) -> tuple[tuple[float, float], ...]:
    """Limits of a left limb's turn, lead aside and flexion, or those of the right one."""
    turn, aside, flexion = left_deg
    if side > 0.0:
        return left_deg
    return (-turn[1], -turn[0]), (-aside[1], -aside[0]), flexion


def _chain(
    links: tuple[tuple[float, float, float], tuple[float, float, float]],
    bones: tuple[float, float],
    bends: Floats,
    limits_deg: list[tuple[float, float]],
) -> Hinges:
    """Two joints of the trunk with three hinges each, a link after either, and a limb."""
    axes = np.array((*_TRUNK_AXES, *_TRUNK_AXES, _Y, _Z, -_X, bends))
    offsets = np.zeros((len(axes), 3))
    offsets[2], offsets[5] = links
    offsets[8, 1], offsets[9, 1] = -bones[0], -bones[1]
    lows, highs = np.radians(np.array(limits_deg).T)
    return Hinges(axes, offsets, np.ascontiguousarray(lows), np.ascontiguousarray(highs))
