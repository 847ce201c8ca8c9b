"""The duration of a step of a free walk."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from esplanade.planning.compiled.arrays import Floats

SHORTEST_S: Final = 0.45
LONGEST_S: Final = 1.0
_LENGTH_SECONDS: Final = 1.346**2 / 4.0
"""Length times duration of a step of a free walk, leg lengths times seconds.

Dc = RL / RV with RL = 1.346 sqrt(RV), and a step is half of a cycle's length and time (Jing et al.
2015, eqs. (1) and (2)).
"""


def step_duration_s(step_length: ArrayLike) -> Floats:
    """Durations of steps: longer steps are quicker ones.

    Parameters
    ----------
    step_length : float64 (...), leg lengths
        Not negative.

    Returns
    -------
    float64 (...), seconds, in [SHORTEST_S, LONGEST_S]
        People neither trip along faster than the one nor linger over a step beyond the other.

    Raises
    ------
    ValueError
        A length is negative or not a number.
    """
    length = np.asarray(step_length, dtype=np.float64)
    if not np.all(length >= 0.0):
        raise ValueError("step_length must not be negative or nan")
    free_s: Floats = _LENGTH_SECONDS / np.maximum(length, _LENGTH_SECONDS / LONGEST_S)
    return np.clip(free_s, SHORTEST_S, LONGEST_S)
