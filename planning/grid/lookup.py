"""Looking up which cells places are in, and how high the ground is there."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.planning.grid import _grid_kernels as kernels
from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.ground.layered import LayeredArrays


class PlaceLookup:
    """Answers for many places at once, given by x, y and a height, in metres."""

    arrays: GridArrays

    @property
    def layered(self) -> LayeredArrays:
        """Floors, ceilings and links of the cells."""
        return self.arrays.layered

    def as_points(
        self, positions: ArrayLike, heights: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions as float64 (N, 2) and heights as float64 (N,), checked.

        Raises
        ------
        ValueError
            Wrong shapes, or numbers that are not finite.
        """
        points = np.ascontiguousarray(positions, dtype=np.float64).reshape(-1, 2)
        levels = np.ascontiguousarray(heights, dtype=np.float64).reshape(-1)
        if len(points) != len(levels):
            raise ValueError(f"{len(points)} positions but {len(levels)} heights")
        if not (np.isfinite(points).all() and np.isfinite(levels).all()):
            raise ValueError("positions and heights must be finite")
        return points, levels

    def on_ground(
        self, positions: ArrayLike, heights: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Positions float64 (N, 2) and the cells int64 (N,) that are stood in there.

        The cell is that of the surface nearest in height, if need be up to two cells aside; it is
        -1 where nobody can stand.
        """
        points, levels = self.as_points(positions, heights)
        cells = np.empty(len(points), dtype=np.int64)
        kernels.surfaces_at(self.arrays, points, levels, cells)
        return points, cells

    def with_heights(
        self, paths: NDArray[np.float64], cells: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """A paths (A, K, 2) that begin in cells (A,) with their heights, float64 (A, K, 3)."""
        out = np.zeros((*paths.shape[:2], 3))
        out[:, :, :2] = paths
        if not self.arrays.flat:
            kernels.heights_along(self.arrays, cells, out)
        return out

    def floor_at(self, position: tuple[float, float], height: float) -> float:
        """Height of the standing surface nearest in height; `height` itself if there is none."""
        cell = int(self.on_ground([position], [height])[1][0])
        return float(self.layered.floors[cell]) if cell >= 0 else height

    def layers_at(self, positions: ArrayLike, heights: ArrayLike) -> NDArray[np.int64]:
        """`layer_at` for (N, 2), (N,): int64 (N,)."""
        return self.layers_of(self.on_ground(positions, heights)[1])

    def layers_of(self, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        """The layers of cells (N,); 0 for -1."""
        return np.where(cells >= 0, self.layered.places["layer"][cells], 0).astype(np.int64)

    def layer_at(self, position: tuple[float, float], height: float) -> int:
        """Layer of the standing surface nearest in height; 0 if there is none."""
        return int(self.layers_at([position], [height])[0])
