"""Reaching with a limb and, where that is not enough, with the trunk (Chen et al. 2012, sec. 2).

A chain runs from its main root over the trunk to the sub-root, where the limb begins, and on to the
effector. Stage 1 bends the limb alone; stage 2 turns the trunk too. The paper does both stages by
cyclic coordinate descent (CCD). Here stage 1 is its law of cosines, which saves nearly all of the
work. The paper's own way and plain CCD are here for comparison.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.body import skeleton
from esplanade.actors.locomotion.body.skeleton import REACHING_ARMS
from esplanade.actors.locomotion.reaching import _ccd_kernels as kernels
from esplanade.actors.locomotion.reaching._ccd_kernels import Effort
from esplanade.actors.locomotion.reaching._hinge_kernels import Hinges, fill_effectors
from esplanade.planning.compiled.arrays import Bools, Floats, Ints

TOLERANCE: Final = 1e-3
"""Distance from the target that counts as reached, leg lengths: about a millimetre."""
CCD_SWEEPS: Final = 100
"""Largest number of sweeps of plain CCD."""
TWO_STAGE_SWEEPS: Final = 300
"""Largest number of sweeps of both stages, restarts included."""
LIMB_SWEEPS: Final = 10
"""Number of sweeps of stage 1 when both stages are CCD."""
RESTARTS: Final = 50
"""Largest number of random poses from which a target is tried anew."""

_X, _Y, _Z = np.eye(3)
_TRUNK_AXES: Final = (_Y, _X, _Z)
_LUMBAR_DEG: Final = ((-30.0, 30.0), (-20.0, 45.0), (-20.0, 20.0))
_CHEST_DEG: Final = ((-30.0, 30.0), (-20.0, 40.0), (-20.0, 20.0))
"""Limits of turn, lean forward and bend aside of the upper part against the lower one."""
_LEFT_HIP_DEG: Final = ((-45.0, 45.0), (-30.0, 45.0), (-30.0, 120.0))
_LEFT_SHOULDER_DEG: Final = ((-70.0, 70.0), (-30.0, 90.0), (-50.0, 170.0))
"""Limits of turn, abduction (outwards positive) and flexion of the left limb."""
_KNEE_DEG: Final = (0.0, 150.0)
_ELBOW_DEG: Final = (0.0, 145.0)


class Reach(NamedTuple):
    """The poses found for N targets, and the work they took."""

    angles: Floats
    """(N, J), radians, within the limits."""
    left: Floats
    """(N,), leg lengths: distances between effector and target."""
    reached: Bools
    """(N,): whether that is within the tolerance."""
    sweeps: Ints
    """(N,): how often the hinges were swept over."""
    turned: Ints
    """(N,): how often an angle of a hinge was set."""


def heel_chain(*, left: bool) -> Hinges:
    """The chain from the neck, which holds still, by chest, spine and pelvis to a heel.

    It has 6 hinges of the trunk and 4 of the leg.

    Points are leg lengths from the chest joint, in the axes left, up, forward of the chest.
    """
    side = 1.0 if left else -1.0
    hip = (side * skeleton.HIP_HALF_WIDTH, -skeleton.HIP_DEPTH, 0.0)
    # The chain runs downwards: a lower part turns against the upper one the other way.
    trunk = [(-high, -low) for low, high in (*_CHEST_DEG, *_LUMBAR_DEG)]
    return _chain(
        links=((0.0, -skeleton.CHEST_HEIGHT, 0.0), hip),
        bones=(skeleton.THIGH, skeleton.SHIN),
        bends=_X,
        limits_deg=[*trunk, *_mirrored(_LEFT_HIP_DEG, side), _KNEE_DEG],
    )


def arm_chain(*, left: bool) -> Hinges:
    """The chain from the pelvis by lumbar joint and chest joint to a hand.

    It has 6 hinges of the trunk and 4 of the arm.

    Points are leg lengths from the lumbar joint, in the axes left, up, forward of the pelvis.
    """
    side = 1.0 if left else -1.0
    shoulder = (
        side * REACHING_ARMS.shoulder_aside,
        REACHING_ARMS.shoulder_height - skeleton.CHEST_HEIGHT,
        0.0,
    )
    return _chain(
        links=((0.0, skeleton.CHEST_HEIGHT, 0.0), shoulder),
        bones=(REACHING_ARMS.upper_arm, REACHING_ARMS.forearm),
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
    """Reach for targets in two stages: the limb in closed form, the trunk by CCD.

    Where limits are in the way it starts anew from random poses.

    Parameters
    ----------
    chain : the result of `heel_chain` or `arm_chain`
    targets : float64 (N, 3), leg lengths, in the frame of the chain's root
    start : float64 (J,) or (N, J), radians
        Angles to begin with; they are brought within the limits first.
    random : the generator that draws the poses to start anew from, the same for all targets
    tolerance : leg lengths, above 0
    sweeps : int
        Largest number of sweeps over the hinges for a target, restarts included.
    restarts : int
        Largest number of new starts for a target.

    Returns
    -------
    Reach of N targets

    Raises
    ------
    ValueError
        An array has a wrong shape or a value that is not finite, or a measure is out of its range.
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
    """Reach by plain CCD, for comparison; with `limb_sweeps` by the paper's own two stages of CCD.

    The other parameters, the result and the errors are those of `reach`.
    """
    return _solve(chain, targets, start, Effort(tolerance, sweeps, limb_sweeps), None)


def effector(chain: Hinges, angles: ArrayLike) -> Floats:
    """Places of the effector, by forward kinematics.

    Parameters
    ----------
    chain : the result of `heel_chain` or `arm_chain`
    angles : float64 (J,) or (N, J), radians

    Returns
    -------
    float64 (N, 3), leg lengths, in the frame of the chain's root
    """
    poses = np.ascontiguousarray(np.atleast_2d(np.asarray(angles, dtype=np.float64)))
    tips = np.empty((len(poses), 3))
    fill_effectors(chain, poses, tips)
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
    sweeps, turned = np.empty((2, len(goals)), dtype=np.int64)
    none = np.empty((0, count))
    kernels.solve_all(
        chain,
        angles,
        goals,
        effort,
        none if starts is None else starts,
        starts is not None,
        left,
        sweeps,
        turned,
    )
    return Reach(angles, left, left <= effort.tolerance, sweeps, turned)


def _mirrored(
    left_deg: tuple[tuple[float, float], ...], side: float
) -> tuple[tuple[float, float], ...]:
    """Limits of turn, abduction and flexion of a limb, from those of the left one."""
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
    """A chain of two joints of the trunk with three hinges and a link each, and of a limb."""
    axes = np.array((*_TRUNK_AXES, *_TRUNK_AXES, _Y, _Z, -_X, bends))
    offsets = np.zeros((len(axes), 3))
    offsets[2], offsets[5] = links
    offsets[8, 1], offsets[9, 1] = -bones[0], -bones[1]
    lows, highs = np.radians(np.array(limits_deg).T)
    return Hinges(axes, offsets, np.ascontiguousarray(lows), np.ascontiguousarray(highs))
