"""The ground of a zone as a grid of cells: where a disc may stand and how it slides along walls."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from planning import _geometry_kernels as geometry
from planning._geometry_kernels import SegmentIndex
from planning._grid_kernels import GridArrays, cell_at, clearance_many
from planning._layered import LayeredArrays, cell_near
from planning.barriers import Barriers
from planning.doors import Doors
from planning.floors import Floors, floors_of_mesh, floors_of_scene
from planning.mesh_file import Up
from planning.meshes import Progress, unheard
from planning.potential import Potential
from planning.scene import Scene
from planning.surfaces import Surfaces

CLEARANCE_CAP_M = 3.0
"""Distances to obstacles are kept up to here; further is as good as far."""
_BUCKET_M = 1.0
_BUCKET_REACH_M = 1.5
_POTENTIALS_BYTES = 256 * 2**20

Segments = NDArray[np.float64]


def scene_segments(scene: Scene) -> Segments:
    """Every wall and polygon edge of a scene, float64 (S, 4): x0, y0, x1, y1."""
    rows = [(*wall.start, *wall.end) for wall in scene.walls]
    for polygon in scene.polygons:
        ring = polygon.points
        rows.extend((*a, *b) for a, b in zip(ring, ring[1:] + ring[:1], strict=True))
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def _index(segments: Segments, bounds: tuple[float, float, float, float]) -> SegmentIndex:
    x0, y0, x1, y1 = bounds
    nx = max(1, math.ceil((x1 - x0) / _BUCKET_M))
    ny = max(1, math.ceil((y1 - y0) / _BUCKET_M))
    lists: list[list[int]] = [[] for _ in range(nx * ny)]
    reach = _BUCKET_REACH_M + _BUCKET_M * math.sqrt(0.5)
    for s, (ax, ay, bx, by) in enumerate(segments):
        i0 = max(0, int((min(ax, bx) - reach - x0) / _BUCKET_M))
        i1 = min(nx - 1, int((max(ax, bx) + reach - x0) / _BUCKET_M))
        j0 = max(0, int((min(ay, by) - reach - y0) / _BUCKET_M))
        j1 = min(ny - 1, int((max(ay, by) + reach - y0) / _BUCKET_M))
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                cx, cy = x0 + (i + 0.5) * _BUCKET_M, y0 + (j + 0.5) * _BUCKET_M
                if geometry.point_segment_distance(cx, cy, ax, ay, bx, by)[0] <= reach:
                    lists[j * nx + i].append(s)
    starts = np.zeros(nx * ny + 1, dtype=np.int64)
    starts[1:] = np.cumsum([len(members) for members in lists])
    members = np.array([s for bucket in lists for s in bucket], dtype=np.int64)
    return SegmentIndex(segments, starts, members, x0, y0, _BUCKET_M, _BUCKET_REACH_M, nx, ny)


class LayeredGrid:
    """Cells of one zone, layer by layer, with the distance from each to the nearest obstacle.

    A disc of radius r may stand where the clearance is at least r: that set is the complement of
    its C-obstacles. Memory is 4 bytes a cell and layer; each cached potential 12 bytes more.
    """

    def __init__(
        self,
        arrays: GridArrays,
        index: SegmentIndex,
        derive_floors: Callable[[], Floors],
    ) -> None:
        self.arrays = arrays
        self.index = index
        self._derive_floors = derive_floors
        self._potentials: OrderedDict[tuple[float, float, int, float], Potential] = OrderedDict()

    @classmethod
    def from_scene(cls, scene: Scene, cell_m: float = 0.25) -> Self:
        """Derive the grid of a scene. Cost O(obstacles × cells near them).

        Raises
        ------
        ValueError
            `cell_m` is not between 0.05 and 2 m; the scene's mesh is at fault.
        """
        if not 0.05 <= cell_m <= 2.0:
            raise ValueError(f"cell_m must lie between 0.05 and 2 m, got {cell_m}")
        if scene.mesh is not None:
            return cls.from_mesh(scene.mesh, cell_m)
        x0, y0, x1, y1 = scene.bounds
        ny = max(1, math.ceil((y1 - y0) / cell_m - 1e-9))
        nx = max(1, math.ceil((x1 - x0) / cell_m - 1e-9))
        segments = scene_segments(scene)
        clearance = np.full((1, ny, nx), CLEARANCE_CAP_M, dtype=np.float32)
        for field in clearance:
            geometry.lower_to_segments(field, segments, x0, y0, cell_m, CLEARANCE_CAP_M)
            for polygon in scene.polygons:
                ring = np.array(polygon.points, dtype=np.float64)
                geometry.negate_inside(field, ring, x0, y0, cell_m)
        arrays = GridArrays(clearance, float(x0), float(y0), float(x1), float(y1), float(cell_m))
        return cls(
            arrays,
            _index(segments, scene.bounds),
            lambda: floors_of_scene(scene, cell_m),
        )

    @classmethod
    def from_mesh(
        cls, path: str | Path, cell_m: float = 0.25, up: Up = "y", progress: Progress = unheard
    ) -> Self:
        """Derive the grid of a building: OBJ, glTF, or whatever else trimesh reads.

        Parameters
        ----------
        up : "y" or "z"
            The file's axis that points up. With "y", its (x, y, z) becomes (x, -z, y).
        progress : what is being done, share of the whole -> None

        Raises
        ------
        MeshError
            The file is at fault; the message names it and says how.
        """
        floors = floors_of_mesh(path, cell_m, up, progress)
        x0, y0, x1, y1 = bounds = floors.surfaces.bounds
        shape = (floors.surfaces.layer_count, floors.surfaces.ny, floors.surfaces.nx)
        clearance = np.full(shape, CLEARANCE_CAP_M, dtype=np.float32)
        for layer, field in enumerate(clearance):
            lines, ground = floors.met_on(layer)
            geometry.lower_to_segments(field, lines, x0, y0, cell_m, CLEARANCE_CAP_M)
            field[~ground] *= -1.0
        arrays = GridArrays(clearance, x0, y0, x1, y1, float(cell_m))
        lines = np.ascontiguousarray(floors.barriers[:, :4])
        return cls(arrays, _index(lines, bounds), lambda: floors)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1 in metres."""
        a = self.arrays
        return a.x0, a.y0, a.x1, a.y1

    @property
    def cell_m(self) -> float:
        """Edge of a cell, metres."""
        return self.arrays.cell_m

    @property
    def layers(self) -> int:
        """Number of layers."""
        return int(self.arrays.clearance.shape[0])

    @cached_property
    def _floors(self) -> Floors:
        return self._derive_floors()

    @property
    def surfaces(self) -> Surfaces:
        """Where one can stand."""
        return self._floors.surfaces

    @property
    def layered(self) -> LayeredArrays:
        """The same as tiles of cells."""
        return self._floors.layered

    @property
    def barriers(self) -> Barriers:
        """What stops bodies, doors included."""
        return self._floors.barriers

    @property
    def doors(self) -> Doors:
        """What of the barriers opens and closes."""
        return self._floors.doors

    def layer_near(self, position: tuple[float, float], z_m: float) -> int:
        """The layer whose floor is nearest to a height there; 0 where nobody can stand."""
        cell = cell_near(self.layered, position[0], position[1], z_m)
        return int(self.layered.places[cell, 0]) if cell >= 0 else 0

    def cell_centre(self, position: tuple[float, float]) -> tuple[float, float]:
        """Centre of the cell that holds a position."""
        a = self.arrays
        j, i = cell_at(a, position[0], position[1])
        return a.x0 + (i + 0.5) * a.cell_m, a.y0 + (j + 0.5) * a.cell_m

    def as_points(
        self, positions: ArrayLike, layers: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Positions as float64 (N, 2) and layers as int64 (N,), checked.

        Raises
        ------
        ValueError
            Wrong shapes, positions that are not finite, a layer that does not exist.
        """
        points = np.ascontiguousarray(positions, dtype=np.float64).reshape(-1, 2)
        floors = np.ascontiguousarray(layers, dtype=np.int64).reshape(-1)
        if len(points) != len(floors):
            raise ValueError(f"{len(points)} positions but {len(floors)} layers")
        if not np.isfinite(points).all():
            raise ValueError("positions must be finite")
        if len(floors) and not (floors.min() >= 0 and floors.max() < self.layers):
            raise ValueError(f"layers must lie in 0..{self.layers - 1}")
        return points, floors

    def clearance(self, positions: ArrayLike, layers: ArrayLike) -> NDArray[np.float64]:
        """Metres to the nearest obstacle, float64 (N,), -inf outside the bounds."""
        points, floors = self.as_points(positions, layers)
        out = np.empty(len(points))
        clearance_many(self.arrays, floors, points, out)
        return out

    def is_free(
        self, positions: ArrayLike, layers: ArrayLike, clearance_m: float
    ) -> NDArray[np.bool_]:
        """Whether a disc of that radius may stand there, bool (N,)."""
        return np.asarray(self.clearance(positions, layers) >= clearance_m)

    def nearest_free(
        self, position: tuple[float, float], layer: int, clearance_m: float
    ) -> tuple[float, float] | None:
        """The position itself when free, else the centre of the nearest free cell, if any.

        Costs O(cells as near as the answer).
        """
        if self.is_free([position], [layer], clearance_m)[0]:
            return float(position[0]), float(position[1])
        a = self.arrays
        x, y = np.clip(position, (a.x0, a.y0), (a.x1, a.y1))
        row, column = int((y - a.y0) / a.cell_m), int((x - a.x0) / a.cell_m)
        field = a.clearance[layer]
        reach = 4
        while True:
            j0, i0 = max(0, row - reach), max(0, column - reach)
            rows, columns = np.nonzero(
                field[j0 : row + reach + 1, i0 : column + reach + 1] >= clearance_m
            )
            centres = np.stack(
                [a.x0 + (columns + i0 + 0.5) * a.cell_m, a.y0 + (rows + j0 + 0.5) * a.cell_m],
                axis=1,
            )
            centres = centres[(centres <= (a.x1, a.y1)).all(axis=1)]
            away = np.hypot(*(centres - (x, y)).T)
            everything = reach >= max(field.shape)
            if len(away) and (everything or away.min() <= (reach - 1) * a.cell_m):
                nearest = centres[away.argmin()]
                return float(nearest[0]), float(nearest[1])
            if everything:
                return None
            reach *= 2

    def walk(
        self,
        positions: ArrayLike,
        layers: ArrayLike,
        displacements: ArrayLike,
        clearance_m: float,
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Move discs, sliding along walls and kept inside the bounds; no wall is ever crossed.

        Parameters
        ----------
        positions, displacements : float (N, 2), metres
        layers : int (N,)
        clearance_m : float, metres
            Distance that a centre keeps from walls, at most 1 m. Who starts closer is let out,
            never further in.

        Returns
        -------
        float64 (N, 2) positions and int64 (N,) layers.
        """
        if not 0.0 <= clearance_m <= 1.0:
            raise ValueError(f"clearance_m must lie between 0 and 1 m, got {clearance_m}")
        points, floors = self.as_points(positions, layers)
        ways = np.ascontiguousarray(displacements, dtype=np.float64).reshape(-1, 2)
        if ways.shape != points.shape:
            raise ValueError(f"{len(points)} positions but {len(ways)} displacements")
        if not np.isfinite(ways).all():
            raise ValueError("displacements must be finite")
        out = np.empty_like(points)
        geometry.slide_many(self.index, self.bounds, points, ways, clearance_m, out)
        return out, floors.copy()

    def potential(self, goal: tuple[float, float], layer: int, radius_m: float) -> Potential:
        """The potential of a goal, kept for others that go there (the latest 256 MiB are)."""
        points, floors = self.as_points([goal], [layer])
        key = (float(points[0, 0]), float(points[0, 1]), int(floors[0]), float(radius_m))
        found = self._potentials.get(key)
        if found is None:
            found = Potential(self, (key[0], key[1]), key[2], key[3])
            self._potentials[key] = found
            if len(self._potentials) > max(1, _POTENTIALS_BYTES // found.guide.nbytes):
                self._potentials.popitem(last=False)
        else:
            self._potentials.move_to_end(key)
        return found
