"""The step that avatars take: feet stay where they are put, and a step ends as the next begins.

Jing et al. move the body by whichever foot bears it, which leaves legs of unequal height and a
trailing toe that slides. Here feet and hips are given paths first and legs are bent to fit:
straight on, round bends, sideways, backward, on the spot, and over stairs.
"""

from functools import cache

import numpy as np

from esplanade.actors.locomotion._feet_kernels import fill_clearances
from esplanade.actors.locomotion._planted_kernels import fill_targets
from esplanade.actors.locomotion._turning_kernels import Poses
from esplanade.actors.locomotion.footfalls import Footfalls, Targets, room_for
from esplanade.actors.locomotion.skeleton import Floats
from esplanade.actors.locomotion.step_length import RV_LONGEST, final_poses, sl_planted

__all__ = ["Footfalls", "Targets", "step_targets"]

_TABLE_SIDE = 26


def step_targets(falls: Footfalls, u: Floats) -> Targets:
    """What N steps aim at, at shares u in [0, 1]: float64 (K,) for all, or (N, K).

    The pose at u = 0 follows from footprints lifted and standing alone, that at u = 1 from
    standing and landing by the same rule. So steps that follow one another join, speeds too.

    Raises
    ------
    ValueError
        Something that is not a finite number, or a leg without length.
    """
    count = len(falls.right)
    shares = np.ascontiguousarray(np.broadcast_to(u, (count, np.shape(u)[-1])), dtype=np.float64)
    falls = Footfalls(
        np.ascontiguousarray(falls.right, dtype=np.bool_),
        *(np.ascontiguousarray(part, dtype=np.float64) for part in falls[1:]),
    )
    if not all(np.all(np.isfinite(part)) for part in (*falls, shares)):
        raise ValueError("a footprint, leg or share of a step is not a finite number")
    if not np.all(falls.leg_m > 0.0):
        raise ValueError("legs must be longer than 0 m")
    targets = room_for(count, shares.shape[1])
    fill_targets(falls, shares, _poses(), _clearances(), targets)
    return targets


@cache
def _poses() -> Poses:
    return Poses(*final_poses())


@cache
def _clearances() -> Floats:
    """How much feet are lifted beyond the curves, by relative velocities at both ends."""
    table = np.empty((_TABLE_SIDE, _TABLE_SIDE))
    lengths = sl_planted(np.linspace(0.0, RV_LONGEST, _TABLE_SIDE))
    fill_clearances(lengths, _poses(), table)
    return table
