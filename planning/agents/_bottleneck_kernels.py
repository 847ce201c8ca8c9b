"""Keeping right at passages that agents want to go through from both sides, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._passage_kernels import (
    NO_PASSAGE,
    PassageShape,
    find_passage,
)
from esplanade.planning.agents.agents import Agents
from esplanade.planning.agents.priorities import Priorities, Turn
from esplanade.planning.compiled.jit import borrowing, inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, length
from esplanade.planning.routes._potential_kernels import PotentialValues

LEAVES_PASSAGE, ENTERS_PASSAGE = int(Turn.LEAVES_PASSAGE), int(Turn.ENTERS_PASSAGE)
SETTLED = int(Turn.SETTLED)


class Lane(NamedTuple):
    """The right-hand side of a passage, in metres."""

    x: float
    """Middle of the passage."""
    y: float
    along_x: float
    """Unit vector through the passage."""
    along_y: float
    shift_m: float
    """Distance from the middle of the passage to the left border of the lane, to the right."""
    weight: float
    """Cost, in metres of path, of a metre wholly on the left; 0 if the agent keeps to no lane."""
    before_m: float
    """Distance before the passage from which the lane leads to it."""
    after_m: float
    """Distance behind it up to which the lane goes on."""
    left_rad: float
    """Seen at this angle from the lane's beginning an agent is wholly on the left."""


@inlined
def lane_of(passage: np.void, rules: np.void, weight: float) -> Lane:
    """The lane through a passage, one row of `PASSAGE`."""
    shift_m = min(rules["lane_shift_m"], 0.5 * passage["half_m"])
    return Lane(
        passage["middle_x"],
        passage["middle_y"],
        passage["along_x"],
        passage["along_y"],
        shift_m,
        weight,
        rules["ahead_m"],
        rules["lane_after_m"],
        rules["left_rad"],
    )


@inlined
def _shape_of(passage: np.void) -> PassageShape:
    """The shape of a passage, one row of `PASSAGE`."""
    return PassageShape(
        passage["middle_x"],
        passage["middle_y"],
        passage["along_x"],
        passage["along_y"],
        passage["half_m"],
        passage["floor_m"],
    )


@inlined
def _set_passage(passage: np.void, shape: PassageShape) -> None:
    """Write a shape into one row of `PASSAGE`."""
    passage["middle_x"] = shape.middle_x
    passage["middle_y"] = shape.middle_y
    passage["along_x"] = shape.along_x
    passage["along_y"] = shape.along_y
    passage["half_m"] = shape.half_m
    passage["floor_m"] = shape.floor_m


@inlined
def _clear(passage: np.void) -> None:
    """Forget a passage and the agent's progress."""
    _set_passage(passage, NO_PASSAGE)
    passage["look_in_s"] = 0.0
    passage["nearest_m"] = 0.0
    passage["waited_s"] = 0.0


@kernel
def off_lane_m(lane: Lane, x: float, y: float) -> float:
    """Cost of being left of a lane, in metres of path; 0 if there is no lane to keep to.

    The cost grows with the angle to the left, so that it leads agents around those that come out
    of the passage. It begins far from the passage, so that agents are on the right in time.
    """
    if lane.weight == 0.0:
        return 0.0
    dx = x - lane.x
    dy = y - lane.y
    along = dx * lane.along_x + dy * lane.along_y
    left = lane.shift_m - (dx * lane.along_y - dy * lane.along_x)
    near = (lane.after_m if along > 0.0 else lane.before_m) - length(dx, dy)
    if near <= 0.0 or left <= 0.0:
        return 0.0
    angle = np.arctan2(left, abs(along))
    return float(lane.weight * near * min(1.0, angle / lane.left_rad))


@inlined
def _beyond(agents: Agents, a: int) -> tuple[bool, float]:
    """Whether an agent has come through its passage, and its distance from the middle in metres."""
    p = agents.passages[a]
    dx = agents.positions[a, 0] - p["middle_x"]
    dy = agents.positions[a, 1] - p["middle_y"]
    return bool(p["along_x"] * dx + p["along_y"] * dy > 0.0), length(dx, dy)


@inlined
def _has_passage(agents: Agents, a: int) -> bool:
    """Whether an agent has a passage ahead or has just come through one."""
    p = agents.passages[a]
    return bool(p["along_x"] != 0.0 or p["along_y"] != 0.0)


@inlined
def _alike(rules: np.void, one: PassageShape, other: PassageShape) -> float:
    """Cosine between the directions through two passages if they are the same one, else 0."""
    ux = one.along_x
    uy = one.along_y
    dx = other.middle_x - one.middle_x
    dy = other.middle_y - one.middle_y
    if (
        abs(dx * uy - dy * ux) < rules["same_passage_m"]
        and abs(dx * ux + dy * uy) < rules["long_passage_m"]
        and abs(other.floor_m - one.floor_m) < rules["same_passage_m"]
    ):
        return float(ux * other.along_x + uy * other.along_y)
    return 0.0


@borrowing
def see_passage(
    grid: GridArrays,
    potential: PotentialValues,
    rules: np.void,
    agents: Agents,
    a: int,
    going: bool,
    tick_s: float,
) -> None:
    """Renew an agent's passage and its progress there.

    An agent that has come through a passage keeps it for a while.
    """
    p = agents.passages[a]
    if not going:
        _clear(p)
        return
    p["look_in_s"] -= tick_s
    p["waited_s"] += tick_s
    beyond, away = _beyond(agents, a)
    if beyond and away > rules["passed_m"]:
        _clear(p)
    elif not beyond and p["look_in_s"] <= 0.0:
        x, y = agents.positions[a]
        radius = agents.parameters[a]["radius_m"]
        before = _shape_of(p)
        found, shape = find_passage(
            grid, potential, rules, agents.bodies[a], radius, agents.cells[a], x, y
        )
        if not found:
            _clear(p)
        else:
            _set_passage(p, shape)
            if _alike(rules, before, shape) <= 0.0:
                p["nearest_m"] = np.inf
        p["look_in_s"] = rules["look_s"] * (1.0 + agents.ranks[a] / len(agents.ranks))
        away = _beyond(agents, a)[1]
    if away < p["nearest_m"] - rules["progress_m"]:
        p["nearest_m"] = away
        p["waited_s"] = 0.0


@kernel
def find_contested(agents: Agents, rules: np.void, out: NDArray[np.bool_]) -> None:
    """Fill `out` (A,): whether enough others still have to come through an agent's passage against
    it."""
    out[:] = False
    coming = np.empty(len(out), dtype=np.int64)
    count = 0
    for a in range(len(out)):
        if _has_passage(agents, a) and not _beyond(agents, a)[0]:
            coming[count] = a
            count += 1
    if count < rules["contested_actors"]:
        return
    for a in range(len(out)):
        against = 0
        if _has_passage(agents, a):
            own = _shape_of(agents.passages[a])
            for n in range(count):
                if _alike(rules, own, _shape_of(agents.passages[coming[n]])) < 0.0:
                    against += 1
                    if against == rules["contested_actors"]:
                        break
        out[a] = against == rules["contested_actors"]


@kernel
def order_at_passages(
    agents: Agents, rules: np.void, contested: NDArray[np.bool_], priorities: Priorities
) -> None:
    """Give agents whose passage is contested the priority of those who leave or enter it.

    Those that leave keep it up to the goal, which may lie among those that wait. Waiting without
    progress counts in favour of those that enter, since agents that were crowded out to the side
    would otherwise stay there until all others are through. An agent that is about to arrive on
    this side goes last, as everywhere.
    """
    for a in range(len(contested)):
        if not contested[a]:
            continue
        p = agents.passages[a]
        beyond, away = _beyond(agents, a)
        if beyond:
            priorities.turns[a] = LEAVES_PASSAGE
            priorities.keys_m[a] = -away
        elif priorities.turns[a] != SETTLED:
            priorities.turns[a] = ENTERS_PASSAGE
            priorities.keys_m[a] = max(0.0, p["nearest_m"] - rules["waiting_mps"] * p["waited_s"])
