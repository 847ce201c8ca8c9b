"""Random targets that a chain of hinges can reach, for comparing methods of reaching."""

from __future__ import annotations

from typing import Final

import numpy as np

from esplanade.actors.locomotion.reaching._ccd_kernels import LIMB
from esplanade.actors.locomotion.reaching._hinge_kernels import Hinges
from esplanade.actors.locomotion.reaching.two_stage import effector
from esplanade.planning.compiled.arrays import Floats

SHARES: Final = {"limb is enough": 0.0, "half and half": 0.5, "all of the chain": 1.0}
"""Shares of the targets that ask for another pose of the trunk too, by names of the kinds."""


def random_targets(
    chain: Hinges, trunk_share: float, count: int, random: np.random.Generator
) -> tuple[Floats, Floats]:
    """Draw poses to start from, and targets that some pose within the limits reaches.

    Parameters
    ----------
    chain : what `two_stage.heel_chain` or `arm_chain` gives
    trunk_share : share of the targets that ask for another pose of the trunk, in [0, 1]
    count : number of targets
    random : the generator that all is drawn from

    Returns
    -------
    float64 (count, J), radians, poses
    float64 (count, 3), leg lengths, targets
    """
    starts, goals = random.uniform(chain.lows, chain.highs, (2, count, len(chain.lows)))
    limb_only = random.random(count) >= trunk_share
    goals[limb_only, :-LIMB] = starts[limb_only, :-LIMB]
    return starts, effector(chain, goals)
