"""The floors of a zone as one body finds them: derived once, and anew around doors."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground.barriers import Barriers
from esplanade.planning.ground.floors import Floors
from esplanade.planning.ground.layered import TILE, LayeredArrays
from esplanade.planning.scene.bodies import MOST_BODIES, Body
from esplanade.planning.traversal.reachability import measures_of, near_barriers, reachable_steps
from esplanade.planning.traversal.stability import classify
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import number_regions

_KEPT = 2 * MOST_BODIES
"""As many bodies as a zone tells apart, and as they really measure."""


def find_traversability(arrays: LayeredArrays, barriers: Barriers, body: Body) -> Traversability:
    """Derive everything about where a body may go. Cost O(cells)."""
    near = near_barriers(arrays, barriers, body)
    return Traversability(
        arrays,
        near,
        measures_of(body),
        reachable_steps(arrays, near, body),
        classify(arrays, near, body),
        int(body.edge_cells),
    )


def renew_traversability(
    traversability: Traversability, body: Body, around: tuple[float, float, float, float]
) -> Traversability:
    """Derive again what depends on barriers within x0, y0, x1, y1, metres.

    For doors: their rows among the barriers are the same, with another rise. Whoever still reads
    the traversability as it was is not disturbed.
    """
    arrays, reach = traversability.arrays, traversability.near.reach_m
    tile_m = TILE * arrays.cell_m
    x0, y0, x1, y1 = around
    tiles_y, tiles_x = arrays.pages.shape[1:]
    box = (
        max(0, math.floor((y0 - reach - arrays.y0) / tile_m)),
        max(0, math.floor((x0 - reach - arrays.x0) / tile_m)),
        min(int(tiles_y), math.floor((y1 + reach - arrays.y0) / tile_m) + 1),
        min(int(tiles_x), math.floor((x1 + reach - arrays.x0) / tile_m) + 1),
    )
    return traversability._replace(
        steps=reachable_steps(arrays, traversability.near, body, traversability.steps.copy(), box),
        classes=classify(arrays, traversability.near, body, traversability.classes.copy(), box),
    )


@dataclass
class _Known:
    """A traversability, the doors' rises it was derived from, and its regions once asked for."""

    traversability: Traversability
    rises: NDArray[np.float64]
    regions: NDArray[np.int32] | None = None


class TraversabilityCache:
    """What bodies find of the floors of one zone, for each of the latest bodies.

    It is derived when first asked for, and anew around doors that have opened or closed since.
    """

    def __init__(self, floors: Floors) -> None:
        self._floors = floors
        self._known: OrderedDict[Body, _Known] = OrderedDict()

    def of(self, body: Body) -> Traversability:
        """The floors of the zone as this body finds them."""
        return self._up_to_date(body).traversability

    def regions_of(self, body: Body) -> NDArray[np.int32]:
        """`number_regions` of the same, kept as long."""
        known = self._up_to_date(body)
        if known.regions is None:
            known.regions = number_regions(known.traversability)
        return known.regions

    def _up_to_date(self, body: Body) -> _Known:
        floors = self._floors
        doors = floors.barriers[: len(floors.doors)]
        rises = doors[:, 6]
        known = self._known.get(body)
        if known is None:
            found = find_traversability(floors.layered, floors.barriers, body)
            known = _Known(found, rises.copy())
        elif not np.array_equal(rises, known.rises):
            found, now = known.traversability, rises.copy()
            for x0, y0, x1, y1 in doors[now != known.rises, :4]:
                around = min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
                found = renew_traversability(found, body, around)
            known = _Known(found, now)
        self._known[body] = known
        self._known.move_to_end(body)
        if len(self._known) > _KEPT:
            self._known.popitem(last=False)
        return known
