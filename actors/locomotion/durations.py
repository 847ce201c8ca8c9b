"""How long a step takes, and how far it has come at a time."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

SHORTEST_S: Final = 0.45
LONGEST_S: Final = 1.0
_LENGTH_SECONDS: Final = 1.346**2 / 4.0
"""Step length x duration of a free walk: Dc = RL / RV with RL = 1.346 sqrt(RV), and a step is half
of a cycle's length and time (Jing et al. 2015, eqs. (1), (2)). Leg lengths x seconds."""


def step_duration_s(step_length: ArrayLike) -> Floats:
    """Seconds that steps (...) of so many leg lengths take: longer steps are quicker ones.

    People neither trip along faster than SHORTEST_S nor linger over a step beyond LONGEST_S.
    """
    length = np.asarray(step_length, dtype=np.float64)
    if not np.all(length >= 0.0):
        raise ValueError("step_length must not be negative or nan")
    free_s: Floats = _LENGTH_SECONDS / np.maximum(length, _LENGTH_SECONDS / LONGEST_S)
    return np.clip(free_s, SHORTEST_S, LONGEST_S)


def boundary_rates(durations_s: ArrayLike) -> Floats:
    """Steps a second at the ends of consecutive steps of durations (N,): float64 (N + 1,).

    Between two steps the rate of the mean of both, so that pace never jumps; at the two ends of
    the way that of the step itself.
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
    """Phase of steps in [0, 1] after a share of their duration.

    Parameters
    ----------
    elapsed_share : (...), in [0, 1]
    duration_s : (...)
    rate_before, rate_after : (...), steps a second at the beginning and the end

    Returns
    -------
    float64 (...)

    Notes
    -----
    A cubic of Hermite: where two steps meet, the rate is that of both. For durations between
    SHORTEST_S and LONGEST_S and the rates of `boundary_rates` it never falls below 0.62 of the
    step's own rate, so the phase always grows.
    """
    s = np.asarray(elapsed_share, dtype=np.float64)
    duration = np.asarray(duration_s, dtype=np.float64)
    begin = np.asarray(rate_before, dtype=np.float64) * duration
    end = np.asarray(rate_after, dtype=np.float64) * duration
    phase: Floats = s * (begin + s * (3.0 - 2.0 * begin - end + s * (begin + end - 2.0)))
    return phase
