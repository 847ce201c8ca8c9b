"""Where people may go next: Lei & Li, sec. 3.2, eqs. (1)-(4)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planning import _prediction_kernels as kernels
from planning._prediction_kernels import Prediction
from planning.grid import LayeredGrid
from planning.spread import PEOPLE, Spread


@dataclass(frozen=True)
class PredictionModel:
    """Constants of the prediction.

    The defaults are those that hold on recorded pedestrians: velocities 0.4 s apart, weighted
    1/2, 1/4, 1/8, ...; a deviation per axis that grows by 0.17 m a second; errors that are mostly
    smaller, and now and then larger, than those of one Gaussian.
    """

    samples: int = 4
    """How many past velocities count."""
    sample_s: float = 0.4
    """Time between the positions that velocities are taken from, seconds."""
    sigma_0_m: float = 0.05
    """sigma_0 of eq. (3): how far a person's centre may lie from where it is reported, metres."""
    sigma_growth_mps: float = 0.17
    """Growth of the deviation: alpha(i) = 1 + (growth / sigma_0) * i * slice of eq. (3)."""
    calibration_s: float = 4.0
    """Memory of the calibration: over this time a person's own errors replace `sigma_growth_mps`;
    infinite keeps the same growth for everyone. Seconds."""
    least_growth_mps: float = 0.08
    """However steadily somebody walks, the deviation grows at least so fast, metres a second."""
    spread: Spread = PEOPLE
    """Shape of the errors, in deviations: `GAUSSIAN` is eq. (4) as it stands."""
    wall_clearance_m: float = 0.15
    """How close to walls people are expected to pass, metres."""
    printed: bool = False
    """Eq. (1) with the signs as printed. It extrapolates noise on real tracks: reference only."""


_LIFT_M = 1.0
"""Who is suddenly so much higher or lower has been put there: the past before does not count."""


def _by_name(who: object) -> tuple[str, str]:
    return type(who).__name__, str(who)


class TrackHistory:
    """The recorded past of everyone who can be seen, one position a tick.

    People are kept in the order of their ids, so that sums over them do not depend on how they
    were listed. Memory: `samples` x `sample_s` / `tick_s` positions a person. `observe` costs
    O(people log people).
    """

    def __init__(self, model: PredictionModel, tick_s: float) -> None:
        self.model = model
        self.stride = max(1, round(model.sample_s / tick_s))
        self.sample_s = self.stride * tick_s
        self._depth = self.stride * model.samples + 1
        self._rows: dict[object, int] = {}
        self._free: list[int] = []
        self._ring = np.zeros((0, self._depth, 2))
        self._count = np.zeros(0, dtype=np.int64)
        self._height = np.zeros(0)
        self._newest = -1
        self._order = np.zeros(0, dtype=np.int64)
        self._lag = 2 * self.stride
        self._lag_s = self._lag * tick_s
        self._memory = -math.expm1(-tick_s / model.calibration_s)
        self._expected = np.zeros((0, self._lag, 2))
        self._growth2 = np.zeros(0)
        self._velocities = np.zeros((0, 2))
        self._ticks = -1

    @property
    def ids(self) -> list[object]:
        """Who is present, in the order of `positions` and of every array made from them."""
        return list(self._rows)

    @property
    def positions(self) -> NDArray[np.float64]:
        """Newest positions, float64 (P, 2), metres."""
        if not len(self._order):
            return np.zeros((0, 2))
        return np.ascontiguousarray(self._ring[self._order, self._newest])

    @property
    def heights(self) -> NDArray[np.float64]:
        """Heights of everyone's feet, float64 (P,), metres."""
        return self._height[self._order]

    def observe(self, people: Mapping[object, tuple[float, ...]]) -> None:
        """Add this tick's positions: id -> (x, y) or (x, y, z). Who is absent has left.

        Raises
        ------
        ValueError
            A position is not finite or not of length 2 or 3; nothing is changed then.
        """
        listed = sorted(people, key=_by_name)
        places = [tuple(people[who]) for who in listed]
        rows = np.array(
            [(*place, 0.0)[:3] if len(place) in (2, 3) else (np.nan,) * 3 for place in places],
            dtype=np.float64,
        ).reshape(-1, 3)
        broken = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        if len(broken):
            who, place = listed[broken[0]], places[broken[0]]
            raise ValueError(f"position of {who!r} must be finite (x, y[, z]), got {place}")
        for who in [who for who in self._rows if who not in people]:
            self._free.append(self._rows.pop(who))
        for who in listed:
            if who not in self._rows:
                self._rows[who] = self._take_row()
        self._rows = {who: self._rows[who] for who in listed}
        self._order = np.fromiter(self._rows.values(), dtype=np.int64, count=len(self._rows))
        self._newest = (self._newest + 1) % self._depth
        lifted = np.abs(self._height[self._order] - rows[:, 2]) > _LIFT_M
        self._count[self._order[lifted]] = 0
        self._height[self._order] = rows[:, 2]
        self._ring[self._order, self._newest] = rows[:, :2]
        self._count[self._order] = np.minimum(self._count[self._order] + 1, self._depth)
        self._calibrate()

    def _calibrate(self) -> None:
        """Hold what was expected of everyone two samples ago against where they are now.

        The square of a person's growth is a running mean of their squared errors per axis over
        the squared time, beginning with the model's.
        """
        self._ticks += 1
        order, slot = self._order, self._ticks % self._lag
        ready = order[self._count[order] > self._lag + self.stride]
        missed = self._ring[ready, self._newest] - self._expected[ready, slot]
        growth2 = (missed**2).sum(axis=1) / (2.0 * self._lag_s**2)
        self._growth2[ready] += self._memory * (growth2 - self._growth2[ready])
        self._velocities = self._predicted_velocities()
        self._expected[order, slot] = self.positions + self._velocities * self._lag_s

    @property
    def growth_mps(self) -> NDArray[np.float64]:
        """Growth of everyone's deviation, calibrated on their own past, float64 (P,), m/s."""
        return np.maximum(np.sqrt(self._growth2[self._order]), self.model.least_growth_mps)

    def _take_row(self) -> int:
        if not self._free:
            size = len(self._ring)
            grown = max(16, 2 * size)
            self._ring = np.concatenate([self._ring, np.zeros((grown - size, self._depth, 2))])
            self._count = np.concatenate([self._count, np.zeros(grown - size, dtype=np.int64)])
            self._height = np.concatenate([self._height, np.zeros(grown - size)])
            more = np.zeros((grown - size, self._lag, 2))
            self._expected = np.concatenate([self._expected, more])
            self._growth2 = np.concatenate([self._growth2, np.zeros(grown - size)])
            self._free = list(range(grown - 1, size - 1, -1))
        row = self._free.pop()
        self._count[row] = 0
        self._growth2[row] = self.model.sigma_growth_mps**2
        return row

    def velocities(self) -> NDArray[np.float64]:
        """Predicted velocities, eq. (1), float64 (P, 2), m/s.

        Who has been seen for less than one sample gets the newest velocity.
        """
        return self._velocities

    def newest_velocities(self) -> NDArray[np.float64]:
        """Everyone's velocity over the newest sample, v of eq. (1), float64 (P, 2), m/s.

        Who has been seen for less than one sample gets the mean velocity so far, zero at first.
        """
        ticks = np.minimum(self._count[self._order] - 1, self.stride)
        before = self._ring[self._order, (self._newest - ticks) % self._depth]
        seconds = np.maximum(ticks, 1) * self.sample_s / self.stride
        return np.asarray((self.positions - before) / seconds[:, None])

    def _predicted_velocities(self) -> NDArray[np.float64]:
        people = len(self._order)
        out = np.zeros((people, 2))
        if not people:
            return out
        back = (self._newest - self.stride * np.arange(self.model.samples + 1)) % self._depth
        tracks = self._ring[self._order][:, back]
        count = self._count[self._order]
        known = (count - 1) // self.stride + 1
        kernels.velocities(tracks, known, self.sample_s, self.model.printed, out)
        short = known < 2
        out[short] = self.newest_velocities()[short]
        return out

    def predict(self, grid: LayeredGrid, slices: int, slice_s: float) -> Prediction:
        """Everyone's future: `slices` + 1 instants `slice_s` apart, beginning now. Cost O(P K)."""
        people = len(self._order)
        shape = (people, slices + 1)
        prediction = Prediction(
            np.zeros((*shape, 2)),
            np.zeros((*shape, 2)),
            np.zeros(shape),
            np.zeros(shape),
            self.newest_velocities(),
        )
        kernels.extrapolate(
            grid.arrays,
            grid.index,
            self.positions,
            self.heights,
            self.velocities(),
            slice_s,
            self.model.sigma_0_m,
            self.growth_mps,
            self.model.wall_clearance_m,
            prediction,
        )
        return prediction
