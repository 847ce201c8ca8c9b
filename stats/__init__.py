"""Statistics of what is measured in pieces of time that hang together: intervals and comparisons.

Trips that are walked at the same time among the same people have much in common. They are one
cluster, and whole clusters are drawn anew, so that intervals are as wide as they should be.
"""

from esplanade.stats.comparisons import Difference, compare
from esplanade.stats.intervals import CONFIDENCE, Interval, interval_of, share_interval
from esplanade.stats.power import needed
from esplanade.stats.resampling import Sample, means_of, resampled_means, resampled_medians

__all__ = [
    "CONFIDENCE",
    "Difference",
    "Interval",
    "Sample",
    "compare",
    "interval_of",
    "means_of",
    "needed",
    "resampled_means",
    "resampled_medians",
    "share_interval",
]
