"""The grid of a zone: where a body may stand, its clearance there, and how it walks."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.planning.compiled.handle import Handle, make_handle
from esplanade.planning.grid import _free_place_kernels as free_places
from esplanade.planning.grid import _grid_kernels as kernels
from esplanade.planning.grid import _walking_kernels as walking
from esplanade.planning.grid._grid_kernels import GridArrays, KindArrays
from esplanade.planning.grid._walking_kernels import GroundArrays
from esplanade.planning.grid.barrier_buckets import index_barriers
from esplanade.planning.grid.bodies_change import BodiesChange
from esplanade.planning.grid.body_rows import BodyRows
from esplanade.planning.grid.clearances import (
    CLEARANCE_CAP_M,
    cells_within,
    kind_of,
    with_row,
    write_clearance,
)
from esplanade.planning.grid.door_change import DoorChange
from esplanade.planning.grid.kinds import copied, kind_arrays, shared_with, steps_in
from esplanade.planning.grid.lookup import PlaceLookup
from esplanade.planning.ground._geometry_kernels import Placement
from esplanade.planning.ground.barriers import Barriers
from esplanade.planning.ground.floors import Floors, floors_of_mesh, floors_of_scene
from esplanade.planning.ground.meshes import Progress, no_progress
from esplanade.planning.ground.surfaces import Surfaces
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.doors import Doors
from esplanade.planning.scene.mesh_file import Up
from esplanade.planning.scene.scene import Scene
from esplanade.planning.traversal.cache import KnownTraversability, TraversabilityCache
from esplanade.planning.traversal.edge_runs import EdgeRuns
from esplanade.planning.traversal.stability import Stability

ADULT = Body.adult()
_EDGES = (Stability.UNSTABLE, Stability.UP_STAIR, Stability.DOWN_STAIR)


class LayeredGrid(PlaceLookup):
    """The cells of one zone, layer by layer, and the barriers that stop bodies there.

    Places are given by x, y and a height, in metres: the standing surface nearest in height is
    meant. A disc of radius r may stand where the clearance of its kind of body is at least r; that
    set is the complement of its C-obstacles. Memory is some 52 bytes a cell, and 13 more for each
    kind of body.
    """

    def __init__(self, floors: Floors) -> None:
        self.floors = floors
        layered = floors.layered
        flat = len(layered.pages) == 1 and not (np.nan_to_num(layered.floors) != 0.0).any()
        cells = len(layered.floors)
        self.arrays = GridArrays(
            layered,
            np.zeros((0, cells), dtype=np.float32),
            np.zeros((0, cells), dtype=np.bool_),
            flat,
            kind_arrays(floors.barriers, cells, []),
        )
        self.traversability = TraversabilityCache(floors)
        self._edge_runs = EdgeRuns(floors)
        self.index = index_barriers(floors.barriers, self.bounds)
        self._held = self.arrays, make_handle(GroundArrays(self.arrays, self.index))
        self._rows = BodyRows()
        self._forked = self.arrays
        self.claim(ADULT)

    @classmethod
    def from_scene(cls, scene: Scene, cell_m: float = 0.25) -> Self:
        """Derive the grid of a scene, with cells of `cell_m` metres.

        Cost O(surfaces + obstacles × cells near them).

        Raises
        ------
        ValueError
            `cell_m` is not between 0.05 and 2 m; the scene's mesh is at fault.
        """
        if scene.mesh is not None:
            return cls.from_mesh(scene.mesh, cell_m)
        return cls(floors_of_scene(scene, cell_m))

    @classmethod
    def from_mesh(
        cls, path: str | Path, cell_m: float = 0.25, up: Up = "y", progress: Progress = no_progress
    ) -> Self:
        """Derive the grid of a building from an OBJ, glTF or any other file of `read_mesh`.

        Parameters
        ----------
        up : "y" or "z"
            The file's axis that points up. With "y", its (x, y, z) becomes (x, -z, y).
        progress : Progress
            Called as each piece of the work begins.

        Raises
        ------
        MeshError
            The file is at fault; the message names the file and the fault.
        """
        return cls(floors_of_mesh(path, cell_m, up, progress))

    def row_of(self, body: Body) -> int:
        """Row of a kind of body in `arrays.clearance`, which is derived at the first call.

        Bodies share a row, derived for the widest, tallest and stiffest of them, if they are of one
        kind (`kind_of`), however long they may stay on edges. The row is another kind's one day
        unless somebody has claimed it.

        Raises
        ------
        ValueError
            `MOST_BODIES` kinds are claimed already, and this is none of them.
        """
        body = kind_of(body)
        row = self._rows.get(body)
        if row is None:
            before = set(self._rows)
            row = self._rows.free_row(body)
            for forgotten in before.difference(self._rows):
                self.traversability.forget(forgotten)
            a = self.arrays
            everywhere = np.arange(len(a.layered.floors))
            field = np.empty(len(everywhere), dtype=np.float32)
            write_clearance(a, self.index, body, self.bounds, everywhere, field)
            self._rows.add(body, row)
            self.arrays = a._replace(
                clearance=with_row(a.clearance, row, field),
                edges=with_row(a.edges, row, self._edges(body, everywhere)),
                kinds=self._derive_kinds(),
            )
        return row

    def claim(self, body: Body) -> int:
        """`row_of`, which stays this kind's until `release` has been called as often.

        Raises
        ------
        ValueError
            `MOST_BODIES` kinds are claimed already, and this is none of them.
        """
        row = self.row_of(body)
        self._rows.claim(kind_of(body))
        return row

    def release(self, body: Body) -> None:
        """Give back the row of a kind of body that was claimed."""
        self._rows.claim(kind_of(body), -1)

    def knows(self, body: Body) -> bool:
        """Whether the row of this kind of body is derived."""
        return kind_of(body) in self._rows

    def fork(self) -> Self:
        """A grid that is like this one, and gets to know kinds of body of its own.

        What is derived on it leaves this one as it is, so that it may be used in another thread as
        long as no door moves. `bodies_change` is what it has got to know meanwhile.
        """
        fork = copy(self)
        vars(fork).update(
            _rows=self._rows.fork(),
            _forked=self.arrays,
            traversability=self.traversability.fork(),
        )
        return fork

    def bodies_change(self, fork: LayeredGrid) -> BodiesChange:
        """Return what a fork has learnt of new bodies, to be applied if this is unchanged."""
        known = {kind: fork.traversability.known(kind) for kind in fork._rows}
        return BodiesChange(fork._forked, fork.arrays, fork._rows.all(), known)

    def apply_bodies(self, change: BodiesChange) -> bool:
        """Get to know the kinds of body that a fork knows; O(1).

        Where the grid is another than the one that was forked, it is left as it is; kinds of body
        are then derived when they are asked for, to the same end. Returns whether that is so.
        """
        if change.base is not self.arrays or not self._rows.take_over(change.rows):
            return False
        self.traversability.keep(change.known)
        self.arrays = change.arrays
        return True

    def _derive_kinds(self) -> KindArrays:
        """Where each known kind of body fits, row by row; traversabilities share the arrays."""
        known = self._by_row(self.traversability.known)
        found = [one.traversability for one in known]
        kinds = kind_arrays(self.barriers, len(self.layered.floors), found)
        self._share(kinds, known)
        return kinds

    def _by_row(self, of: Callable[[Body], KnownTraversability]) -> list[KnownTraversability]:
        """The traversabilities of all known kinds of body, in the order of their rows."""
        bodies = {row: body for body, row in self._rows.all().items()}
        return [of(bodies[row]) for row in range(len(bodies))]

    def _share(self, kinds: KindArrays, known: Sequence[KnownTraversability]) -> None:
        """Keep traversabilities, row by row, with the arrays of kinds of body."""
        for body, row in self._rows.all().items():
            one = known[row]
            shared = shared_with(kinds, row, one.traversability)
            self.traversability.keep({body: replace(one, traversability=shared)})

    def _edges(self, body: Body, cells: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether a body is on an edge in each of some cells, bool (K,)."""
        if self.arrays.flat:
            return np.zeros(len(cells), dtype=np.bool_)
        return np.isin(self.traversability.of(body).classes[cells], _EDGES)

    def bounds_edges(self, body: Body) -> bool:
        """Whether a body's bound on cells on edges in a row can forbid any way here.

        Cost O(cells) at the first call for a kind of body.
        """
        if self.arrays.flat:
            return False
        return self._edge_runs.longest(kind_of(body), self.traversability) >= body.edge_cells

    @property
    def ground(self) -> Handle[GroundArrays]:
        """`arrays` and `index` as kernels keep them, for frequent calls."""
        arrays = self.arrays
        if self._held[0] is not arrays:
            self._held = arrays, make_handle(GroundArrays(arrays, self.index))
        return self._held[1]

    @property
    def surfaces(self) -> Surfaces:
        """The standing surfaces."""
        return self.floors.surfaces

    @property
    def barriers(self) -> Barriers:
        """The barriers that stop bodies, doors included."""
        return self.floors.barriers

    @property
    def doors(self) -> Doors:
        """The barriers that open and close; `set_door` moves them."""
        return self.floors.doors

    def set_door(self, name: str, is_open: bool) -> None:
        """Open or close a door; clearances near it are derived again.

        A thread that reads `arrays` meanwhile keeps the arrays from before. Potentials made before
        do not know of the change and have to be made anew.

        Raises
        ------
        KeyError
            There is no door of that name.
        """
        self.apply_door(self.prepare_door(name, is_open))

    def prepare_door(self, name: str, is_open: bool) -> DoorChange:
        """Derive what the grid will be once a door has moved; the grid stays as it is.

        It may run in another thread while the grid is in use, as long as no door moves meanwhile;
        if one does, `apply_door` notices. Cost O(cells): some milliseconds.

        Raises
        ------
        KeyError
            There is no door of that name.
        """
        base, bodies = self.arrays, self._rows.all()
        barriers = self.barriers.copy()
        x0, y0, x1, y1 = self.doors.set_open(name, is_open, barriers)
        index = self.index._replace(barriers=barriers)
        reach = CLEARANCE_CAP_M
        box = (x0 - reach, y0 - reach, x1 + reach, y1 + reach)
        near = cells_within(self.layered, box)
        clearance, edges = base.clearance.copy(), base.edges.copy()
        kinds, known = copied(base.kinds), {}
        for body, row in bodies.items():
            write_clearance(base, index, body, box, near, clearance[row])
            known[body] = self.traversability.prepare(body, barriers, steps_in(kinds, row))
            if not base.flat:
                edges[row, near] = np.isin(known[body].traversability.classes[near], _EDGES)
        for body, row in bodies.items():
            shared = shared_with(kinds, row, known[body].traversability)
            known[body] = replace(known[body], traversability=shared)
        arrays = base._replace(clearance=clearance, edges=edges, kinds=kinds)
        return DoorChange(name, is_open, base, arrays, known)

    def apply_door(self, change: DoorChange) -> None:
        """Let a prepared change of a door take effect; O(1).

        Where the grid is another than it was prepared for, it is derived here, to the same end.
        """
        if change.base is not self.arrays:
            change = self.prepare_door(change.name, change.is_open)
        self.doors.set_open(change.name, change.is_open)
        self.traversability.keep(change.known)
        self.arrays = change.arrays

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1 in metres."""
        a = self.layered
        return a.x0, a.y0, a.x1, a.y1

    @property
    def cell_m(self) -> float:
        """Edge of a cell, metres."""
        return self.layered.cell_m

    @property
    def layers(self) -> int:
        """Number of layers."""
        return len(self.layered.pages)

    def cell_at(self, position: tuple[float, float], height: float) -> int:
        """The cell of one place, -1 where nobody can stand; `on_ground` does this for many."""
        return walking.cell_at(self.ground, position[0], position[1], height)

    def clearance(
        self, positions: ArrayLike, heights: ArrayLike, body: Body = ADULT
    ) -> NDArray[np.float64]:
        """Metres to the barriers that stop a body, float64 (N,); -inf where it cannot stand."""
        row = self.row_of(body)
        points, cells = self.on_ground(positions, heights)
        out = np.empty(len(points))
        kernels.clearance_many(self.arrays, row, cells, points, out)
        return out

    def is_free(
        self,
        positions: ArrayLike,
        heights: ArrayLike,
        clearance_m: float,
        body: Body = ADULT,
    ) -> NDArray[np.bool_]:
        """Whether a disc of radius `clearance_m` may stand at each position, bool (N,)."""
        return np.asarray(self.clearance(positions, heights, body) >= clearance_m)

    def nearest_free(
        self,
        position: tuple[float, float],
        height: float,
        clearance_m: float,
        body: Body = ADULT,
    ) -> tuple[float, float] | None:
        """The position itself when free, else the anchor of the nearest free cell on its level.

        Within a metre, cells on this side of walls are preferred. Cells whose floors differ from
        `height` by less than half the body's height are on its level; without a free cell on that
        level, all levels are searched. A position in the air means the floor below; a position
        inside a building does not mean its roof. Returns None if no cell is free.
        """
        x, y = float(position[0]), float(position[1])
        level_m = 0.5 * body.height_m
        row = self.row_of(body)
        free_here = self.is_free([position], [height], clearance_m, body)[0]
        floor = self.floor_at(position, height)
        placement = Placement(floor, floor, body.height_m, body.step_on_m, body.leg_length_m)
        ground = GroundArrays(self.arrays, self.index)
        for within_m in (level_m, math.inf):
            if free_here and floor - height < within_m:
                return x, y
            cell = free_places.nearest_free_cell(
                ground, row, clearance_m, placement, x, y, float(height), within_m
            )
            if cell >= 0:
                return kernels.anchor_at(self.arrays, row, cell)
        return None

    def walk(
        self,
        positions: ArrayLike,
        heights: ArrayLike,
        displacements: ArrayLike,
        clearance_m: float,
        body: Body = ADULT,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Move bodies; they slide along barriers, never cross a wall and never leave a ledge.

        Parameters
        ----------
        positions, displacements : float (N, 2), metres
        heights : float (N,), metres
        clearance_m : float, metres
            Distance that a centre keeps from walls, at most 1 m. A body that starts closer may
            leave, but gets no closer.

        Returns
        -------
        positions : float64 (N, 2), metres
        heights : float64 (N,), metres
            Heights of the floors at those positions.
        """
        if not 0.0 <= clearance_m <= 1.0:
            raise ValueError(f"clearance_m must lie between 0 and 1 m, got {clearance_m}")
        points, cells = self.on_ground(positions, heights)
        moves = np.ascontiguousarray(displacements, dtype=np.float64).reshape(-1, 2)
        if moves.shape != points.shape:
            raise ValueError(f"{len(points)} positions but {len(moves)} displacements")
        if not np.isfinite(moves).all():
            raise ValueError("displacements must be finite")
        out = points.copy()
        walking.walk_many(
            self.arrays,
            self.index,
            body.height_m,
            body.step_on_m,
            body.leg_length_m,
            cells,
            out,
            moves,
            clearance_m,
        )
        levels = np.where(cells >= 0, self.layered.floors[cells], heights)
        return out, levels.astype(np.float64)
