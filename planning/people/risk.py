"""The risk of being somewhere at some time: Lei & Li, sec. 3.3, eq. (5)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.people import _risk_kernels as kernels
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.people._risk_kernels import RadialTables, RiskArrays
from esplanade.planning.people.spread import GAUSSIAN, Spread

_SIGMA_STEP_M = 0.02
_SIGMA_MAX_M = 1.5
_SQUARED_STEP_M2 = 0.04
_LEAST = 1e-3
_LEAST_BUCKET_M = 2.0
_MOST_BUCKETS = 16384
"""Larger zones have wider buckets, since all are cleared in every tick."""
SLACK_M = 0.8
"""A step of 0.4 s at 2 m/s."""
Box = tuple[float, float, float, float]
"""x0, y0, x1, y1 in metres."""
EVERYWHERE: Box = (-math.inf, -math.inf, math.inf, math.inf)
_SIGMA_POINTS = 9
_RADIUS_M = 0.25
RADIUS_STEP_M = 0.05
"""Tables are for radii rounded up to this."""
_WIDEST_M = 0.9
"""Tables have room for agents up to this radius, so that those of others stay as they are."""
_SIGMA_SPAN = 2.5


@dataclass(frozen=True)
class RiskModel:
    """Shape of the risk around one person."""

    person_radius_m: float = 0.25
    """Radius of the people of a zone, metres."""
    contact_margin_m: float = 0.1
    """Centres nearer than the sum of the radii and this count as in contact, metres."""
    influence_m: float = 0.6
    """Beyond contact the proximity term falls to zero over this distance, metres."""
    comfort: float = 0.05
    """Proximity term just outside contact, where contact itself counts 1."""
    sway_m: float = 0.1
    """Deviation, per axis, of a body from where it was expected even a moment before:
    bodies sway, and are no discs. It adds to that of the prediction by squares, metres."""
    reaction_s: float = 1.2
    """Deviations grow up to this time ahead, seconds: a person who is to be met later will have
    been seen again before there is need to turn aside."""

    def contact_m(self, radius_m: float) -> float:
        """Distance of centres that counts as contact for an agent of this radius, metres."""
        return radius_m + self.person_radius_m + self.contact_margin_m

    def near(self, distance_m: ArrayLike, contact_m: float) -> NDArray[np.float64]:
        """Proximity term w1·d of eq. (5) for a person known to be at a distance; in [0, 1].

        As printed the weight of the distance would have to be negative for "nearer is riskier" to
        hold. This term is positive, falls with distance and ends at contact + influence.
        """
        d = np.asarray(distance_m, dtype=np.float64)
        return np.where(d <= contact_m, 1.0, self.comfort * self.toward(d, contact_m))

    def toward(self, distance_m: ArrayLike, contact_m: float) -> NDArray[np.float64]:
        """Factor of the closing speed for a person known to be at a distance; in [0, 1]."""
        beyond = (np.asarray(distance_m, dtype=np.float64) - contact_m) / self.influence_m
        return np.asarray(np.clip(1.0 - beyond, 0.0, 1.0) ** 2)


def sigma_points() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A fixed even grid over the likely range of a unit Gaussian: offsets (S, 2), weights (S,).

    The weights are the density of eq. (4) at the offsets, normalised to sum one: the mean over
    the range of density times risk, times the range's area, so that the range's size drops out.
    """
    axis = np.linspace(-_SIGMA_SPAN, _SIGMA_SPAN, _SIGMA_POINTS)
    gx, gy = np.meshgrid(axis, axis)
    offsets = np.stack([gx.ravel(), gy.ravel()], axis=1)
    offsets = offsets[(offsets**2).sum(axis=1) <= _SIGMA_SPAN**2 + 1e-9]
    weights = np.exp(-0.5 * (offsets**2).sum(axis=1))
    return offsets, weights / weights.sum()


@lru_cache(maxsize=32)
def radial_tables(
    model: RiskModel, contacts_m: tuple[float, ...], spread: Spread = GAUSSIAN
) -> RadialTables:
    """Influence of one person by deviation and distance; it is the same in every direction.

    There is a table for each of the contact distances `contacts_m`. Each entry is the mean over
    the sigma points of density × term of eq. (5), for every Gaussian of the spread over a likely
    range of its own. For the closing term the points' directions n are projected on the direction
    from the mean. It takes a while, so that zones alike share it.
    """
    widest = max(spread.scales) * math.hypot(_SIGMA_MAX_M, model.sway_m)
    beyond_m = model.influence_m + _SIGMA_SPAN * widest
    columns = len(_squared(max(contacts_m) + beyond_m))
    room = len(_squared(max(*contacts_m, model.contact_m(_WIDEST_M)) + beyond_m))
    tables = [_radial_table(model, spread, each, room)[:, :columns] for each in contacts_m]
    matters = np.max([table > _LEAST for table in tables], axis=(0, 3))
    reaches = columns - 2 - np.argmax(matters[:, -2::-1], axis=1)
    return RadialTables(
        np.stack([_per_metre(table) for table in tables]).astype(np.float32),
        np.sqrt((reaches + 1) * _SQUARED_STEP_M2),
        _SIGMA_STEP_M,
        _SQUARED_STEP_M2,
    )


def _squared(reach_m: float) -> NDArray[np.float64]:
    """Squared distances of the columns of a table that reaches so far, m²."""
    return np.arange(0.0, reach_m**2 + 3 * _SQUARED_STEP_M2, _SQUARED_STEP_M2)


def _per_metre(table: NDArray[np.float64]) -> NDArray[np.float64]:
    """A table whose second term is divided by the distance."""
    divided = table.copy()
    divided[:, 1:, 1] /= np.sqrt(_SQUARED_STEP_M2 * np.arange(1, table.shape[1]))
    divided[:, 0, 1] = divided[:, 1, 1]
    return divided


@lru_cache(maxsize=32)
def _radial_table(
    model: RiskModel, spread: Spread, contact_m: float, columns: int
) -> NDArray[np.float64]:
    """The two terms of one contact distance, float64 (S, C, 2)."""
    sigmas = np.arange(0.0, _SIGMA_MAX_M + _SIGMA_STEP_M / 2, _SIGMA_STEP_M)
    offsets, weights = sigma_points()
    distances = np.sqrt(_SQUARED_STEP_M2 * np.arange(columns))
    here = np.stack([distances, np.zeros_like(distances)], axis=1)
    near = np.zeros((len(sigmas), columns))
    toward = np.zeros_like(near)
    for row, sigma in enumerate(sigmas):
        for scale, share in spread.parts:
            strayed = scale * math.hypot(sigma, model.sway_m) * offsets
            relative = here[:, None] - strayed
            length = np.hypot(relative[..., 0], relative[..., 1])
            along = relative[..., 0] / np.maximum(length, 1e-9)
            near[row] += share * model.near(length, contact_m) @ weights
            toward[row] += share * (model.toward(length, contact_m) * along) @ weights
    return np.stack([near, np.maximum(toward, 0.0)], axis=2)


class RiskField:
    """Risk over a zone for every slice of the future, shared by all actors.

    It keeps what is predicted of people and an index of it: a look-up asks those who matter where
    it looks, so that it costs as much as people stand densely there, however many there are. The
    closing term of eq. (5) for an actor's velocity v_r is max(0, sum p·(v_o·n) - v_r·(sum p·n)),
    n pointing from the person: the bound at zero is taken of the sum, not of each person's term.

    Indexing a prediction costs O(people × slices).
    """

    def __init__(
        self, grid: LayeredGrid, model: RiskModel, slices: int, spread: Spread = GAUSSIAN
    ) -> None:
        self.grid = grid
        self.model = model
        self.slices = slices
        self._spread = spread
        self._contacts_m = [model.contact_m(_RADIUS_M)]
        self.tables = radial_tables(model, tuple(self._contacts_m), spread)
        x0, y0, x1, y1 = grid.bounds
        self._bucket_m = max(_LEAST_BUCKET_M, math.sqrt((x1 - x0) * (y1 - y0) / _MOST_BUCKETS))
        self._columns = max(1, math.ceil((x1 - x0) / self._bucket_m))
        self._rows = max(1, math.ceil((y1 - y0) / self._bucket_m))
        self.arrays = self._room_for(0, 0.0)

    def contact_row(self, radius_m: float) -> int:
        """Row of the tables for agents of a radius, which is rounded up to 5 cm.

        The first agent of a radius costs the making of its table.
        """
        contact_m = self._contact_m(radius_m)
        if contact_m not in self._contacts_m:
            self._contacts_m.append(contact_m)
            self.tables = radial_tables(self.model, tuple(self._contacts_m), self._spread)
            self.arrays = self._room_for(self.arrays.people.shape[1], self.arrays.slack_m)
        return self._contacts_m.index(contact_m)

    def prepare_contacts(self, radii_m: Iterable[float]) -> None:
        """Make the tables that `contact_row` needs for these radii, one after the other.

        Nothing of the field is changed, so that it may be called in any thread.
        """
        contacts_m = list(self._contacts_m)
        for contact_m in map(self._contact_m, radii_m):
            if contact_m not in contacts_m:
                contacts_m.append(contact_m)
                radial_tables(self.model, tuple(contacts_m), self._spread)

    def _contact_m(self, radius_m: float) -> float:
        rounded = math.ceil(radius_m / RADIUS_STEP_M - 1e-9) * RADIUS_STEP_M
        return self.model.contact_m(rounded)

    def _room_for(self, people: int, slack_m: float) -> RiskArrays:
        widest = float(self.tables.reaches.max()) + slack_m
        across = math.ceil(2.0 * widest / self._bucket_m) + 1
        most = min(across, self._columns) * min(across, self._rows)
        x0, y0, _, _ = self.grid.bounds
        buckets = self._columns * self._rows
        return RiskArrays(
            self.tables,
            np.zeros((self.slices + 1, people, 6)),
            np.zeros((self.slices + 1, people), dtype=np.int64),
            np.zeros((self.slices + 1, buckets + 1), dtype=np.int64),
            np.zeros((self.slices + 1, people * most), dtype=np.int64),
            x0,
            y0,
            self._bucket_m,
            slack_m,
            self._columns,
            self._rows,
        )

    def make_room(self, prediction: Prediction, slack_m: float) -> None:
        """Room for the people of a prediction, and for moves that lead so far in a step.

        Raises
        ------
        ValueError
            The prediction has another number of slices.
        """
        if prediction.sigmas.shape[1] != self.slices + 1:
            raise ValueError(
                f"the field has {self.slices + 1} slices, the prediction "
                f"{prediction.sigmas.shape[1]}"
            )
        people = len(prediction.means)
        if people > self.arrays.people.shape[1] or slack_m > self.arrays.slack_m:
            self.arrays = self._room_for(2 * people, max(slack_m, self.arrays.slack_m))

    def last_wider(self, slice_s: float) -> int:
        """The slice up to which deviations grow, slices being so many seconds apart."""
        return round(self.model.reaction_s / slice_s)

    def fill(
        self,
        prediction: Prediction,
        slack_m: float = SLACK_M,
        around: Box = EVERYWHERE,
    ) -> None:
        """Make it the field of a prediction with as many slices.

        Searches ask once for all people who matter within `slack_m` of a node, since a step may
        lead so far. It never gets less. The agents that will search are in the box `around` now;
        people that they cannot come near by the time of a slice are left out.
        Deviations grow up to the last slice.

        Raises
        ------
        ValueError
            Another number of slices.
        """
        self.make_room(prediction, slack_m)
        kernels.index_people(prediction, self.slices, around, 0, 1, self.arrays)

    def at(
        self,
        slice_index: int,
        positions: ArrayLike,
        heights: ArrayLike,
        velocities: ArrayLike,
        closing_weight: float,
        radius_m: float = _RADIUS_M,
    ) -> NDArray[np.float64]:
        """Risk of N configurations, float64 (N,); positions and velocities (N, 2), heights (N,).

        It is that for agents of a radius that is known to the field (`contact_row`).
        """
        if slice_index not in range(self.slices + 1):
            raise ValueError(f"slices are 0..{self.slices}, got {slice_index}")
        points, cells = self.grid.on_ground(positions, heights)
        v = np.ascontiguousarray(velocities, dtype=np.float64).reshape(-1, 2)
        out = np.empty(len(points))
        kernels.risk_many(
            self.grid.arrays,
            self.arrays,
            self.contact_row(radius_m),
            slice_index,
            cells,
            points,
            v,
            closing_weight,
            out,
        )
        return out
