"""Power: the number of episodes that a difference needs to be seen."""

import math
from typing import Final

from scipy import special

from esplanade.stats.comparisons import Difference
from esplanade.stats.intervals import CONFIDENCE

POWER: Final = 0.8
"""A difference is to be seen in this share of studies."""


def needed(found: Difference, difference: float) -> float:
    """The number of paired episodes with which a true difference is seen in 80 % of studies.

    It is scaled from the deviation that was found: twice the episodes, in as many more clusters,
    halve the variance. It is nan where none was found.

    Source: the normal approximation, (z of 0.975 + z of 0.8)² variance / difference².
    """
    if not found.deviation > 0.0:
        return math.nan
    z = float(special.ndtri(0.5 * (1.0 + CONFIDENCE)) + special.ndtri(POWER))
    return math.ceil(found.episodes * (z * found.deviation / difference) ** 2)
