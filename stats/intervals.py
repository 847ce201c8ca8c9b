"""Intervals of means, of medians and of shares."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import special

from esplanade.stats.resampling import Sample, means_of

Floats = NDArray[np.float64]

CONFIDENCE: Final = 0.95


class Interval(NamedTuple):
    """The bounds of an interval; both are nan where nothing is known."""

    low: float
    high: float


def interval_of(
    resamples: Floats, samples: Sequence[Sample], *, comparisons: int = 1
) -> list[Interval]:
    """The intervals of M figures by their resamples (R, M): expanded percentiles.

    Percentiles of few clusters would be too narrow; they are taken further out, as the t
    distribution is wider than the normal one. Of one cluster nothing is known. With several
    `comparisons` all intervals hold together in 95 % of cases (Bonferroni).

    Source: Hesterberg, What Teachers Should Know About the Bootstrap, 2015, section 3.3.
    """
    clusters = sum(sample.count for sample in samples)
    free = clusters - len(samples)
    if free < 1:
        return [Interval(math.nan, math.nan)] * resamples.shape[1]
    tail = 0.5 * (1.0 - CONFIDENCE) / comparisons
    wide = math.sqrt(clusters / free) * special.stdtrit(free, 1.0 - tail)
    beyond = 100.0 * float(special.ndtr(-wide))
    return [_between(column[np.isfinite(column)], beyond) for column in resamples.T]


def share_interval(samples: Sequence[Sample], column: int) -> Interval:
    """Wilson's interval of the share of episodes whose figure in a column is 1, and not 0.

    The number of episodes is divided by the design effect, at least 1: the variance of the share
    over clusters, to that over as many episodes by themselves. Where no episode has it, or each,
    nothing shows how they hang together, and each counts for itself. Of one cluster nothing is
    known.

    Source: Wilson 1927; Korn & Graubard, Survey Methodology 24, 1998, for clusters.
    """
    share = float(means_of(samples, even=False)[column])
    episodes = sum(len(sample.values) for sample in samples)
    if all(sample.count < 2 for sample in samples):
        return Interval(math.nan, math.nan)
    variance = 0.0
    for sample in samples:
        if sample.count < 2:
            continue
        off = np.bincount(sample.clusters, sample.values[:, column] - share)
        spread = float(np.sum((off - off.mean()) ** 2))
        variance += sample.count / (sample.count - 1) * spread / episodes**2
    alone = share * (1.0 - share) / episodes
    effective = episodes / max(1.0, variance / alone) if alone > 0.0 else float(episodes)
    z2 = float(special.ndtri(0.5 * (1.0 + CONFIDENCE))) ** 2
    middle = share + z2 / (2.0 * effective)
    half = math.sqrt(z2 * (share * (1.0 - share) + z2 / (4.0 * effective)) / effective)
    scale = 1.0 + z2 / effective
    return Interval(max(0.0, (middle - half) / scale), min(1.0, (middle + half) / scale))


def _between(known: Floats, beyond: float) -> Interval:
    """The percentiles of what is known that leave so many per cent beyond them on each side."""
    if not len(known):
        return Interval(math.nan, math.nan)
    low, high = np.percentile(known, [beyond, 100.0 - beyond])
    return Interval(float(low), float(high))
