"""Verdicts on actors on their way to goals, from their places at each tick."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid
from esplanade.planning.routes.potential import Potential

Floats = NDArray[np.float64]

STUCK_S: Final = 20.0
PROGRESS_M: Final = 0.5
"""An actor is stuck if it comes less than this nearer to its goal in the time above."""


@dataclass(frozen=True)
class Walks:
    """Places of A actors at T + 1 ticks, and the distances left to their goals."""

    positions: Floats
    """(T + 1, A, 2), metres."""
    left_m: Floats
    """(T + 1, A), metres: length of the path left to each one's goal, around walls."""
    tick_s: float
    radius_m: float
    speed_mps: float
    tolerance_m: float

    @property
    def clearances_m(self) -> Floats:
        """(A, A), metres: smallest distance of any two, skin to skin; inf for oneself.

        Everyone goes straight from tick to tick, so distances are smallest between ticks as well.
        """
        rows, columns = np.triu_indices(self.positions.shape[1], 1)
        nearest = np.full(len(rows), np.inf)
        for old, new in zip(self.positions[:-1], self.positions[1:], strict=True):
            offset = old[rows] - old[columns]
            change = new[rows] - new[columns] - offset
            square = (change * change).sum(axis=1)
            share = -(offset * change).sum(axis=1) / np.where(square < 1e-12, np.inf, square)
            offset += np.clip(share, 0.0, 1.0)[:, None] * change
            np.minimum(nearest, (offset * offset).sum(axis=1), out=nearest)
        found = np.full((self.positions.shape[1],) * 2, np.inf)
        found[rows, columns] = found[columns, rows] = np.sqrt(nearest) - 2.0 * self.radius_m
        return found

    @property
    def arrivals_s(self) -> Floats:
        """(A,): time at which each first came within the tolerance of its goal; inf if never."""
        there = self.left_m <= self.tolerance_m
        return np.where(there.any(axis=0), there.argmax(axis=0) * self.tick_s, np.inf)

    @property
    def time_ratios(self) -> Floats:
        """(A,): ratio of the time to that of an actor alone at preferred speed; inf if never."""
        return np.asarray(self.arrivals_s * self.speed_mps / self.left_m[0])

    @property
    def stuck(self) -> NDArray[np.bool_]:
        """(A,): whether each made no progress for too long before it arrived."""
        window = round(STUCK_S / self.tick_s)
        best = np.minimum.accumulate(self.left_m, axis=0)
        slow = best[:-window] - best[window:] < PROGRESS_M
        ends_s = self.tick_s * np.arange(window, len(best))[:, None]
        return np.asarray((slow & (ends_s <= self.arrivals_s)).any(axis=0))


@dataclass(frozen=True)
class Verdict:
    """The figures of one scene."""

    actors: int
    contacts: int
    """Number of pairs whose discs ever overlapped."""
    clearance_m: float
    """Smallest distance, skin to skin."""
    arrived_percent: float
    last_s: float | None
    """Time at which the last one arrived; None if not all did."""
    time_ratio: float | None
    """Mean over those that arrived; None if none did."""
    worst_time_ratio: float | None
    stuck: int
    tick_p50_ms: float
    tick_p99_ms: float


def judge(walks: Walks, tick_ms: Floats) -> Verdict:
    """Judge one scene, whose ticks took tick_ms, milliseconds."""
    clearances = walks.clearances_m
    arrived = np.isfinite(walks.arrivals_s)
    ratios = walks.time_ratios[arrived]
    return Verdict(
        actors=len(clearances),
        contacts=int((clearances < 0.0).sum()) // 2,
        clearance_m=float(clearances.min()),
        arrived_percent=100.0 * float(arrived.mean()),
        last_s=float(walks.arrivals_s.max()) if arrived.all() else None,
        time_ratio=float(ratios.mean()) if len(ratios) else None,
        worst_time_ratio=float(ratios.max()) if len(ratios) else None,
        stuck=int(walks.stuck.sum()),
        tick_p50_ms=float(np.percentile(tick_ms, 50)),
        tick_p99_ms=float(np.percentile(tick_ms, 99)),
    )


def ways_left(grid: LayeredGrid, positions: Floats, goals: Floats, radius_m: float) -> Floats:
    """Lengths (T, A) of the paths around walls from positions (T, A, 2) to goals (A, 2), metres."""
    floors = np.zeros(len(positions), dtype=np.int64)
    columns = [
        Potential(grid, (x, y), 0, radius_m).distance(positions[:, a], floors)
        for a, (x, y) in enumerate(goals.tolist())
    ]
    return np.stack(columns, axis=1)
