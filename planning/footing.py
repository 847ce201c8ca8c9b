"""The floors of a zone as one body finds them: derived once, and anew around doors."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import dataclass
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from planning._footing import Footing
from planning._layered import TILE, LayeredArrays
from planning.barriers import Barriers
from planning.bodies import MOST_BODIES, Body
from planning.reachability import measures_of, near_barriers, reachable_steps
from planning.stability import classify
from planning.wavefront import number_regions

if TYPE_CHECKING:
    from planning.grid import LayeredGrid

_KEPT = 2 * MOST_BODIES
"""As many bodies as a zone tells apart, and as they really measure."""


def find_footing(arrays: LayeredArrays, barriers: Barriers, body: Body) -> Footing:
    """Derive everything about where a body may go. Cost O(cells)."""
    near = near_barriers(arrays, barriers, body)
    return Footing(
        arrays,
        near,
        measures_of(body),
        reachable_steps(arrays, near, body),
        classify(arrays, near, body),
        int(body.edge_cells),
    )


def renew_footing(
    footing: Footing, body: Body, around: tuple[float, float, float, float]
) -> Footing:
    """Derive again what depends on barriers within x0, y0, x1, y1, metres.

    For doors: their rows among the barriers are the same, with another rise. Whoever still reads
    the footing as it was is not disturbed.
    """
    arrays, reach = footing.arrays, footing.near.reach_m
    tile_m = TILE * arrays.cell_m
    x0, y0, x1, y1 = around
    tiles_y, tiles_x = arrays.pages.shape[1:]
    box = (
        max(0, math.floor((y0 - reach - arrays.y0) / tile_m)),
        max(0, math.floor((x0 - reach - arrays.x0) / tile_m)),
        min(int(tiles_y), math.floor((y1 + reach - arrays.y0) / tile_m) + 1),
        min(int(tiles_x), math.floor((x1 + reach - arrays.x0) / tile_m) + 1),
    )
    return footing._replace(
        steps=reachable_steps(arrays, footing.near, body, footing.steps.copy(), box),
        classes=classify(arrays, footing.near, body, footing.classes.copy(), box),
    )


@dataclass
class _Known:
    """A footing, the doors' rises that it was derived from, and its regions once asked for."""

    footing: Footing
    rises: NDArray[np.float64]
    regions: NDArray[np.int32] | None = None


_known: WeakKeyDictionary[LayeredGrid, OrderedDict[Body, _Known]] = WeakKeyDictionary()


def footing_of(grid: LayeredGrid, body: Body) -> Footing:
    """The floors of a grid for a body: derived when first asked for, and anew around doors that
    have opened or closed since. Of each grid the latest are kept."""
    return _known_of(grid, body).footing


def regions_of(grid: LayeredGrid, body: Body) -> NDArray[np.int32]:
    """`number_regions` of the same, kept as long."""
    known = _known_of(grid, body)
    if known.regions is None:
        known.regions = number_regions(known.footing)
    return known.regions


def _known_of(grid: LayeredGrid, body: Body) -> _Known:
    bodies = _known.setdefault(grid, OrderedDict())
    doors = grid.barriers[: len(grid.doors)]
    rises = doors[:, 6]
    known = bodies.get(body)
    if known is None:
        known = _Known(find_footing(grid.layered, grid.barriers, body), rises.copy())
    elif not np.array_equal(rises, known.rises):
        footing, now = known.footing, rises.copy()
        for x0, y0, x1, y1 in doors[now != known.rises, :4]:
            around = min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
            footing = renew_footing(footing, body, around)
        known = _Known(footing, now)
    bodies[body] = known
    bodies.move_to_end(body)
    if len(bodies) > _KEPT:
        bodies.popitem(last=False)
    return known
