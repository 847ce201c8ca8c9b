"""Finds the person, actor, door or wall that holds an actor which does not walk on."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from esplanade.actors.bodies_near import nearest_on_way
from esplanade.actors.navigator import Navigator
from esplanade.actors.people import ObservedPeople
from esplanade.actors.state import Reason

Place = tuple[float, float, float]
WITHIN_M: Final = 2.5
"""Nobody further away is named."""
WALL_M: Final = 0.1
_HELD: Final = frozenset({Reason.GIVING_WAY, Reason.WAITING, Reason.REPLANNING, Reason.NO_PATH})


@dataclass(frozen=True)
class Blocker:
    """The person, actor, door, wall or missing route that holds an actor."""

    kind: Literal["person", "actor", "door", "wall", "route"]
    """A route is one that is still being found."""
    id: Hashable = None
    """The id of the person or the actor, or the name of the door."""
    away_m: float | None = None
    """Metres between the bodies, or to the door."""


def find_blocker(
    navigator: Navigator, actor_id: Hashable, people: Mapping[Hashable, Place]
) -> Blocker | None:
    """Find the blocker of an actor, the nearest on its way; None if the actor is not held.

    It looks at everyone once, in arrays.
    """
    table = navigator.table
    row, agents = table.row(actor_id), table.agents
    reason = int(agents.reasons[row])  # a number of numpy's is compared with an enum slowly
    if reason not in _HELD:
        return None
    slot, cell = int(agents.potential_rows[row]), int(agents.cells[row])
    if slot >= 0 and navigator.potentials.provisional(agents.potential_rows[row : row + 1])[0]:
        return Blocker("route")
    if reason == Reason.NO_PATH:
        return _door(navigator, row) or Blocker("wall")
    ahead = None
    if slot >= 0 and cell >= 0:
        waypoint = navigator.potentials.arrays[slot, cell, 1:3].astype(np.float64)
        ahead = waypoint - agents.positions[row] if np.isfinite(waypoint).all() else None
    known = people if isinstance(people, ObservedPeople) else None
    ids: Sequence[Hashable] = list(people) if known is None else known.ids.tolist()
    places = np.array(list(people.values())) if known is None else known.places
    bodies = navigator.bodies(ids, places.reshape(-1, 3))
    nearest = nearest_on_way(bodies, len(ids) + row, ahead, WITHIN_M)
    if nearest is None:
        return _wall(navigator, row)
    kind, who = bodies.who(nearest[0])
    return Blocker(kind, who, round(nearest[1], 3))


def _door(navigator: Navigator, row: int) -> Blocker | None:
    """The nearest door that is closed."""
    x, y = navigator.table.agents.positions[row].tolist()
    doors, barriers = navigator.grid.doors, navigator.grid.barriers
    found = []
    for name in doors:
        if not doors.is_open(name):
            x0, y0, x1, y1 = barriers[doors.rows[name]].tolist()[:4]
            found.append((math.dist((x, y), ((x0 + x1) / 2.0, (y0 + y1) / 2.0)), name))
    if not found:
        return None
    away_m, name = min(found)
    return Blocker("door", name, round(away_m, 3))


def _wall(navigator: Navigator, row: int) -> Blocker | None:
    agents, grid = navigator.table.agents, navigator.grid
    cell = int(agents.cells[row])
    if cell < 0:
        return Blocker("wall")
    clearance_m = float(grid.arrays.clearance[agents.bodies[row], cell])
    left_m = clearance_m - float(agents.parameters["radius_m"][row])
    return Blocker("wall", None, round(left_m, 3)) if left_m < WALL_M else None
