"""A recorded crowd: the tracks of pedestrians over time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from esplanade.recordings.plausibility import Report

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Track:
    """The track of one pedestrian: N >= 1 samples in the order of time.

    `times` is float64 (N,), seconds, strictly increasing. `positions` is float64 (N, 2), metres.
    Between samples the pedestrian walks straight at constant speed.
    """

    id: str
    times: Floats
    positions: Floats

    @property
    def start_s(self) -> float:
        """The time of the first sample."""
        return float(self.times[0])

    @property
    def end_s(self) -> float:
        """The time of the last sample."""
        return float(self.times[-1])

    def at(self, t: float) -> tuple[float, float]:
        """Position (x, y), metres, at time `t` in seconds.

        Before the start it is the first position, and after the end the last one.
        """
        x = np.interp(t, self.times, self.positions[:, 0])
        y = np.interp(t, self.times, self.positions[:, 1])
        return float(x), float(y)

    @cached_property
    def max_speed_mps(self) -> float:
        """Greatest speed between two neighbouring samples; 0 for a single sample."""
        if len(self.times) < 2:
            return 0.0
        steps_m = np.hypot(*np.diff(self.positions, axis=0).T)
        return float(np.max(steps_m / np.diff(self.times)))


@dataclass(frozen=True, eq=False)
class Crowd:
    """The tracks of one recording, in the order in which the pedestrians first appear.

    There is at least one track. `report` tells how the file was read, if it comes from one.
    """

    name: str
    tracks: tuple[Track, ...]
    report: Report | None = None

    @cached_property
    def start_s(self) -> float:
        """The time of the first sample of all."""
        return min(track.start_s for track in self.tracks)

    @cached_property
    def end_s(self) -> float:
        """The time of the last sample of all."""
        return max(track.end_s for track in self.tracks)

    @property
    def duration_s(self) -> float:
        """The time from the first sample to the last one."""
        return self.end_s - self.start_s

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest rectangle (x0, y0, x1, y1) around every sample, metres."""
        lower = np.min([track.positions.min(axis=0) for track in self.tracks], axis=0)
        upper = np.max([track.positions.max(axis=0) for track in self.tracks], axis=0)
        return float(lower[0]), float(lower[1]), float(upper[0]), float(upper[1])

    @cached_property
    def max_speed_mps(self) -> float:
        """Greatest speed of any pedestrian between two neighbouring samples."""
        return max(track.max_speed_mps for track in self.tracks)

    @cached_property
    def max_present(self) -> int:
        """Greatest number of pedestrians who are present at the same time."""
        starts = np.sort([track.start_s for track in self.tracks])
        ends = np.sort([track.end_s for track in self.tracks])
        left_before = np.searchsorted(ends, starts, side="left")
        return int(np.max(np.arange(1, len(starts) + 1) - left_before))
