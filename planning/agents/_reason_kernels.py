"""Reasons of agents on bare arrays: what a decision says, and what the step that followed shows."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._search_kernels import NO_PATH
from esplanade.planning.agents._task_kernels import SUB, Task
from esplanade.planning.agents.agents import (
    ARRIVED,
    BLOCKED,
    GIVING_WAY,
    MOVING,
    REPLANNING,
    WAITING,
    Agents,
)
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.scene.heights import BODIES_OVERLAP_M


@inlined
def decided_reason(
    agents: Agents,
    task: Task,
    away: float,
    lost: bool,
    path: NDArray[np.float64],
    status: int,
    switched: bool,
    dodged: bool,
    step_s: float,
) -> int:
    """Why the actor does what it does; `lost` tells that no path leads to its goal."""
    if lost:
        return BLOCKED
    if dodged:
        return GIVING_WAY
    if agents.potential_rows[task.me] < 0 or agents.waits[task.me]:
        return WAITING
    if task.hold:
        return ARRIVED
    if status == NO_PATH:  # a path leads there, but every first move is taken by somebody
        return WAITING
    ramp = 2 * SUB  # slices that it takes to get going from a stand
    ahead = 2 * ramp
    pace = np.hypot(path[ahead, 0] - path[ramp, 0], path[ahead, 1] - path[ramp, 1]) / (2.0 * step_s)
    standing = np.hypot(task.vx, task.vy) < 0.15 * task.speed_mps
    if standing and pace < 0.15 * task.speed_mps and away > 4.0 * task.speed_mps * step_s:
        return WAITING
    if pace < 0.6 * task.speed_mps and away > 4.0 * task.speed_mps * step_s:
        return GIVING_WAY
    if switched:
        return REPLANNING
    return MOVING


@kernel
def _somebody_near(
    agents: Agents, radii: NDArray[np.float64], people: Prediction, somebody_m: float, a: int
) -> bool:
    """Whether a body of anybody's is near enough to give way to."""
    x = agents.positions[a, 0]
    y = agents.positions[a, 1]
    z = agents.heights[a]
    for p in range(len(people.means)):
        dx = people.means[p, 0, 0] - x
        dy = people.means[p, 0, 1] - y
        reach = radii[a] + somebody_m
        if dx * dx + dy * dy <= reach * reach and abs(people.heights[p, 0] - z) < BODIES_OVERLAP_M:
            return True
    for o in range(len(radii)):
        dx = agents.positions[o, 0] - x
        dy = agents.positions[o, 1] - y
        reach = radii[a] + radii[o] + somebody_m
        if (
            o != a
            and dx * dx + dy * dy <= reach * reach
            and abs(agents.heights[o] - z) < BODIES_OVERLAP_M
        ):
            return True
    return False


@kernel
def match_reasons(
    agents: Agents, radii: NDArray[np.float64], people: Prediction, rules: np.void
) -> None:
    """Bring the reasons of agents in line with what one sees of them after their step.

    Nobody moves along its path or takes up another one while it stands, waits while it walks, or
    gives way where nobody is. Cost O(agents + people) for each agent that says to give way.
    """
    for a in range(len(radii)):
        reason = agents.reasons[a]
        speed = np.hypot(agents.velocities[a, 0], agents.velocities[a, 1])
        if speed < rules["stands_mps"]:
            if reason in (MOVING, REPLANNING, GIVING_WAY):
                agents.reasons[a] = WAITING
        elif reason == GIVING_WAY or (reason == WAITING and speed >= rules["walks_mps"]):
            near = _somebody_near(agents, radii, people, rules["somebody_m"], a)
            agents.reasons[a] = GIVING_WAY if near else MOVING
