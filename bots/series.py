"""The course of a run over time: what happened in each second, in a size that is bounded.

A run longer than `MAX_BUCKETS` seconds is told in buckets of two seconds, then of four, and so on.
"""

import math
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import Final

MAX_BUCKETS: Final = 600

LEAST_S: Final = 1e-4
STEP: Final = 1.05
"""Ages in a bucket are told in bins, each five per cent wider than the last."""

_SCALE: Final = 1.0 / math.log(STEP)


@dataclass(slots=True)
class Bucket:
    """The counts of one stretch of time, summed over clients."""

    joined: int = 0
    failed: int = 0
    left: int = 0
    lost: int = 0
    errors: int = 0
    due: int = 0
    """Snapshots whose ticks were due in this stretch, whether they came or not."""
    received: int = 0
    """Snapshots that came in this stretch, whenever their ticks were due."""
    bytes_in: int = 0
    bytes_out: int = 0
    ages: Counter[int] = field(default_factory=Counter)
    """The ages of the snapshots that were due, by bin."""

    def add_age(self, age_s: float, times: int = 1) -> None:
        """Count a snapshot that was due, and came or did not come at this age."""
        place = int(math.log(age_s / LEAST_S) * _SCALE) + 1 if age_s > LEAST_S else 0
        self.ages[place] += times
        self.due += times

    def age_s(self, percent: float) -> float | None:
        """The age that `percent` of all do not exceed, at most 5 % too great; None without any."""
        wanted = max(1, math.ceil(self.ages.total() * percent / 100.0))
        reached = 0
        for place, count in sorted(self.ages.items()):
            reached += count
            if reached >= wanted:
                return LEAST_S * STEP**place
        return None

    def merge(self, other: "Bucket") -> None:
        """Add what the other has counted."""
        for name in self.__slots__:
            setattr(self, name, getattr(self, name) + getattr(other, name))


class Series:
    """Buckets of equal width, the first of which begins at `begin_s` of the monotonic clock."""

    def __init__(self, begin_s: float | None = None, width_s: float = 1.0) -> None:
        """Without `begin_s`, the series begins now."""
        self.begin_s = time.monotonic() if begin_s is None else begin_s
        self.width_s = width_s
        self.buckets: list[Bucket] = []

    def at(self, time_s: float) -> Bucket:
        """The bucket of this moment; what came before the beginning is in the first one."""
        place = max(0, int((time_s - self.begin_s) / self.width_s))
        while place >= MAX_BUCKETS:
            self._coarsen()
            place //= 2
        while place >= len(self.buckets):
            self.buckets.append(Bucket())
        return self.buckets[place]

    def merge(self, other: "Series") -> None:
        """Add what another process has counted since its own beginning."""
        width_s = max(self.width_s, other.width_s)
        while self.width_s < width_s:
            self._coarsen()
        ratio = round(width_s / other.width_s)
        for place, bucket in enumerate(other.buckets):
            self.at(self.begin_s + (place // ratio + 0.5) * width_s).merge(bucket)

    def present(self) -> list[int]:
        """The number of clients in the world at the end of each bucket."""
        here, found = 0, []
        for bucket in self.buckets:
            here += bucket.joined - bucket.left - bucket.lost
            found.append(here)
        return found

    def _coarsen(self) -> None:
        for even, odd in zip(self.buckets[::2], self.buckets[1::2], strict=False):
            even.merge(odd)
        self.buckets = self.buckets[::2]
        self.width_s *= 2.0
