"""Rates at which samples are taken: each is a part of the rate of ticks."""

import math
from typing import Final

_SLACK: Final = 1e-6


def ticks_between(tick_rate: float, hz: float | None) -> int:
    """Ticks from one sample to the next; every tick without a rate.

    Raises
    ------
    ValueError
        Samples at this rate would lie between ticks.
    """
    if hz is None:
        return 1
    every = max(1, round(tick_rate / hz))
    if not math.isclose(every * hz, tick_rate, rel_tol=_SLACK):
        fitting = ", ".join(f"{tick_rate / n:.6g}" for n in (1, 2, 4, 5, 10, 20))
        raise ValueError(
            f"{hz:g} samples a second lie between the ticks, of which there are {tick_rate:g} a "
            f"second; there can be {fitting} and so on"
        )
    return every
