"""The potential of a goal, which guides the search: the distance to the goal from everywhere.

Lei & Li guide their search by NF1 (after Barraquand & Latombe): a wave front that spreads from
the goal over free cells. NF1 measures along the grid, up to 8 % too long and in eight directions
only; `Wave.SIGHT` spreads the same front but measures along straight lines of sight, so that paths
are shortest at any angle. `Wave.NF1` stays as the reference.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.routes import _potential_kernels as kernels
from esplanade.planning.routes.shut_way import Disc
from esplanade.planning.routes.wave_front import NO_TARGETS, Wave, WaveFront
from esplanade.planning.scene.bodies import Body

_LEFT_ALONE = 255
_MOVED_M = 0.5
"""Greatest distance that a goal is moved to where the disc fits."""


class Potential:
    """Distances and directions to one goal for discs of one radius and kind of body.

    Where the disc does not fit at the goal, they lead to the nearest place where it fits, if that
    is within half a metre. Cost O(cells log cells) once; a look-up is O(1).

    Raises
    ------
    ValueError
        Nobody can stand at the goal, nor within two cells of it.
    """

    def __init__(
        self,
        grid: LayeredGrid,
        goal: tuple[float, float],
        height: float,
        radius_m: float,
        wave: Wave = Wave.SIGHT,
        body: Body | None = None,
        shut: Sequence[Disc] = (),
        within_m: float = math.inf,
    ) -> None:
        """`shut` are places where somebody stands, which ways lead around as if they were solid.

        No path leads from cells further than `within_m` from the goal, which costs less; where
        cells on edges are counted it may.
        """
        self.grid = grid
        self.height = height
        self.radius_m = radius_m
        self.body = body or Body.adult()
        row = grid.row_of(self.body)
        if not grid.is_free([goal], [height], radius_m, self.body)[0]:
            free = grid.nearest_free(goal, height, radius_m, self.body)
            goal = free if free and math.dist(goal, free) <= _MOVED_M else goal
        self.goal = goal
        cell = int(grid.on_ground([goal], [height])[1][0])
        if cell < 0:
            raise ValueError(f"nobody can stand at the goal {goal}, height {height:g} m")
        front = WaveFront(grid, goal, cell, radius_m, wave, self.body, shut)
        front.grow(NO_TARGETS, within_m=within_m)
        self.values: NDArray[np.float32] = front.values
        if within_m < math.inf:
            self.values[front.settled == 0, 0] = np.inf
        self.reached_cells = front.reached_cells
        if wave is Wave.SIGHT:
            if shut or within_m < math.inf:
                further = (front.settled == 0) & (front.arrays.kinds.steps[row] != 0)
                front.settled[further] = _LEFT_ALONE
            if grid.bounds_edges(self.body):
                front.settled[self._too_far_on_edges(front, row)] = _LEFT_ALONE
            kernels.extend_into_obstacles(front.arrays, row, self.values, front.settled)

    def _too_far_on_edges(self, front: WaveFront, row: int) -> NDArray[np.bool_]:
        """Mark cells that steps lead from, but no way, since it would be on edges for too long.

        Least of all one leads past obstacles there.
        """
        regions = self.grid.traversability.regions_of(self.body)
        unsettled = front.settled == 0
        reached = np.isin(regions, np.unique(regions[~unsettled])) & (regions >= 0)
        walkable = reached & (front.arrays.kinds.steps[row] != 0)
        left_alone: NDArray[np.bool_] = unsettled & (self.grid.arrays.edges[row] | walkable)
        return left_alone

    def distance(self, positions: ArrayLike, heights: ArrayLike) -> NDArray[np.float64]:
        """Metres to the goal, float64 (N,), inf where no path leads, for (N, 2) and (N,)."""
        points, cells = self.grid.on_ground(positions, heights)
        out = np.empty(len(points))
        kernels.distances(*self._looked_up(), cells, points, out)
        return out

    def direction(self, positions: ArrayLike, heights: ArrayLike) -> NDArray[np.float64]:
        """Unit vectors down the potential, float64 (N, 2); zero at the goal or without a path."""
        points, cells = self.grid.on_ground(positions, heights)
        out = np.empty((len(points), 2))
        kernels.directions(*self._looked_up(), cells, points, out)
        return out

    def _looked_up(self) -> tuple[GridArrays, NDArray[np.float32], int, float]:
        return self.grid.arrays, self.values, self.grid.row_of(self.body), self.radius_m
