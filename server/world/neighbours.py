"""The neighbours of everyone: one search tree, made anew in each tick."""

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from esplanade.planning.scene.heights import BODIES_OVERLAP_M
from esplanade.server.world.state import Floats, Slots, State

STOREY_WEIGHT = 3.0
"""A metre up or down counts this many metres: avatars on other floors come into view later."""


class Neighbours:
    """Everyone's place in this tick. Valid until somebody moves."""

    def __init__(self, state: State) -> None:
        self._capacity = state.capacity
        self._slots = state.live()
        self._points = np.empty((state.capacity, 3))
        self._points[:, :2] = state.positions
        self._points[:, 2] = state.heights * STOREY_WEIGHT
        self._heights = state.heights.copy()
        self._tree = cKDTree(self._points[self._slots], balanced_tree=False, compact_nodes=False)

    def nearest(self, slots: Slots, count: int, within_m: float) -> tuple[Floats, Slots]:
        """The nearest of everyone to each of N avatars, themselves among them.

        Returns
        -------
        float (N, count) metres, ascending, inf where there are fewer;
        int (N, count) slots, the state's capacity where there are fewer.
        """
        distances, found = self._tree.query(
            self._points[slots], k=range(1, count + 1), distance_upper_bound=within_m
        )
        return distances, np.append(self._slots, self._capacity)[found]

    def within(self, slots: Slots, reach_m: float) -> tuple[Slots, Slots]:
        """All pairs (avatar of N, other) on one level and not further apart than `reach_m` on the
        map: int (M,), int (M,)."""
        radius = float(np.hypot(reach_m, BODIES_OVERLAP_M * STOREY_WEIGHT))
        found = self._tree.query_ball_point(self._points[slots], radius, return_sorted=True)
        counts = [len(row) for row in found]
        others = np.fromiter((i for row in found for i in row), dtype=np.int64, count=sum(counts))
        first: npt.NDArray[np.int64] = np.repeat(slots, counts)
        second = self._slots[others]
        apart_m = np.hypot(*(self._points[first, :2] - self._points[second, :2]).T)
        level = np.abs(self._heights[first] - self._heights[second]) < BODIES_OVERLAP_M
        pairs = (first != second) & level & (apart_m <= reach_m)
        return first[pairs], second[pairs]
