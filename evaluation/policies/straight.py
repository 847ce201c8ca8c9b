"""The lower bound: the robot goes straight on at the preferred speed and ignores people."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import DebugInfo, Observation, Policy, Task


class Straight(Policy):
    """Walks from waypoint to waypoint and ignores everybody."""

    def reset(self, task: Task) -> None:
        self._rules = task.rules
        self._path = np.zeros((0, 2))

    def decide(self, observation: Observation) -> NDArray[np.float64]:
        offset = observation.waypoint - observation.position
        length_m = float(np.linalg.norm(offset))
        speed_mps = min(self._rules.speed_mps, length_m / self._rules.tick_s)
        self._path = np.stack([observation.position, observation.waypoint])
        return offset / max(length_m, 1e-9) * speed_mps

    def debug_info(self) -> DebugInfo:
        return DebugInfo(path=self._path)
