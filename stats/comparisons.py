"""Comparisons on the same episodes: paired differences, corrected for their number."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from esplanade.stats.intervals import Interval, interval_of
from esplanade.stats.resampling import Sample, means_of, resampled_means

Name = TypeVar("Name")


@dataclass(frozen=True)
class Difference:
    """The mean paired difference of one figure, and what is known of it."""

    mean: float
    interval: Interval
    """It holds together with those of all other comparisons that were asked for at once."""
    deviation: float
    """The standard deviation of the mean over resamples."""
    episodes: int
    """The episodes in which both have the figure."""

    @property
    def differs(self) -> bool:
        """Whether the interval excludes 0."""
        return self.interval.low > 0.0 or self.interval.high < 0.0


def compare(
    pairs: Mapping[Name, tuple[Sequence[Sample], Sequence[Sample]]], seed: int, *, even: bool
) -> dict[Name, list[Difference]]:
    """The differences of the first from the second of each pair, figure by figure.

    The samples of a pair have the same episodes in the same order, with nan where one lacks a
    figure. All differences count as compared at once. `even` is that of `means_of`.

    Raises
    ------
    ValueError
        The episodes are not the same.
    """
    found = {}
    for name, (ours, theirs) in pairs.items():
        paired = [_less(sample, base) for sample, base in zip(ours, theirs, strict=True)]
        resamples = resampled_means(paired, seed, even=even)
        known = sum(np.isfinite(sample.values).sum(axis=0) for sample in paired)
        compared = len(pairs) * resamples.shape[1]
        found[name] = [
            Difference(mean, interval, deviation, int(count))
            for mean, interval, deviation, count in zip(
                means_of(paired, even=even).tolist(),
                interval_of(resamples, paired, comparisons=compared),
                np.std(resamples, axis=0).tolist(),
                known,
                strict=True,
            )
        ]
    return found


def _less(sample: Sample, base: Sample) -> Sample:
    if sample.values.shape != base.values.shape or (sample.clusters != base.clusters).any():
        raise ValueError("paired samples must have the same episodes")
    return Sample(sample.values - base.values, sample.clusters)
