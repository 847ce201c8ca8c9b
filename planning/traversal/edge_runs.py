"""How long a body can stay on edges at all, so that M is counted only where it can bind."""

from __future__ import annotations

import numpy as np

from esplanade.planning.ground.floors import Floors
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal import _edge_run_kernels as kernels
from esplanade.planning.traversal._stability_kernels import FORBIDDEN, STABLE
from esplanade.planning.traversal.cache import TraversabilityCache


class EdgeRuns:
    """The longest runs of cells on edges in a zone, by kind of body; each is found once.

    All doors count as open, so that a door that moves changes nothing.
    """

    def __init__(self, floors: Floors) -> None:
        self._floors = floors
        self._longest: dict[Body, float] = {}

    def longest(self, kind: Body, traversability: TraversabilityCache) -> float:
        """No shortest path of this kind of body has more cells on edges in a row. Cost O(cells)."""
        longest = self._longest.get(kind)
        if longest is None:
            barriers = self._floors.barriers.copy()
            for name in self._floors.doors:
                self._floors.doors.set_open(name, True, barriers)
            found = traversability.prepare(kind, barriers).traversability
            edges = (found.classes != STABLE) & (found.classes != FORBIDDEN)
            edges &= ~np.isnan(found.arrays.floors)
            longest = kernels.longest_run(found.arrays.links, found.steps, edges)
            self._longest[kind] = longest
        return longest
