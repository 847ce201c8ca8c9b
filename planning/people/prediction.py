"""Prediction of people from their past: Lei & Li, sec. 3.2, eqs. (1)-(4)."""

from __future__ import annotations

import bisect
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.handle import make_handle
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.people import _prediction_kernels as kernels
from esplanade.planning.people._prediction_kernels import Prediction, Tracks
from esplanade.planning.people.spread import PEOPLE, Spread

Coordinates = Sequence[float] | NDArray[np.float64]
"""(x, y) or (x, y, z) in metres."""
_NAME = itemgetter(0)


@dataclass(frozen=True)
class PredictionModel:
    """Constants of the prediction.

    The defaults are those that hold on recorded pedestrians: velocities 0.4 s apart, weighted
    1/2, 1/4, 1/8, ...; a deviation per axis that grows by 0.17 m a second; errors that are mostly
    smaller, and now and then larger, than those of one Gaussian.
    """

    samples: int = 4
    """Number of past velocities that count."""
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
    """Distance to walls, metres, at which people are expected to pass."""
    printed: bool = False
    """Eq. (1) with the signs as printed. It extrapolates noise on real tracks: reference only."""


def _name(who: object) -> tuple[str, str]:
    return type(who).__name__, str(who)


def _as_places(listed: Sequence[object], given: Sequence[Coordinates]) -> NDArray[np.float64]:
    """Places as float64 (P, 2) or (P, 3)."""
    try:
        points = np.array(given, dtype=np.float64)
    except ValueError:  # not all alike, or no numbers
        points = np.empty((0, 0))
    if points.ndim == 2 and points.shape[1] in (2, 3) and np.isfinite(points).all():
        return points
    places = np.zeros((len(given), 3))
    for who, place, row in zip(listed, given, places, strict=True):
        point = tuple(place)
        if len(point) not in (2, 3) or not all(map(math.isfinite, point)):
            raise ValueError(f"position of {who!r} must be finite (x, y[, z]), got {point}")
        row[:] = (*point, 0.0)[:3]
    return places


class TrackHistory:
    """The recorded past of everyone who can be seen, one position a tick.

    People are kept in the order of their ids, so that sums over them do not depend on how they
    were listed. Memory: `samples` x `sample_s` / `tick_s` positions a person. `observe` costs
    O(people), and as much again for each person who comes or leaves.
    """

    def __init__(self, model: PredictionModel, tick_s: float) -> None:
        self.model = model
        self.tick_s = tick_s
        self.stride = max(1, round(model.sample_s / tick_s))
        self._memory = -math.expm1(-tick_s / model.calibration_s)
        depth = self.stride * model.samples + 1
        self._tracks = Tracks(
            np.zeros((0, depth, 2)),
            np.zeros(0, dtype=np.int64),
            np.zeros(0),
            np.zeros((0, 2 * self.stride, 2)),
            np.zeros(0),
        )
        self._held = make_handle(self._tracks)
        self._rows: dict[object, int] = {}
        self._listed: list[tuple[tuple[str, str], object]] = []
        self._ids: list[object] = []
        self._free: list[int] = []
        self._order = np.zeros(0, dtype=np.int64)
        self._places = np.zeros((0, 3))
        self._velocities = np.zeros((0, 2))
        self._newest = np.zeros((0, 2))
        self._ticks = -1
        self.version = 0
        """It grows when people come or leave."""
        self._array_ids: NDArray[np.int64] | None = None
        self._array_order = np.zeros(0, dtype=np.int64)

    @property
    def ids(self) -> list[object]:
        """The ids of people present, in the order of `positions` and of all arrays made of them."""
        return list(self._ids)

    @property
    def places(self) -> NDArray[np.float64]:
        """Newest positions with the heights of the feet, float64 (P, 3), metres."""
        return self._places

    @property
    def positions(self) -> NDArray[np.float64]:
        """Newest positions, float64 (P, 2), metres."""
        return np.ascontiguousarray(self._places[:, :2])

    @property
    def heights(self) -> NDArray[np.float64]:
        """Heights of everyone's feet, float64 (P,), metres."""
        return np.ascontiguousarray(self._places[:, 2])

    def observe(self, people: Mapping[object, Coordinates]) -> None:
        """Add this tick's positions: id -> (x, y) or (x, y, z). People who are absent have left.

        Raises
        ------
        ValueError
            A position is not finite or not of length 2 or 3; nothing is changed then.
        """
        same = people.keys() == self._rows.keys()
        listed = self._listed if same else self._listed_with(people)
        ids = self._ids if same else [who for _, who in listed]
        given = _as_places(ids, [people[who] for who in ids])
        if not same:
            self._take_in(listed, ids)
            self._array_ids = None
        self._note(given)

    def observe_arrays(self, ids: NDArray[np.int64], places: NDArray[np.float64]) -> None:
        """Add this tick's `places` (P, 3) m of the people `ids` (P,), each listed once.

        While the same people come in the same order this costs no work per person in Python.

        Raises
        ------
        ValueError
            A place is not finite; nothing is changed then.
        """
        if not np.isfinite(places).all():
            who = ids[np.flatnonzero(~np.isfinite(places).all(axis=1))[0]]
            raise ValueError(f"position of {int(who)} must be finite")
        if self._array_ids is None or not np.array_equal(ids, self._array_ids):
            names: list[object] = ids.tolist()
            listed = self._listed_with(dict.fromkeys(names))
            sorted_ids = [who for _, who in listed]
            self._take_in(listed, sorted_ids)
            at = {who: k for k, who in enumerate(names)}
            self._array_order = np.array([at[who] for who in sorted_ids], dtype=np.int64)
            self._array_ids = ids.copy()
        self._note(places[self._array_order])

    def _listed_with(self, people: Mapping[object, object]) -> list[tuple[tuple[str, str], object]]:
        """The sorted list of the people present once `people` are."""
        listed = [pair for pair in self._listed if pair[1] in people]
        for who in people:
            if who not in self._rows:
                bisect.insort(listed, (_name(who), who), key=_NAME)
        return listed

    def _take_in(self, listed: list[tuple[tuple[str, str], object]], ids: list[object]) -> None:
        """Free the rows of those who have left, and find rows for those who came."""
        for who in self._rows.keys() - set(ids):
            self._free.append(self._rows.pop(who))
        for who in ids:
            if who not in self._rows:
                self._rows[who] = self._take_row()
        self._listed, self._ids = listed, ids
        self.version += 1
        self._order = np.array([self._rows[who] for who in ids], dtype=np.int64)

    def _note(self, given: NDArray[np.float64]) -> None:
        """Add the places (P, 2 or 3) of those who are present, in their order."""
        self._ticks += 1
        self._places = np.empty((len(given), 3))
        self._velocities = np.empty((len(given), 2))
        self._newest = np.empty((len(given), 2))
        kernels.note(
            self._held,
            self._order,
            given,
            self._ticks,
            self.tick_s,
            self.stride,
            self._memory,
            self.model.printed,
            self._places,
            self._velocities,
            self._newest,
        )

    def _take_row(self) -> int:
        if not self._free:
            size = len(self._tracks.counts)
            more = max(16, size)
            self._tracks = Tracks(
                *(
                    np.concatenate([kept, np.zeros((more, *kept.shape[1:]), dtype=kept.dtype)])
                    for kept in self._tracks
                )
            )
            self._held = make_handle(self._tracks)
            self._free = list(range(size + more - 1, size - 1, -1))
        row = self._free.pop()
        for column in self._tracks:
            column[row] = 0  # equal pasts are saved as equal bytes, whoever had the row before
        self._tracks.growths2[row] = self.model.sigma_growth_mps**2
        return row

    def save(self) -> dict[str, Any]:
        """The past of everyone who is present, as plain data and copies of arrays.

        The rows of the arrays are in the order of `ids`.
        """
        tracks = {name: column[self._order] for name, column in self._tracks._asdict().items()}
        return {
            "ids": list(self._ids),
            "ticks": self._ticks,
            "places": self._places.copy(),
            **tracks,
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Know the past that was saved, and no other.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or has another shape; nothing is changed then.
        """
        ids = list(saved["ids"])
        columns = {}
        for name, column in self._tracks._asdict().items():
            columns[name] = np.array(saved[name], dtype=column.dtype)
            if columns[name].shape != (len(ids), *column.shape[1:]):
                raise ValueError(f"the past of {len(ids)} people cannot have {name} of that shape")
        places = np.array(saved["places"], dtype=np.float64).reshape(len(ids), 3)
        ticks, kept = int(saved["ticks"]), [*columns.values(), places]
        counts = columns["counts"]
        if not all(np.isfinite(each).all() for each in kept) or (counts < 0).any() or ticks < -1:
            raise ValueError("the past of people holds what cannot be")
        self._tracks = Tracks(**columns)
        self._held = make_handle(self._tracks)
        self._rows = {who: row for row, who in enumerate(ids)}
        self._listed = sorted(((_name(who), who) for who in ids), key=_NAME)
        self._ids = [who for _, who in self._listed]
        self._order = np.array([self._rows[who] for who in self._ids], dtype=np.int64)
        self._places, self._free = places[self._order], []
        self._velocities, self._newest = np.zeros((len(ids), 2)), np.zeros((len(ids), 2))
        self._ticks, self._array_ids = ticks, None
        self.version += 1

    def velocities(self) -> NDArray[np.float64]:
        """Predicted velocities, eq. (1), float64 (P, 2), m/s.

        A person seen for less than one sample has the mean velocity so far, zero at first.
        """
        return self._velocities

    def predict(self, grid: LayeredGrid, slices: int, slice_s: float) -> Prediction:
        """Predict `slices` + 1 instants `slice_s` apart, beginning now. Cost O(P K)."""
        people = len(self._order)
        shape = (people, slices + 1)
        prediction = Prediction(
            np.empty((*shape, 2)),
            np.empty((*shape, 2)),
            np.empty(shape),
            np.empty(shape),
            self._newest,
        )
        kernels.extrapolate(
            grid.ground,
            self._held,
            self._order,
            self._places,
            self._velocities,
            slice_s,
            self.model.sigma_0_m,
            self.model.least_growth_mps,
            self.model.wall_clearance_m,
            prediction,
        )
        return prediction
