"""Finds the person, actor, door or wall that holds an actor which does not walk on."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from esplanade.actors.navigator import Navigator
from esplanade.actors.state import Reason
from esplanade.planning.scene.heights import SAME_FLOOR_M

Place = tuple[float, float, float]
WITHIN_M: Final = 2.5
"""Nobody further away is named."""
ASIDE_M: Final = 0.3
"""Whoever stands beside the way by no more than this and both radii stands in it."""
WALL_M: Final = 0.1
_HELD: Final = (Reason.GIVING_WAY, Reason.WAITING, Reason.REPLANNING, Reason.NO_PATH)


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

    It looks at everyone once, and is meant for the few actors that somebody looks at.
    """
    table = navigator.table
    row, agents = table.row(actor_id), table.agents
    if agents.reasons[row] not in _HELD:
        return None
    slot, cell = int(agents.potential_rows[row]), int(agents.cells[row])
    if slot >= 0 and navigator.potentials.provisional(agents.potential_rows[row : row + 1])[0]:
        return Blocker("route")
    if agents.reasons[row] == Reason.NO_PATH:
        return _door(navigator, row) or Blocker("wall")
    here = np.array([*agents.positions[row], agents.heights[row]])
    ahead = None
    if slot >= 0 and cell >= 0:
        waypoint = navigator.potentials.arrays[slot, cell, 1:3].astype(np.float64)
        ahead = waypoint - here[:2] if np.isfinite(waypoint).all() else None
    radius_m = float(agents.parameters["radius_m"][row])
    others = [("person", who, where, navigator.person_radius_m) for who, where in people.items()]
    others += [
        ("actor", who, (*agents.positions[k].tolist(), float(agents.heights[k])), float(r))
        for k, (who, r) in enumerate(zip(table, agents.parameters["radius_m"], strict=True))
        if k != row
    ]
    best: Blocker | None = None
    for kind, who, where, other_m in others:
        away_m = math.dist(where[:2], here[:2]) - radius_m - other_m
        if away_m > WITHIN_M or abs(where[2] - here[2]) >= SAME_FLOOR_M:
            continue
        in_the_way = _in_the_way(np.array(where[:2]) - here[:2], ahead, radius_m + other_m)
        if in_the_way and (best is None or away_m < (best.away_m or 0.0)):
            best = Blocker(kind, who, round(away_m, 3))  # type: ignore[arg-type]
    return best or _wall(navigator, row)


def _in_the_way(
    offset: np.ndarray[tuple[int], np.dtype[np.float64]],
    ahead: np.ndarray[tuple[int], np.dtype[np.float64]] | None,
    bodies_m: float,
) -> bool:
    """Whether somebody at an offset is on the way, a line ahead; anywhere near without a way."""
    if ahead is None or not (length := float(np.hypot(*ahead))):
        return True
    along = float(offset @ ahead) / length
    aside = abs(float(offset[0] * ahead[1] - offset[1] * ahead[0])) / length
    return along > -bodies_m and aside <= bodies_m + ASIDE_M


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
