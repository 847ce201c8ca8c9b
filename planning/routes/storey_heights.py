"""Storeys of a building as people count them: heights with much floor, one above the other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.grid.grid import ADULT, LayeredGrid
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.heights import LEVEL_M, STOREYS_APART_M
from esplanade.planning.traversal.wavefront import UNREACHED, spread_wave

LANDING_M2: Final = 6.0
"""A floor with a smaller area is a landing, not a storey."""


def storeys_of(grid: LayeredGrid, ground: NDArray[np.bool_]) -> tuple[float, ...]:
    """Heights of the storeys in metres, the lowest first; at least one.

    `ground`, bool (N,), are the cells to consider. Only cells count that lie above or below others
    of them, so that hills have no storeys. A storey's height is the median of its floors.
    """
    a = grid.layered
    cells = np.flatnonzero(ground & np.isfinite(a.floors))
    floors = a.floors[cells].astype(np.float64)
    if not len(floors):
        return (0.0,)
    left = _stacked_floors(a, cells)
    found: list[float] = []
    while len(left):
        within = np.searchsorted(left, left + LEVEL_M, side="right") - np.arange(len(left))
        fullest = int(within.argmax())
        if within[fullest] * a.cell_m**2 < LANDING_M2:
            break
        height = float(np.median(left[fullest : fullest + within[fullest]]))
        found.append(height)
        left = left[np.abs(left - height) >= STOREYS_APART_M]
    return tuple(sorted(found)) or (float(np.median(floors)),)


def _stacked_floors(a: LayeredArrays, cells: NDArray[np.intp]) -> NDArray[np.float64]:
    """The floors, sorted, of those of some cells that lie above or below others of them."""
    several = (a.pages >= 0).sum(axis=0, dtype=np.int16) > 1
    if not several.any():
        return np.empty(0)
    places = a.places[cells]
    near = several[places["row"] // TILE, places["column"] // TILE]
    places, floors = places[near], a.floors[cells[near]].astype(np.float64)
    columns = places["row"].astype(np.int64) * a.nx + places["column"]
    order = np.lexsort((floors, columns))
    over = (np.diff(columns[order]) == 0) & (np.diff(floors[order]) >= STOREYS_APART_M)
    stacked = np.zeros(len(floors), dtype=np.bool_)
    stacked[order[:-1][over]] = stacked[order[1:][over]] = True
    return np.sort(floors[stacked])


def reached_from(
    grid: LayeredGrid, starts: Sequence[tuple[float, float, float]], body: Body = ADULT
) -> NDArray[np.bool_]:
    """Whether a body gets to each cell from any of some places x, y, z in metres, bool (N,).

    Without any place to start from, it is True in all cells.
    """
    traversability = grid.traversability.of(body)
    reached = np.full(len(traversability.steps), not starts)
    for x, y, z in starts:
        cell = int(grid.on_ground([(x, y)], [z])[1][0])
        if cell >= 0 and not reached[cell]:
            reached |= spread_wave(traversability, cell) != UNREACHED
    return reached
