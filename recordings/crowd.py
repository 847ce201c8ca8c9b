"""A recorded crowd: who was where, when."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Track:
    """One pedestrian's way: samples in the order of time.

    `times` is float64 (N,), seconds, strictly increasing; `positions` float64 (N, 2), metres;
    N >= 1. Between samples the pedestrian walks straight and evenly.
    """

    id: str
    times: Floats
    positions: Floats

    @property
    def start_s(self) -> float:
        return float(self.times[0])

    @property
    def end_s(self) -> float:
        return float(self.times[-1])

    def at(self, t: float) -> tuple[float, float]:
        """Position (x, y), metres, at time `t` in seconds; the nearer end outside the track."""
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
    """Everyone of one recording, in the order in which they first appear; at least one track."""

    name: str
    tracks: tuple[Track, ...]

    @cached_property
    def start_s(self) -> float:
        return min(track.start_s for track in self.tracks)

    @cached_property
    def end_s(self) -> float:
        return max(track.end_s for track in self.tracks)

    @property
    def duration_s(self) -> float:
        return self.end_s - self.start_s

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest rectangle (x0, y0, x1, y1) around every sample, metres."""
        lower = np.min([track.positions.min(axis=0) for track in self.tracks], axis=0)
        upper = np.max([track.positions.max(axis=0) for track in self.tracks], axis=0)
        return float(lower[0]), float(lower[1]), float(upper[0]), float(upper[1])

    @cached_property
    def max_speed_mps(self) -> float:
        return max(track.max_speed_mps for track in self.tracks)

    @cached_property
    def max_present(self) -> int:
        """Most pedestrians that are there at the same time."""
        starts = np.sort([track.start_s for track in self.tracks])
        ends = np.sort([track.end_s for track in self.tracks])
        left_before = np.searchsorted(ends, starts, side="left")
        return int(np.max(np.arange(1, len(starts) + 1) - left_before))
