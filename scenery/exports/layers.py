"""The layers of a scene as arrays of cells, from which every way out is written."""

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid, Scene

Line = tuple[tuple[float, float], tuple[float, float]]
_ABOVE_FLOOR_M = 0.6
"""What ends lower above a floor is stepped over."""


class LayerCells(NamedTuple):
    """One layer: the heights of its cells, and the walls and doors that stand on it."""

    number: int
    floors: NDArray[np.float64]
    """(rows, columns), metres, rows from the south; nan where there is no floor."""
    corner: tuple[float, float]
    cell_m: float
    walls: list[Line]
    doors: list[tuple[str, Line]]

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
    """All layers, the ground first."""
    arrays = grid.layered
    places = arrays.places
    known = np.isfinite(arrays.floors)
    x0, y0, _, _ = grid.bounds
    shape = int(places["row"].max()) + 1, int(places["column"].max()) + 1
    found = []
    for number in np.unique(places["layer"][known]).tolist():
        own = known & (places["layer"] == number)
        dense = np.full(shape, np.nan)
        dense[places["row"][own], places["column"][own]] = arrays.floors[own]
        low, high = float(np.nanmin(dense)), float(np.nanmax(dense))
        walls = [
            (wall.start, wall.end)
            for wall in scene.walls
            if _stands(wall.offset_m, wall.height_m, low, high)
        ]
        doors = [
            (door.name, (door.start, door.end))
            for door in scene.doors
            if _stands(door.offset_m, door.height_m, low, high)
        ]
        found.append(LayerCells(number, dense, (x0, y0), grid.cell_m, walls, doors))
    return found


def _stands(offset_m: float, height_m: float, low: float, high: float) -> bool:
    """Whether something upright stands on floors from `low` to `high`."""
    return offset_m <= high + _ABOVE_FLOOR_M and offset_m + height_m > low + _ABOVE_FLOOR_M
