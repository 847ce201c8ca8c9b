"""What became of actors on their ways, measured from where they were at each tick."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid
from esplanade.planning.routes.potential import Potential

Floats = NDArray[np.float64]

STUCK_S: Final = 20.0
"""Who comes no nearer to the goal in this time,"""
PROGRESS_M: Final = 0.5
"""by this much of the way left, is stuck."""


@dataclass(frozen=True)
class Walks:
    """Where A actors were at T + 1 ticks, and how far they had to go; everyone walks alike."""

    positions: Floats
    """(T + 1, A, 2), metres."""
    left_m: Floats
    """(T + 1, A), way left to each one's goal, around walls."""
    tick_s: float
    radius_m: float
    speed_mps: float
    tolerance_m: float

    @property
    def clearances_m(self) -> Floats:
        """(A, A): smallest distance, skin to skin, of every two at any time; inf on the diagonal.

        Everyone goes straight from tick to tick, so that the nearest is found between them too.
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
        """(A,): when each first came within the tolerance of its goal; inf if never."""
        there = self.left_m <= self.tolerance_m
        return np.where(there.any(axis=0), there.argmax(axis=0) * self.tick_s, np.inf)

    @property
    def time_ratios(self) -> Floats:
        """(A,): time against that of the same way alone at the preferred speed; inf if never."""
        return np.asarray(self.arrivals_s * self.speed_mps / self.left_m[0])

    @property
    def stuck(self) -> NDArray[np.bool_]:
        """(A,): who made no progress for too long before arriving."""
        window = round(STUCK_S / self.tick_s)
        best = np.minimum.accumulate(self.left_m, axis=0)
        slow = best[:-window] - best[window:] < PROGRESS_M
        ends_s = self.tick_s * np.arange(window, len(best))[:, None]
        return np.asarray((slow & (ends_s <= self.arrivals_s)).any(axis=0))


@dataclass(frozen=True)
class Verdict:
    """What a scene came to."""

    actors: int
    contacts: int
    """Pairs whose discs ever overlapped."""
    clearance_m: float
    """Smallest, skin to skin."""
    arrived_percent: float
    last_s: float | None
    """When the last arrived; None when somebody did not."""
    time_ratio: float | None
    """Mean of those who arrived; None when nobody did."""
    worst_time_ratio: float | None
    stuck: int
    tick_p50_ms: float
    tick_p99_ms: float


def judge(walks: Walks, tick_ms: Floats) -> Verdict:
    """Put the measures of one scene together; milliseconds are of its ticks."""
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
    """(T, A): way from each of (T, A, 2) positions to the actor's goal, (A, 2), around walls."""
    floors = np.zeros(len(positions), dtype=np.int64)
    columns = [
        Potential(grid, (x, y), 0, radius_m).distance(positions[:, a], floors)
        for a, (x, y) in enumerate(goals.tolist())
    ]
    return np.stack(columns, axis=1)
