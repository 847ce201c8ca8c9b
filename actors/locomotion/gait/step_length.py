"""The length of a planted step at a relative velocity, and the velocity that gives a length.

All lengths are shares of the leg length. A step ends in double support, with the front leg at
phase 0 and the rear leg at phase .5 of its curves.
"""

from functools import cache
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.body.skeleton import FOOT, foot_pitch, leg_points
from esplanade.actors.locomotion.gait.curves import joint_angles
from esplanade.planning.compiled.arrays import Floats

RV_LONGEST: Final = 0.5
"""Relative velocities up to this one lengthen the step; beyond it legs only move faster."""

_TABLE_POINTS: Final = 513


class StraightDoubleSupport(NamedTuple):
    """Both legs at the end of a straight step, seen from the hip joint; leg lengths and radians."""

    front_forward: Floats
    front_up: Floats
    front_pitch: Floats
    rear_forward: Floats
    rear_up: Floats
    rear_toe_forward: Floats

    @property
    def heel_raised(self) -> Floats:
        """Height of the rear heel above the front one; never negative."""
        return np.maximum(self.rear_up - self.front_up, 0.0)


class PoseTable(NamedTuple):
    """Poses of straight planted steps in double support, ordered by the length of the step.

    Kernels read it; after the length its fields are the relative velocity and those of
    `StraightDoubleSupport`, all float64 (M,).
    """

    length: Floats
    rv: Floats
    front_forward: Floats
    front_up: Floats
    front_pitch: Floats
    rear_forward: Floats
    rear_up: Floats
    rear_toe_forward: Floats


def straight_double_support(rv: Floats, *, faded: bool = True) -> StraightDoubleSupport:
    """The pose in which a step at a relative velocity ends, by forward kinematics.

    With `faded=False` the curves are those published, see `curves.leg_keys`.
    """
    front = joint_angles(rv, np.zeros_like(rv), faded=faded)
    rear = joint_angles(rv, np.full_like(rv, 0.5), faded=faded)
    _, front_heel, _ = leg_points(front)
    _, rear_heel, rear_toe = leg_points(rear)
    return StraightDoubleSupport(
        front_heel[..., 0],
        front_heel[..., 1],
        foot_pitch(front),
        rear_heel[..., 0],
        rear_heel[..., 1],
        rear_toe[..., 0],
    )


def sl_planted(rv: ArrayLike) -> Floats:
    """Length from footprint to footprint, the rear foot having raised its heel about its toe.

    Parameters
    ----------
    rv : float64 (...), leg lengths a second, in [0, RV_LONGEST]

    Returns
    -------
    float64 (...), leg lengths

    Raises
    ------
    ValueError
        A relative velocity is out of its range.
    """
    return planted_length(straight_double_support(checked_step_velocities(rv)))


def planted_length(pose: StraightDoubleSupport) -> Floats:
    """Return the same as `sl_planted`, from poses that are at hand."""
    drawn_in = FOOT - np.sqrt(FOOT**2 - pose.heel_raised**2)
    length: Floats = pose.front_forward - pose.rear_forward + drawn_in
    return length


def longest_step() -> float:
    """The longest planted step, leg lengths."""
    return float(pose_table().length[-1])


def solve_relative_velocity(sl: ArrayLike) -> Floats:
    """Relative velocities whose planted steps have given lengths.

    Parameters
    ----------
    sl : float64 (N,), leg lengths, in [0, longest_step()]

    Returns
    -------
    float64 (N,), leg lengths a second, in [0, .5]

    Raises
    ------
    ValueError
        No step has such a length.

    Notes
    -----
    In place of the bisection of Jing et al. 2015, algorithm 1, a table of 513 points is followed
    by two steps of Newton's method with slopes from the table. Lengths grow strictly with the
    velocity, so there is exactly one answer. It is exact to 4e-16.
    """
    sl = np.asarray(sl, dtype=np.float64)
    table = pose_table()
    if not np.all((sl >= 0.0) & (sl <= table.length[-1])):
        raise ValueError(f"step lengths must lie in [0, {table.length[-1]:.4f}] leg lengths")
    slopes = _slopes()
    rv: Floats = np.interp(sl, table.length, table.rv)
    for _ in range(2):
        slope = np.interp(rv, table.rv, slopes)
        rv = np.clip(rv - (sl_planted(rv) - sl) / slope, 0.0, RV_LONGEST)
    return rv


@cache
def pose_table() -> PoseTable:
    """The table of straight planted steps, M = 513."""
    velocities = np.linspace(0.0, RV_LONGEST, _TABLE_POINTS)
    pose = straight_double_support(velocities)
    columns = (planted_length(pose), velocities, *pose)
    return PoseTable(*(np.ascontiguousarray(column) for column in columns))


@cache
def _slopes() -> Floats:
    """Derivatives of the planted length by the relative velocity at the points of the table."""
    velocities = pose_table().rv
    nudge = 1e-6
    low = np.maximum(velocities - nudge, 0.0)
    high = np.minimum(velocities + nudge, RV_LONGEST)
    slopes: Floats = (sl_planted(high) - sl_planted(low)) / (high - low)
    return slopes


def checked_step_velocities(rv: ArrayLike) -> Floats:
    """Relative velocities as an array.

    Raises
    ------
    ValueError
        One of them is outside [0, RV_LONGEST].
    """
    rv = np.asarray(rv, dtype=np.float64)
    if not np.all((rv >= 0.0) & (rv <= RV_LONGEST)):
        raise ValueError(
            f"only relative velocities from 0 to {RV_LONGEST} decide how long a step is"
        )
    return rv
