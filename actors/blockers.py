"""Finds the person, actor, door or wall that holds an actor which does not walk on."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.navigator import Navigator
from esplanade.actors.people import ObservedPeople
from esplanade.actors.state import Reason
from esplanade.planning.scene.heights import SAME_FLOOR_M

Place = tuple[float, float, float]
WITHIN_M: Final = 2.5
"""Nobody further away is named."""
ASIDE_M: Final = 0.3
"""Whoever stands beside the way by no more than this and both radii stands in it."""
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
    here = np.array([*agents.positions[row], agents.heights[row]])
    ahead = None
    if slot >= 0 and cell >= 0:
        waypoint = navigator.potentials.arrays[slot, cell, 1:3].astype(np.float64)
        ahead = waypoint - here[:2] if np.isfinite(waypoint).all() else None
    radius_m = float(agents.parameters["radius_m"][row])
    known = people if isinstance(people, ObservedPeople) else None
    ids: Sequence[Hashable] = list(people) if known is None else known.ids.tolist()
    places = np.array(list(people.values())) if known is None else known.places
    others = np.concatenate(
        [places.reshape(-1, 3), np.column_stack([agents.positions, agents.heights])]
    )
    bodies_m = radius_m + np.concatenate(
        [np.full(len(ids), navigator.person_radius_m), agents.parameters["radius_m"]]
    )
    offsets = others[:, :2] - here[:2]
    away_m = np.hypot(offsets[:, 0], offsets[:, 1]) - bodies_m
    away_m[len(ids) + row] = np.inf
    near = (away_m <= WITHIN_M) & (np.abs(others[:, 2] - here[2]) < SAME_FLOOR_M)
    near &= _in_the_way(offsets, ahead, bodies_m)
    if not near.any():
        return _wall(navigator, row)
    first = int(np.where(near, away_m, np.inf).argmin())
    rounded_m = round(float(away_m[first]), 3)
    if first < len(ids):
        return Blocker("person", ids[first], rounded_m)
    return Blocker("actor", table.ids[first - len(ids)], rounded_m)


def _in_the_way(
    offsets: NDArray[np.float64], ahead: NDArray[np.float64] | None, bodies_m: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether others at offsets (N, 2) are on the way, a line ahead; all of them without a way."""
    if ahead is None or not (length := float(np.hypot(*ahead))):
        return np.ones(len(offsets), dtype=np.bool_)
    along = offsets @ ahead / length
    aside = np.abs(offsets[:, 0] * ahead[1] - offsets[:, 1] * ahead[0]) / length
    found: NDArray[np.bool_] = (along > -bodies_m) & (aside <= bodies_m + ASIDE_M)
    return found


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
