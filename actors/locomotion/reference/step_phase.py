"""The phase of a step at a time, where steps of different durations follow one another.

The live world gives each step a number of ticks instead. The plots of docs/walking.md show this.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from esplanade.planning.compiled.arrays import Floats


def boundary_rates(durations_s: ArrayLike) -> Floats:
    """Rates at the boundaries of consecutive steps.

    Between two steps the rate is that of their mean duration, so that the pace never jumps. At
    both ends of the path it is that of the step itself.

    Parameters
    ----------
    durations_s : float64 (N,), seconds, above 0

    Returns
    -------
    float64 (N + 1,), steps a second

    Raises
    ------
    ValueError
        The durations are not a row of positive numbers.
    """
    taken = np.asarray(durations_s, dtype=np.float64)
    if taken.ndim != 1 or not len(taken) or not np.all(taken > 0.0):
        raise ValueError(f"durations_s must be a row of positive numbers, got {durations_s!r}")
    before = np.concatenate((taken[:1], taken))
    after = np.concatenate((taken, taken[-1:]))
    rates: Floats = 2.0 / (before + after)
    return rates


def step_phase(
    elapsed_share: ArrayLike, duration_s: ArrayLike, rate_before: ArrayLike, rate_after: ArrayLike
) -> Floats:
    """Phases of steps after a share of their durations.

    Parameters
    ----------
    elapsed_share : float64 (...), in [0, 1]
    duration_s : float64 (...), seconds
    rate_before, rate_after : float64 (...), steps a second
        Rates at the beginning and at the end, see `boundary_rates`.

    Returns
    -------
    float64 (...), in [0, 1]

    Notes
    -----
    The phase is a cubic of Hermite: where two steps meet, both have the same rate. For durations
    between `durations.SHORTEST_S` and `LONGEST_S` and the rates of `boundary_rates` the rate never
    falls below 0.62 of the step's own, so the phase always grows.
    """
    s = np.asarray(elapsed_share, dtype=np.float64)
    duration = np.asarray(duration_s, dtype=np.float64)
    begin = np.asarray(rate_before, dtype=np.float64) * duration
    end = np.asarray(rate_after, dtype=np.float64) * duration
    phase: Floats = s * (begin + s * (3.0 - 2.0 * begin - end + s * (begin + end - 2.0)))
    return phase
