"""A wave front that spreads from a goal, as far as it is wanted and a piece at a time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.grid._grid_kernels import anchor_at
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.routes import _potential_kernels as kernels
from esplanade.planning.routes._edge_wave_kernels import spread_over_edges
from esplanade.planning.routes.shut_way import Disc, without_places
from esplanade.planning.scene.bodies import Body

NO_TARGETS: Final = np.empty(0, dtype=np.int64)
"""Without targets a wave is wanted everywhere."""

_ALL_CELLS: Final = 2**62


class Wave(Enum):
    """The measure of distance of a wave front."""

    SIGHT = 24.0
    """It goes along lines of sight of at most 24 m, so that they cost no more in a large zone."""
    NF1 = 0.0
    """It goes from cell to cell."""


class WaveFront:
    """Waypoints and distances to one goal, of the cells that the wave has reached so far.

    It stays on the grid as it was when the wave began: a door that moves later changes nothing.
    Where the body's bound on cells on edges in a row can bind (`LayeredGrid.bounds_edges`), they
    are counted, and the wave spreads at once. Memory is 21 bytes a cell, and 16 for each entry of
    the heap.
    """

    def __init__(
        self,
        grid: LayeredGrid,
        goal: tuple[float, float],
        cell: int,
        radius_m: float,
        wave: Wave,
        body: Body,
        shut: Sequence[Disc] = (),
    ) -> None:
        """`shut` are places that count as solid."""
        self.goal = goal
        self.cell = cell
        row = grid.row_of(body)
        self.arrays = without_places(grid.arrays, row, radius_m, shut) if shut else grid.arrays
        """The clearances that the wave goes by; those of the grid, until a door moves."""
        cells = len(self.arrays.layered.floors)
        self.values: NDArray[np.float32] = np.empty((cells, 4), dtype=np.float32)
        """`PotentialValues` of the cells that are settled."""
        self.settled: NDArray[np.uint8] = np.empty(cells, dtype=np.uint8)
        """(N,): 1 where a cell's values are final."""
        self._spreads = np.empty(cells, dtype=np.float32)
        self._heap = np.empty(8 * cells + 1), np.empty(8 * cells + 1, dtype=np.int64)
        self._state = np.zeros(2, dtype=np.int64)
        self._ground = self.arrays, row, radius_m, wave.value
        self._counted: tuple[int, NDArray[np.uint8]] | None = None
        if grid.bounds_edges(body):
            classes = grid.traversability.of(kind_of(body)).classes
            self._counted = body.edge_cells, classes
        x, y = goal if wave is Wave.SIGHT else anchor_at(self.arrays, row, cell)
        kernels.begin_wave(
            cell, x, y, self.values, self.settled, self._spreads, *self._heap, self._state
        )

    def anchors(self, cells: NDArray[np.int64]) -> NDArray[np.float64]:
        """The points of some cells (K,) that the wave leads over, float64 (K, 2), metres."""
        row = self._ground[1]
        found = [anchor_at(self.arrays, row, cell) for cell in cells.tolist()]
        return np.array(found, dtype=np.float64).reshape(-1, 2)

    @property
    def reached_cells(self) -> int:
        """Number of cells whose values are final."""
        return int(self._state[1])

    def grow(
        self,
        targets: NDArray[np.int64],
        margin_m: float = 0.0,
        most_cells: int = _ALL_CELLS,
        within_m: float = math.inf,
    ) -> bool:
        """Spread until `margin_m` beyond the nearest of some cells (K,), or everywhere without any,
        and no further than `within_m` from the goal, unless cells on edges are counted.

        Returns whether that is done, or the wave is over. At most `most_cells` cells are settled in
        one call, in some 3 µs each; no interpreter lock is held. However far it has got, what is
        settled is the same as of a wave that has spread everywhere.
        """
        if self._counted is not None:
            most_edges, classes = self._counted
            self._counted = None
            arrays, row, radius_m, sight_m = self._ground
            self._state[0] = 0
            self._state[1] = spread_over_edges(
                arrays,
                row,
                radius_m,
                most_edges,
                sight_m,
                self.cell,
                classes,
                self.values,
                self.settled,
            )
        return kernels.grow_wave(
            *self._ground,
            self.values,
            self.settled,
            self._spreads,
            *self._heap,
            self._state,
            targets,
            margin_m,
            within_m,
            most_cells,
        )
