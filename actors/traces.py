"""The account of an actor's decision: the search, the paths that were compared, their costs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import SearchStatus

Floats = NDArray[np.float64]
Winner = Literal["first", "forced", "search", "perturbation", "kept", "not_due"]

COST_PARTS: Final = (
    *("time", "risk", "others", "turn", "wall", "hurry", "keep_right"),
    "total",
)
"""The parts of the cost of a path, in the order of `PricedPath.cost`, and their sum."""


@dataclass(frozen=True)
class PricedPath:
    """A path, slice by slice from the tick's beginning, and what it was thought to cost."""

    places: Floats
    """float64 (K, 3) m."""
    cost: Floats
    """float64 (8,) seconds, as in `COST_PARTS`."""
    mean_risk: float
    legal: bool

    @property
    def total_s(self) -> float:
        """The whole cost, seconds."""
        return float(self.cost[-1])


@dataclass(frozen=True)
class Decided:
    """The path that an actor has taken in the last tick, and the one that it followed before."""

    taken: PricedPath
    previous: PricedPath | None
    """As it was before perturbation, seen from that tick; None for an actor that had none."""


@dataclass(frozen=True)
class SearchTree:
    """The nodes of a search: those expanded, in their order, then those left open."""

    status: SearchStatus
    expansions: int
    budget: int
    nodes: Floats
    """float64 (N, 7): x, y, z m, seconds ahead, row of the parent or -1, cost so far in seconds,
    number of the expansion or -1."""
    left_out: int
    """Nodes that were left open and are not among `nodes`."""


@dataclass(frozen=True)
class RiskSlices:
    """The risk of standing around an actor, over time."""

    origin_m: tuple[float, float]
    cell_m: float
    times_s: Floats
    values: NDArray[np.float32]
    """float32 (S, rows from the south, columns from the west)."""


@dataclass(frozen=True)
class Trace:
    """The last decision of an actor."""

    exact: bool
    """Whether deciding once more led to the very same, bit by bit. It may not once the ground has
    changed."""
    decided: Decided
    searched: PricedPath | None
    """The best path of the search, None if there is none."""
    perturbed: PricedPath | None
    """The path followed before, perturbed where that paid."""
    winner: Winner
    hysteresis_s: float
    """A new path must cost less than the one before by this."""
    tree: SearchTree
    risk: RiskSlices
