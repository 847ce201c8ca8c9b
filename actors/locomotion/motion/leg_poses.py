"""The poses of legs in a step: feet on their footprints, hips within reach of them."""

from __future__ import annotations

from typing import Final

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.motion import _leg_pose_kernels as kernels
from esplanade.actors.locomotion.motion._leg_pose_kernels import LegPoses, Placement
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.planning.compiled.arrays import Floats

__all__ = ["REACH", "LegPoses", "leg_poses"]

REACH: Final = kernels.REACH
"""Legs are stretched to this share of their length at most, as knees that lock jerk."""


def leg_poses(steps: Steps, u: Floats, key: Floats, sizes: BodySizes) -> LegPoses:
    """Legs of N steps at shares of them.

    A standing foot is on its heel while its toe is up, else on its toe; in a flight it comes along
    in the air. Where a leg is too short,
    a foot that is on its toe raises its heel; then the hips come down until both feet are in reach.

    Parameters
    ----------
    steps : N steps
    u : float64 (N,), shares, in [0, 1]
    key : float64 (N, WIDTH)
        The result of `sample_keys` for these steps and shares.
    sizes : of the N bodies

    Returns
    -------
    LegPoses of N bodies, metres and radians, world axes
    """
    poses = kernels.new_leg_poses(len(u))
    given = Placement(
        steps.on_right,
        steps.standing,
        steps.landing,
        steps.lift,
        steps.flight,
        steps.keys,
        sizes.leg_m,
    )
    kernels.fill_leg_poses(given, u, key, REACH, poses)
    return poses
