"""Traversability of a zone for each body: derived once, and again around doors that move."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.ground.barriers import Barriers
from esplanade.planning.ground.floors import Floors
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.scene.bodies import MOST_BODIES, Body
from esplanade.planning.traversal.reachability import (
    measures_of,
    near_barriers,
    reachable_steps,
    renew_steps,
)
from esplanade.planning.traversal.stability import classify
from esplanade.planning.traversal.tiles import cells_around, tiles_of
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import number_regions

_KEPT = 2 * MOST_BODIES
"""Number of bodies that are kept: those that a zone tells apart, each also as it measures."""


Steps = tuple[NDArray[np.uint8], NDArray[np.int8]]
"""The steps (N,) and offsets (E, 2) of a traversability."""


def find_traversability(arrays: LayeredArrays, barriers: Barriers, body: Body) -> Traversability:
    """Derive where a body may go on some floors. Cost O(cells)."""
    near = near_barriers(arrays, barriers, body)
    steps, offsets = reachable_steps(arrays, near, body)
    return Traversability(
        arrays,
        near,
        measures_of(body),
        offsets,
        steps,
        classify(arrays, near, body, offsets),
        int(body.edge_cells),
    )


def renew_traversability(
    traversability: Traversability, body: Body, row: int, into: Steps | None = None
) -> Traversability:
    """Derive again all that depends on one barrier, a door whose row has changed in place.

    The traversability that is given stays as it is for other threads, and steps and offsets are
    copied; or they are written to `into`, which holds the same.
    """
    arrays, near = traversability.arrays, traversability.near
    x0, y0, x1, y1 = (float(near.barriers[end][row]) for end in ("x0", "y0", "x1", "y1"))
    around = min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)
    box = cells_around(arrays, around, near.reach_m)
    own = into or (traversability.steps.copy(), traversability.offsets.copy())
    renew_steps(arrays, near, body, row, box, own)
    steps, offsets = own
    classes = classify(arrays, near, body, offsets, traversability.classes.copy(), tiles_of(box))
    return traversability._replace(offsets=offsets, steps=steps, classes=classes)


@dataclass
class KnownTraversability:
    """A traversability, the climbs of doors it was derived from, and its regions if known."""

    traversability: Traversability
    door_climbs: NDArray[np.float64]
    regions: NDArray[np.int32] | None = None


class TraversabilityCache:
    """The traversability of one zone for each of the bodies that were asked for last.

    It is derived at the first call, and again around doors that have opened or closed since. Bodies
    that differ in M alone share it.
    """

    def __init__(self, floors: Floors) -> None:
        self._floors = floors
        self._known: OrderedDict[Body, KnownTraversability] = OrderedDict()

    def of(self, body: Body) -> Traversability:
        """The traversability of the zone for a body."""
        found = self._up_to_date(body).traversability
        if body.edge_cells == Body.edge_cells:
            return found
        return found._replace(edge_cells=int(body.edge_cells))

    def regions_of(self, body: Body) -> NDArray[np.int32]:
        """`number_regions` of the traversability for a body, kept as long as that."""
        known = self._up_to_date(body)
        if known.regions is None:
            known.regions = number_regions(known.traversability)
        return known.regions

    def fork(self) -> TraversabilityCache:
        """A cache that knows the same, and keeps to itself what is derived from now on."""
        fork = TraversabilityCache(self._floors)
        fork._known = self._known.copy()
        return fork

    def known(self, body: Body) -> KnownTraversability:
        """Return what is kept for a body; it is derived if need be."""
        return self._up_to_date(body)

    def forget(self, body: Body) -> None:
        """Keep nothing for a body any more."""
        self._known.pop(body, None)

    def prepare(
        self, body: Body, barriers: Barriers, into: Steps | None = None
    ) -> KnownTraversability:
        """Derive the traversability for a body if the barriers of the zone were these.

        They are a copy (S,) of the zone's in which doors have moved. Nothing is kept; what is
        returned becomes true for `keep` once the doors of the zone have moved as well. `into` is as
        in `renew_traversability`.
        """
        known = self._derived(body, self._known.get(body), barriers, into)
        shared = known.traversability.near._replace(barriers=self._floors.barriers)
        return replace(known, traversability=known.traversability._replace(near=shared))

    def keep(self, prepared: Mapping[Body, KnownTraversability]) -> None:
        """Keep what `prepare` has derived, now that the doors have moved."""
        for body, known in prepared.items():
            self._keep(body, known)

    def _up_to_date(self, body: Body) -> KnownTraversability:
        body = replace(body, edge_cells=Body.edge_cells)
        known = self._derived(body, self._known.get(body), self._floors.barriers)
        self._keep(body, known)
        return known

    def _derived(
        self,
        body: Body,
        known: KnownTraversability | None,
        barriers: Barriers,
        into: Steps | None = None,
    ) -> KnownTraversability:
        """Return the kept arrays if they still hold, else derive them anew around moved doors."""
        floors = self._floors
        doors = barriers[: len(floors.doors)]
        climbs = doors["climb_m"].copy()
        if known is None:
            found = find_traversability(floors.layered, barriers, body)
            if into is not None:
                into[0][:], into[1][:] = found.steps, found.offsets
            return KnownTraversability(found, climbs)
        if np.array_equal(climbs, known.door_climbs):
            return known
        found = known.traversability
        found = found._replace(near=found.near._replace(barriers=barriers))
        for row in np.flatnonzero(climbs != known.door_climbs).tolist():
            found = renew_traversability(found, body, row, into)
        return KnownTraversability(found, climbs)

    def _keep(self, body: Body, known: KnownTraversability) -> None:
        self._known[body] = known
        self._known.move_to_end(body)
        if len(self._known) > _KEPT:
            self._known.popitem(last=False)
