"""The traits in which one avatar differs from the others: the sizes of its body and its cadence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.actors.locomotion.body.sizes import STATURE

LEG_M: Final = 0.88
"""Mean length of a leg."""
SHORTEST_LEG_M: Final = 0.76
LONGEST_LEG_M: Final = 0.99


@dataclass(frozen=True, slots=True)
class WalkerTraits:
    """The traits of one avatar that its walk depends on."""

    leg_m: float
    """Height of the hip joint above the ground, the leg straight."""
    stature_m: float
    """Height of the top of the head above the ground."""
    cadence_factor: float
    """Steps a second of this avatar, at any speed, as a multiple of those of most people."""


def traits_of(seed: int, avatar_id: int) -> WalkerTraits:
    """Draw the traits of an avatar: always the same for a world's seed and the avatar's id."""
    leg, trunk, cadence = np.random.default_rng([seed, avatar_id]).normal(size=3).tolist()
    leg_m = min(max(LEG_M * (1.0 + 0.055 * leg), SHORTEST_LEG_M), LONGEST_LEG_M)
    trunk_m = leg_m * (STATURE - 1.0) * (1.0 + 0.03 * min(max(trunk, -2.0), 2.0))
    return WalkerTraits(leg_m, leg_m + trunk_m, 1.0 + 0.05 * min(max(cadence, -2.0), 2.0))
