"""Random targets that a chain of hinges can reach, to compare ways of reaching them."""

from __future__ import annotations

from typing import Final

import numpy as np

from esplanade.actors.locomotion.reaching._ccd_kernels import LIMB
from esplanade.actors.locomotion.reaching._hinge_kernels import Hinges
from esplanade.actors.locomotion.reaching.two_stage import effector
from esplanade.planning.compiled.arrays import Floats

SHARES: Final = {"limb is enough": 0.0, "half and half": 0.5, "all of the chain": 1.0}
"""How many of the targets ask for another pose of the trunk too."""


def random_targets(
    chain: Hinges, trunk_share: float, count: int, random: np.random.Generator
) -> tuple[Floats, Floats]:
    """Poses to start from (count, J), and targets (count, 3) that some pose within limits has."""
    starts, goals = random.uniform(chain.lows, chain.highs, (2, count, len(chain.lows)))
    limb_only = random.random(count) >= trunk_share
    goals[limb_only, :-LIMB] = starts[limb_only, :-LIMB]
    return starts, effector(chain, goals)
