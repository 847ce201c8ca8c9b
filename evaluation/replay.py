"""A recorded crowd as it is replayed: everyone's place at every tick."""

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
"""A sample this part of a tick off still counts as on the tick."""


class Replay:
    """Positions of everyone, one a tick; tick k is at k × `tick_s` in the recording's own time.

    Pedestrians are numbered in the order of their ids, by number where ids are numbers. Memory:
    one position for each tick at which a pedestrian is there.
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
        """Last tick of the recording."""
        self.first = np.array([math.ceil(t.start_s / tick_s - _SLACK) for t in tracks])
        """First tick at which each pedestrian is there, int64 (N,)."""
        self.last = np.array([math.floor(t.end_s / tick_s + _SLACK) for t in tracks])
        """Last tick, int64 (N,); before the first for who falls between two ticks."""
        self._ways = [
            _resample(track, np.arange(first, last + 1) * tick_s, interpolation)
            for track, first, last in zip(tracks, self.first, self.last, strict=True)
        ]

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest rectangle (x0, y0, x1, y1) around everyone's ways, metres; 0 where none is."""
        ways = [way for way in self._ways if len(way)] or [np.zeros((1, 2))]
        lower = np.min([way.min(axis=0) for way in ways], axis=0)
        upper = np.max([way.max(axis=0) for way in ways], axis=0)
        return float(lower[0]), float(lower[1]), float(upper[0]), float(upper[1])

    def way(self, pedestrian: int) -> Floats:
        """A pedestrian's positions, float64 (last - first + 1, 2)."""
        return self._ways[pedestrian]

    def present(self, tick: int) -> NDArray[np.int64]:
        """Who is there at a tick, in ascending order."""
        return self.present_between(tick, tick)

    def present_between(self, first: int, last: int) -> NDArray[np.int64]:
        """Who is there at any tick from the first to the last, in ascending order."""
        lasts = np.maximum(self.first, first) <= np.minimum(self.last, last)
        return np.flatnonzero(lasts)

    def at(self, pedestrian: int, tick: int) -> Floats:
        """Position (2,) at a tick at which the pedestrian is there."""
        return np.asarray(self._ways[pedestrian][tick - self.first[pedestrian]])

    def positions(self, pedestrians: NDArray[np.int64], tick: int) -> Floats:
        """Positions (len(pedestrians), 2) of people who are there at the tick."""
        rows = [self.at(int(j), tick) for j in pedestrians]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    def past(self, pedestrian: int, tick: int, ticks: int) -> Floats:
        """Positions up to a tick, newest last, at most so many ticks back."""
        here = tick - int(self.first[pedestrian])
        return self._ways[pedestrian][max(0, here - ticks) : here + 1]


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
