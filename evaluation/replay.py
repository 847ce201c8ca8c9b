"""The replay of a recorded crowd: everyone's position at every tick."""

import math
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from esplanade.evaluation.obstacles import ObstacleSet
from esplanade.recordings import Crowd, Obstacles, Track

Floats = NDArray[np.float64]
Interpolation = Literal["linear", "cubic"]

_SLACK: Final = 1e-6
"""A sample that differs from a tick by this part of a tick counts as on the tick."""


class Replay:
    """The positions of all pedestrians at every tick.

    Tick k is at k × `tick_s` in the recording's own time. Pedestrians are numbered in the order of
    their ids, numerically if the ids are numbers. Memory is one position for each tick at which a
    pedestrian is present.
    """

    def __init__(
        self,
        crowd: Crowd,
        obstacles: Obstacles | None = None,
        *,
        tick_s: float = 0.1,
        interpolation: Interpolation = "linear",
    ) -> None:
        self.name = crowd.name
        self.tick_s = tick_s
        self.obstacles = ObstacleSet(obstacles or Obstacles())
        tracks = sorted(crowd.tracks, key=_by_number)
        self.ids = tuple(track.id for track in tracks)
        self.end_tick = math.floor(crowd.end_s / tick_s + _SLACK)
        """The last tick of the recording."""
        self.first = np.array([math.ceil(t.start_s / tick_s - _SLACK) for t in tracks])
        """The first tick at which each pedestrian is present, int64 (N,)."""
        self.last = np.array([math.floor(t.end_s / tick_s + _SLACK) for t in tracks])
        """The last tick of each pedestrian, int64 (N,). It is less than the first one for a
        pedestrian who was recorded only between two ticks."""
        self._trajectories = [
            _resample(track, np.arange(first, last + 1) * tick_s, interpolation)
            for track, first, last in zip(tracks, self.first, self.last, strict=True)
        ]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest rectangle (x0, y0, x1, y1) around all trajectories, metres.

        All four are 0 if nobody is present at any tick.
        """
        trajectories = [t for t in self._trajectories if len(t)] or [np.zeros((1, 2))]
        lower = np.min([t.min(axis=0) for t in trajectories], axis=0)
        upper = np.max([t.max(axis=0) for t in trajectories], axis=0)
        return float(lower[0]), float(lower[1]), float(upper[0]), float(upper[1])

    def trajectory(self, pedestrian: int) -> Floats:
        """A pedestrian's positions tick by tick, float64 (last - first + 1, 2), metres."""
        return self._trajectories[pedestrian]

    def present(self, tick: int) -> NDArray[np.int64]:
        """The pedestrians who are present at a tick, in ascending order."""
        return self.present_between(tick, tick)

    def present_between(self, first: int, last: int) -> NDArray[np.int64]:
        """The pedestrians who are present at any tick from first to last, in ascending order."""
        overlaps = np.maximum(self.first, first) <= np.minimum(self.last, last)
        return np.flatnonzero(overlaps)

    def at(self, pedestrian: int, tick: int) -> Floats:
        """Position (2,), metres, at a tick at which the pedestrian is present."""
        return np.asarray(self._trajectories[pedestrian][tick - self.first[pedestrian]])

    def positions(self, pedestrians: NDArray[np.int64], tick: int) -> Floats:
        """Positions (len(pedestrians), 2), metres, of people who are present at the tick."""
        rows = [self.at(int(j), tick) for j in pedestrians]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    def past(self, pedestrian: int, tick: int, ticks: int) -> Floats:
        """Positions up to a tick, newest last; they go back by at most `ticks` ticks."""
        here = tick - int(self.first[pedestrian])
        return self._trajectories[pedestrian][max(0, here - ticks) : here + 1]


def _by_number(track: Track) -> tuple[int, float, str]:
    try:
        return 0, float(track.id), track.id
    except ValueError:
        return 1, 0.0, track.id


def _resample(track: Track, times: Floats, interpolation: Interpolation) -> Floats:
    if interpolation == "cubic" and len(track.times) > 2:
        tangents = np.gradient(track.positions, track.times, axis=0)
        return np.asarray(CubicHermiteSpline(track.times, track.positions, tangents)(times))
    x, y = (np.interp(times, track.times, track.positions[:, axis]) for axis in (0, 1))
    return np.column_stack([x, y])
