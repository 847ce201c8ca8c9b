"""The layers of a scene as arrays of cells, from which every way out is written."""

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.scene.bodies import Body
from esplanade.scenery.exports.mesh_floors import grown_to_walls
from esplanade.scenery.layer_maps import walls_on
from esplanade.scenery.reach import reached_cells, spawn_cells

Line = tuple[tuple[float, float], tuple[float, float]]
_ABOVE_FLOOR_M = 0.6
"""An obstacle that ends lower above a floor is stepped over."""
_BODY_M = 1.8
"""An obstacle that begins higher above a floor is passed under."""
_LOW_M = 0.1
"""Solids that are lower above a floor are not drawn."""
_PLACE_M = 0.5
_BESIDE_CELLS = 0.6


class LayerCells(NamedTuple):
    """One layer: the heights of its cells, and what stands on it."""

    number: int
    floors: NDArray[np.float64]
    """(rows, columns), metres, rows from the south; nan where there is no floor."""
    corner: tuple[float, float]
    cell_m: float
    walls: list[Line]
    doors: list[tuple[str, Line]]
    places: list[tuple[str, tuple[float, float]]]
    solids: list[tuple[tuple[float, float], ...]]
    """Outlines of what stands on it and cannot be stood on."""

    def runs(self) -> list[tuple[int, int, int, float]]:
        """Row, first column, column behind the last, height: stretches of equal height."""
        found = []
        for row, heights in enumerate(self.floors):
            known = np.isfinite(heights)
            change = np.flatnonzero(np.diff(np.where(known, heights, -1e9)) != 0.0) + 1
            edges = [0, *change.tolist(), len(heights)]
            found += [
                (row, begin, end, float(heights[begin]))
                for begin, end in itertools.pairwise(edges)
                if known[begin]
            ]
        return found


def layers_of(scene: Scene, grid: LayeredGrid) -> list[LayerCells]:
    """All layers, the ground first.

    A mesh has no walls by name, and floors within what is solid: of it, floors are those that an
    adult reaches from where people come in, and walls are what stops an adult.
    """
    arrays = grid.layered
    places = arrays.places
    known = np.isfinite(arrays.floors)
    x0, y0, _, _ = grid.bounds
    shape = int(places["row"].max()) + 1, int(places["column"].max()) + 1
    body, reached = None, None
    if scene.mesh is not None:
        body = Body()
        traversability = grid.traversability.of(body)
        reached = reached_cells(traversability, spawn_cells(traversability, scene))
    found = []
    for number in np.unique(places["layer"][known]).tolist():
        own = known & (places["layer"] == number)
        dense = np.full(shape, np.nan)
        dense[places["row"][own], places["column"][own]] = arrays.floors[own]
        own_walls = np.empty((0, 4))
        if body is not None and reached is not None:
            own_walls = walls_on(dense, grid.traversability.of(body), body)
            there = np.zeros(shape, dtype=np.bool_)
            there[places["row"][own], places["column"][own]] = reached[own]
            kept = grown_to_walls(there, dense, own_walls, (x0, y0), grid.cell_m)
            if not kept.any():
                continue
            dense[~kept] = np.nan
        ground = _Ground(dense, (x0, y0), grid.cell_m)
        walls = [
            (wall.start, wall.end)
            for wall in scene.walls
            if ground.has((wall.start, wall.end), wall.offset_m, wall.height_m)
        ]
        walls += [((ax, ay), (bx, by)) for ax, ay, bx, by in np.round(own_walls, 6).tolist()]
        doors = [
            (door.name, (door.start, door.end))
            for door in scene.doors
            if ground.has((door.start, door.end), door.offset_m, door.height_m)
        ]
        named = [
            (place.name, place.position)
            for place in scene.places
            if ground.is_near(place.position, place.z_m)
        ]
        solids = [
            solid.points
            for solid in scene.polygons
            if not solid.carries
            and any(
                ground.has(side, solid.offset_m, solid.height_m, _LOW_M)
                for side in zip(solid.points, (*solid.points[1:], solid.points[0]), strict=True)
            )
        ]
        found.append(LayerCells(number, dense, (x0, y0), grid.cell_m, walls, doors, named, solids))
    return found


class _Ground(NamedTuple):
    """The floors of a layer, and what stands beside them."""

    floors: NDArray[np.float64]
    corner: tuple[float, float]
    cell_m: float

    def has(
        self, line: Line, offset_m: float, height_m: float, least_m: float = _ABOVE_FLOOR_M
    ) -> bool:
        """Whether something upright on a line is in the way of who stands beside it.

        What is lower than `least_m` above the floor is not.
        """
        (ax, ay), (bx, by) = line
        length = math.dist(*line)
        share = np.linspace(0.0, 1.0, 2 + math.ceil(2.0 * length / self.cell_m))
        across = np.array([ay - by, bx - ax]) * _BESIDE_CELLS * self.cell_m / max(length, 1e-9)
        x, y = ax + share * (bx - ax), ay + share * (by - ay)
        sides = [self._at(x + s * across[0], y + s * across[1]) for s in (-1.0, 1.0)]
        heights = np.concatenate(sides)
        low = offset_m < heights + _BODY_M
        return bool(np.any(low & (offset_m + height_m > heights + least_m)))

    def is_near(self, position: tuple[float, float], z_m: float) -> bool:
        """Whether a place at that height is on this layer."""
        height = float(self._at(np.array([position[0]]), np.array([position[1]]))[0])
        return abs(height - z_m) <= _PLACE_M

    def _at(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        """Heights of floors at points; nan where there is none."""
        columns = ((x - self.corner[0]) // self.cell_m).astype(int)
        rows = ((y - self.corner[1]) // self.cell_m).astype(int)
        known = (rows >= 0) & (rows < self.floors.shape[0])
        known &= (columns >= 0) & (columns < self.floors.shape[1])
        found = np.full(x.shape, np.nan)
        found[known] = self.floors[rows[known], columns[known]]
        return found
