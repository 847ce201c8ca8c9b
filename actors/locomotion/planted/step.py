"""The planted step: feet stay where they are put, and a step ends as the next one begins.

Jing et al. 2015 move the body by whichever foot bears it, which leaves legs of unequal height and
a trailing toe that slides. Here feet and hips are given paths first, and legs are bent to fit:
straight on, round bends, sideways, backward, on the spot, and over stairs.
"""

from functools import cache

import numpy as np

from esplanade.actors.locomotion.gait.step_length import RV_LONGEST, pose_table, sl_planted
from esplanade.actors.locomotion.planted._feet_kernels import fill_clearances
from esplanade.actors.locomotion.planted._step_kernels import GaitTables, fill_targets
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.targets import Targets, empty_targets
from esplanade.planning.compiled.arrays import Floats

_TABLE_SIDE = 26


def step_targets(footprints: StepFootprints, u: Floats) -> Targets:
    """Targets of N steps at shares of them.

    Parameters
    ----------
    footprints : N steps
    u : float64 (K,) for all steps alike, or (N, K); in [0, 1]

    Returns
    -------
    Targets of N steps at K shares

    Raises
    ------
    ValueError
        A value is not a finite number, or a leg has no length.

    Notes
    -----
    The pose at u = 0 follows from the footprints `lifted` and `standing` alone, that at u = 1 from
    `standing` and `landing` by the same rule. So steps that follow one another join, in place and
    in speed. docs/walking.md says what the step was measured to do.
    """
    count = len(footprints.on_right)
    shares = np.ascontiguousarray(np.broadcast_to(u, (count, np.shape(u)[-1])), dtype=np.float64)
    footprints = StepFootprints(
        np.ascontiguousarray(footprints.on_right, dtype=np.bool_),
        *(np.ascontiguousarray(part, dtype=np.float64) for part in footprints[1:]),
    )
    if not all(np.all(np.isfinite(part)) for part in (*footprints, shares)):
        raise ValueError("a footprint, leg or share of a step is not a finite number")
    if not np.all(footprints.leg_m > 0.0):
        raise ValueError("legs must be longer than 0 m")
    targets = empty_targets(count, shares.shape[1])
    tables = gait_tables()
    fill_targets(footprints, shares, tables.poses, tables.clearances, targets)
    return targets


@cache
def gait_tables() -> GaitTables:
    """The tables of all planted steps."""
    return GaitTables(pose_table(), _clearances())


def _clearances() -> Floats:
    """Rise of feet beyond the curves, (26, 26), by the relative velocities at both ends."""
    table = np.empty((_TABLE_SIDE, _TABLE_SIDE))
    lengths = sl_planted(np.linspace(0.0, RV_LONGEST, _TABLE_SIDE))
    fill_clearances(lengths, pose_table(), table)
    return table
