"""Bodies that stand in a way: whether they shut it, and the ground without their places."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.routes import _shut_way_kernels as kernels
from esplanade.planning.scene.heights import BODIES_OVERLAP_M
from esplanade.planning.traversal._anchor_kernels import PARTS

Disc = tuple[float, float, float, float]
"""x, y, the height of the feet and a radius, metres: a place where somebody stands."""


class Around(NamedTuple):
    """A way around places where somebody stands, to a goal from no further than `within_m`."""

    places: tuple[Disc, ...]
    within_m: float


REACH_M: Final = kernels.AHEAD_M + 2.0 * kernels.AROUND_M
"""Bodies whose discs are further away than this from where a look begins shut nothing."""
_NEVER_M: Final = -3.0
"""The clearance of a cell where nobody fits; it outweighs those of its neighbours."""
_SLACK_M: Final = 0.007


class ShutWays:
    """Looks along the routes of bodies on one ground. Memory is some 30 bytes a cell."""

    def __init__(self, cells: int) -> None:
        samples = int(kernels.AHEAD_M / kernels.SAMPLE_M)
        around = min(cells, 4096)
        self._space = kernels.LookingSpace(
            np.empty((samples, 2)),
            np.empty(samples, dtype=np.int64),
            np.empty(samples, dtype=np.bool_),
            np.empty(cells, dtype=np.float32),
            np.zeros(cells, dtype=np.int64),
            np.zeros(1, dtype=np.int64),
            np.empty(8 * around + 8),
            np.empty(8 * around + 8, dtype=np.int64),
        )

    def shut_by(
        self,
        grid: GridArrays,
        row: int,
        potential: NDArray[np.float32],
        cell: int,
        place: tuple[float, float],
        bodies: NDArray[np.float64],
        room_m: float,
        detour_m: float,
    ) -> NDArray[np.bool_]:
        """Mark those of `bodies` (K, 4), as `Disc`, that shut the route down a potential.

        Parameters
        ----------
        row : row of the kind of body that goes there, in the grid's clearances
        cell, place : where it is, metres
        room_m : its radius, with the room that it keeps to bodies that stand
        detour_m : a way around them may be longer than the route by this much

        Returns
        -------
        bool (K,); none is marked where the way is open. Cost O(metres ahead × K), and O(cells near)
        for each place where somebody stands in the route.
        """
        marks = np.zeros(len(bodies), dtype=np.bool_)
        kernels.look_along(
            grid, row, potential, cell, *place, bodies, room_m, detour_m, self._space, marks
        )
        return marks

    def any_shut(
        self,
        grid: GridArrays,
        rows: NDArray[np.int64],
        potentials: NDArray[np.float32],
        slots: NDArray[np.int64],
        cells: NDArray[np.int64],
        places: NDArray[np.float64],
        bodies: NDArray[np.float64],
        rooms_m: NDArray[np.float64],
        detour_m: float,
    ) -> NDArray[np.bool_]:
        """Tell for each of N that look whether any of the bodies (K, 4) shuts its route, bool (N,).

        `rows`, `cells`, `places` and `rooms_m` are those of `shut_by`, for each of them; the route
        of each is down `potentials[slots]`. Cost as of `shut_by` for each, of bodies in reach.
        """
        shut = np.zeros(len(rows), dtype=np.bool_)
        reach_m = REACH_M + (float(bodies[:, 3].max()) if len(bodies) else 0.0)
        kernels.look_along_each(
            *(grid, rows, potentials, slots, cells, places, bodies, rooms_m, reach_m),
            *(detour_m, self._space, shut),
        )
        return shut


def without_places(
    grid: GridArrays, row: int, radius_m: float, discs: Sequence[Disc]
) -> GridArrays:
    """The ground as it would be for one kind of body if discs were solid. Cost O(cells × discs).

    An anchor keeps `radius_m` to a disc, as where a look at ways leads. Only the clearances and
    steps of the kind in `row` are others.
    """
    layered = grid.layered
    clearance, steps = grid.clearance.copy(), grid.kinds.steps.copy()
    x, y = _anchors(grid, row)
    own = clearance[row]
    for at_x, at_y, z_m, disc_m in discs:
        with np.errstate(invalid="ignore"):
            level = np.abs(layered.floors - z_m) < BODIES_OVERLAP_M
        room = np.hypot(x - at_x, y - at_y) - disc_m
        fits = room >= radius_m - _SLACK_M
        np.minimum(own, np.where(level, np.where(fits, room, _NEVER_M), own), out=own)
        shut = np.flatnonzero(level & ~fits)
        steps[row, shut] = 0
        for direction in range(8):
            others = layered.links[shut, direction]
            others = others[others >= 0]
            steps[row, others] &= np.uint8(255 - (1 << ((direction + 4) & 7)))
    return grid._replace(clearance=clearance, kinds=grid.kinds._replace(steps=steps))


def _anchors(grid: GridArrays, row: int) -> NDArray[np.float64]:
    """The points of all cells that paths of one kind of body go through, float64 (2, N), metres."""
    layered, kinds = grid.layered, grid.kinds
    places = np.stack([layered.places["column"] + 0.5, layered.places["row"] + 0.5])
    moved = np.flatnonzero(kinds.first[row] >= 0)
    entries = kinds.first[row, moved] + kinds.measures[row]["entries"]
    places[:, moved] += kinds.offsets[entries].T / PARTS
    return np.array([[layered.x0], [layered.y0]]) + places * layered.cell_m
