"""What makes people different: sizes of the body and builds of walking, repeatably."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.actors.locomotion.stance import STATURE

LEG_M: Final = 0.88
SHORTEST_LEG_M: Final = 0.76
LONGEST_LEG_M: Final = 0.99


@dataclass(frozen=True, slots=True)
class Physique:
    """One body."""

    leg_m: float
    """From hip joint to the ground, the leg straight."""
    stature_m: float
    briskness: float
    """Steps of the same way are so many times as quick and short as most people's."""


def physique_of(seed: int, avatar_id: int) -> Physique:
    """The body of an avatar: always the same for a world's seed and the avatar's id."""
    leg, trunk, brisk = np.random.default_rng([seed, avatar_id]).normal(size=3).tolist()
    leg_m = min(max(LEG_M * (1.0 + 0.055 * leg), SHORTEST_LEG_M), LONGEST_LEG_M)
    trunk_m = leg_m * (STATURE - 1.0) * (1.0 + 0.03 * min(max(trunk, -2.0), 2.0))
    return Physique(leg_m, leg_m + trunk_m, 1.0 + 0.05 * min(max(brisk, -2.0), 2.0))
