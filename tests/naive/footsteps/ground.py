"""The ground under feet: its exact height, and the treads that a foot can be put on."""

from __future__ import annotations

from typing import Final

import numpy as np

from esplanade.actors.locomotion.planted.footprints import HEADING, ON_MAP, Z
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.compiled.arrays import Bools, Floats, Ints

NEAR_M: Final = 0.6
"""Ground that is further up or down than this does not count for the next step."""

_HEADROOM_M: Final = 0.05
"""A higher solid whose bottom is less than this above a top buries it."""
_SAME_M: Final = 1e-3
"""Tops that differ by less are one."""
_EVEN_M: Final = 0.03
"""Heel and toe whose heights differ by less are on one tread, or on a slope."""
_TOE_SHARE: Final = 0.85
"""Share of a foot, from the heel, that must be on its tread."""
_SHIFTS_M: Final = np.array([s * k * 0.025 for k in range(1, 9) for s in (1.0, -1.0)])
"""Distances by which a foot may be moved along itself to be on one tread, the least first."""


class Ground:
    """The standing surfaces of a zone.

    Solids are known exactly; of a mesh only the heights of its cells are known.
    """

    def __init__(self, scene: Scene, grid: LayeredGrid) -> None:
        self._grid = grid
        self.flat = bool(grid.arrays.flat)
        solids = () if scene.mesh is not None else scene.solids()
        self._exact = scene.mesh is None
        corners = max((len(solid.points) for solid in solids), default=1)
        self._rings = np.empty((len(solids), corners, 2))
        for row, solid in enumerate(solids):
            self._rings[row] = solid.points[-1]
            self._rings[row, : len(solid.points)] = solid.points
        self._low = self._rings.min(axis=1, initial=np.inf)
        self._high = self._rings.max(axis=1, initial=-np.inf)
        self._solids = solids
        self._bottoms = np.array([solid.offset_m for solid in solids])
        self._carries = np.array([solid.carries for solid in solids], dtype=np.bool_)
        self._level = np.array([solid.ramp is None for solid in solids], dtype=np.bool_)
        self._tops = np.array([solid.offset_m + solid.height_m for solid in solids])

    def height(self, points: Floats, near_m: Floats) -> Floats:
        """Heights of the ground at points.

        Parameters
        ----------
        points : float64 (N, 2), metres
        near_m : float64 (N,), metres
            Of several surfaces at a point the one nearest to this height is meant.

        Returns
        -------
        float64 (N,), metres
            nan where there is no ground within NEAR_M, as over an edge or in a wall.
        """
        if self.flat:
            return np.zeros(len(points))
        if not self._exact:
            return self._cell_heights(points, near_m)
        rows, solids = self._covering(points)
        most = int(np.bincount(rows, minlength=1).max(initial=0))
        place = np.arange(len(rows)) - np.searchsorted(rows, rows)
        bottoms = np.full((len(points), most + 1), np.inf)
        tops = np.full((len(points), most + 1), np.nan)
        tops[:, most] = 0.0
        buries = np.full((len(points), most + 1), -np.inf)
        bottoms[rows, place] = self._bottoms[solids]
        found = self._tops_at(points, rows, solids)
        buries[rows, place] = found
        tops[rows, place] = np.where(self._carries[solids], found, np.nan)
        under = bottoms[:, None, :] < tops[..., None] + _HEADROOM_M
        buried = (under & (buries[:, None, :] > tops[..., None] + _SAME_M)).any(axis=2)
        away = np.where(buried | np.isnan(tops), np.inf, np.abs(tops - near_m[:, None]))
        best = away.argmin(axis=1)
        every = np.arange(len(points))
        return np.where(away[every, best] <= NEAR_M, tops[every, best], np.nan)

    def settle(self, footprints: Floats, foot_m: Floats) -> tuple[Floats, Bools]:
        """Put feet on the ground.

        A foot that would hang over the edge of a tread is moved along itself until it does not,
        by up to 20 cm. On a slope it lies at the height of its middle.

        Parameters
        ----------
        footprints : float64 (N, 4), metres and radians
            Their heights are about what is expected.
        foot_m : float64 (N,), metres

        Returns
        -------
        float64 (N, 4) footprints, and bool (N,) whether there is ground at all
        """
        out = footprints.copy()
        if self.flat:
            out[:, Z] = 0.0
            return out, np.ones(len(out), dtype=np.bool_)
        heel, toe = self._ends(out, foot_m, np.zeros(len(out)))
        even = np.abs(heel - toe) < _EVEN_M
        hanging = np.flatnonzero(~even)
        if len(hanging):
            count = len(_SHIFTS_M)
            tried = np.repeat(out[hanging], count, axis=0)
            shifts = np.tile(_SHIFTS_M, len(hanging))
            heels, toes = self._ends(tried, np.repeat(foot_m[hanging], count), shifts)
            good = (np.abs(heels - toes) < _EVEN_M).reshape(len(hanging), count)
            first = good.argmax(axis=1)
            moved = good.any(axis=1)
            rows, shift = hanging[moved], _SHIFTS_M[first[moved]]
            out[rows, 0] += shift * np.cos(out[rows, HEADING])
            out[rows, 1] += shift * np.sin(out[rows, HEADING])
            heel[rows] = heels.reshape(len(hanging), count)[moved, first[moved]]
            toe[rows] = toes.reshape(len(hanging), count)[moved, first[moved]]
        found = np.isfinite(heel)
        sloped = np.where(np.abs(heel - toe) < _EVEN_M, 0.5 * (heel + toe), heel)
        out[:, Z] = np.where(found, sloped, out[:, Z])
        return out, found

    def _ends(self, footprints: Floats, foot_m: Floats, shifts: Floats) -> tuple[Floats, Floats]:
        """Heights under heels and toes of footprints (N, 4) that are moved along themselves."""
        ahead = np.stack([np.cos(footprints[:, HEADING]), np.sin(footprints[:, HEADING])], axis=1)
        heel = footprints[:, ON_MAP] + shifts[:, None] * ahead
        toe = heel + (_TOE_SHARE * foot_m)[:, None] * ahead
        heights = self.height(
            np.concatenate([heel, toe]), np.concatenate([footprints[:, Z], footprints[:, Z]])
        )
        return heights[: len(heel)], heights[len(heel) :]

    def _covering(self, points: Floats) -> tuple[Ints, Ints]:
        """Pairs (point, solid) where the point is inside the solid's ring, ordered by point."""
        boxed = (points[:, None] >= self._low) & (points[:, None] <= self._high)
        rows, solids = np.nonzero(boxed.all(axis=2))
        rings = self._rings[solids]
        x, y = points[rows, 0, None], points[rows, 1, None]
        x0, y0 = rings[..., 0], rings[..., 1]
        x1, y1 = np.roll(x0, 1, axis=1), np.roll(y0, 1, axis=1)
        crossing = (y0 > y) != (y1 > y)
        rise = np.where(crossing, y1 - y0, 1.0)
        left = x < x0 + (y - y0) * (x1 - x0) / rise
        inside = (crossing & left).sum(axis=1) % 2 == 1
        return rows[inside], solids[inside]

    def _tops_at(self, points: Floats, rows: Ints, solids: Ints) -> Floats:
        """Heights of the tops of solids at points, for the pairs of `_covering`."""
        tops: Floats = self._tops[solids]
        for pair in np.flatnonzero(~self._level[solids]).tolist():
            x, y = points[rows[pair]].tolist()
            tops[pair] = self._solids[int(solids[pair])].top_at(x, y)
        return tops

    def _cell_heights(self, points: Floats, near_m: Floats) -> Floats:
        """Return the same as `height`, from the cells of the grid."""
        _, cells = self._grid.on_ground(points, near_m)
        floors = np.where(cells >= 0, self._grid.layered.floors[cells], np.nan)
        return np.where(np.abs(floors - near_m) <= NEAR_M, floors, np.nan)
