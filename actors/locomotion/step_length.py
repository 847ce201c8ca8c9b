"""How long a step at a relative velocity is, and which velocity gives a step of a length.

All lengths are shares of the leg length. A step ends in double support: the front leg at phase 0,
the rear one at phase .5 of its curves.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from esplanade.actors.locomotion.curves import joint_angles
from esplanade.actors.locomotion.skeleton import FOOT, Floats, foot_pitch, leg_points

RV_LONGEST = 0.5
"""Steps are lengthened by velocities up to here; beyond, legs only move faster (stretch B)."""

_TABLE_POINTS = 513


class DoubleSupport(NamedTuple):
    """Both legs at the end of a step, from the hip joint; forward and up, in leg lengths."""

    front_forward: Floats
    front_up: Floats
    front_pitch: Floats
    rear_forward: Floats
    rear_up: Floats
    rear_toe_forward: Floats

    @property
    def heel_raised(self) -> Floats:
        """How much higher the rear heel is than the front one; never negative."""
        return np.maximum(self.rear_up - self.front_up, 0.0)


def double_support(rv: Floats, *, faded: bool = True) -> DoubleSupport:
    """The pose in which a step at this relative velocity ends, by forward kinematics."""
    front = joint_angles(rv, np.zeros_like(rv), faded=faded)
    rear = joint_angles(rv, np.full_like(rv, 0.5), faded=faded)
    _, front_heel, _ = leg_points(front)
    _, rear_heel, rear_toe = leg_points(rear)
    return DoubleSupport(
        front_heel[..., 0],
        front_heel[..., 1],
        foot_pitch(front),
        rear_heel[..., 0],
        rear_heel[..., 1],
        rear_toe[..., 0],
    )


def sl_paper(rv: ArrayLike) -> Floats:
    """From heel to heel, Jing et al., eq. (10), with the published curves."""
    pose = double_support(_velocities(rv), faded=False)
    return pose.front_forward - pose.rear_forward


def sl_noslide(rv: ArrayLike) -> Floats:
    """What a step covers whose foot rolls from heel to toe without sliding; published curves."""
    pose = double_support(_velocities(rv), faded=False)
    return pose.front_forward - pose.rear_toe_forward + FOOT


def sl_planted(rv: ArrayLike) -> Floats:
    """From footprint to footprint when the rear foot has raised its heel about its toe."""
    return planted_length(double_support(_velocities(rv)))


def planted_length(pose: DoubleSupport) -> Floats:
    """As sl_planted, of poses that are at hand."""
    drawn_in = FOOT - np.sqrt(FOOT**2 - pose.heel_raised**2)
    length: Floats = pose.front_forward - pose.rear_forward + drawn_in
    return length


def longest_step() -> float:
    """The longest planted step, in leg lengths."""
    return float(_table().lengths[-1])


def final_poses() -> tuple[Floats, Floats]:
    """Table of planted steps: lengths (M,), and (M, 7): velocity, fields of DoubleSupport."""
    table = _table()
    return table.lengths, table.rows


def solve_relative_velocity(sl: ArrayLike) -> Floats:
    """Relative velocity whose planted step has a given length.

    Parameters
    ----------
    sl : float64 (N,), leg lengths, in [0, longest_step()]

    Returns
    -------
    float64 (N,), in [0, .5]

    Raises
    ------
    ValueError
        A length that no step has.

    Notes
    -----
    In place of the bisection of Jing et al., algorithm 1: a table of 513 points, then two steps
    of Newton's method with slopes from the table. Lengths grow strictly, so there is one answer.
    """
    sl = np.asarray(sl, dtype=np.float64)
    table = _table()
    if not np.all((sl >= 0.0) & (sl <= table.lengths[-1])):
        raise ValueError(f"step lengths must lie in [0, {table.lengths[-1]:.4f}] leg lengths")
    velocities = table.rows[:, 0]
    rv: Floats = np.interp(sl, table.lengths, velocities)
    for _ in range(2):
        slope = np.interp(rv, velocities, table.slopes)
        rv = np.clip(rv - (sl_planted(rv) - sl) / slope, 0.0, RV_LONGEST)
    return rv


class _Table(NamedTuple):
    lengths: Floats
    rows: Floats
    """(_TABLE_POINTS, 7): relative velocity and the fields of DoubleSupport."""
    slopes: Floats
    """Of lengths by relative velocity."""


@cache
def _table() -> _Table:
    velocities = np.linspace(0.0, RV_LONGEST, _TABLE_POINTS)
    pose = double_support(velocities)
    nudge = 1e-6
    low = np.maximum(velocities - nudge, 0.0)
    high = np.minimum(velocities + nudge, RV_LONGEST)
    slopes = (sl_planted(high) - sl_planted(low)) / (high - low)
    return _Table(planted_length(pose), np.column_stack([velocities, *pose]), slopes)


def _velocities(rv: ArrayLike) -> Floats:
    rv = np.asarray(rv, dtype=np.float64)
    if not np.all((rv >= 0.0) & (rv <= RV_LONGEST)):
        raise ValueError(f"step lengths depend on relative velocities in [0, {RV_LONGEST}] only")
    return rv
