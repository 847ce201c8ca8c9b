"""Straight on at the preferred speed, whoever is in the way: what doing nothing costs."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Policy, Task, Thoughts, View


class Straight(Policy):
    """Walks from waypoint to waypoint and sees nobody."""

    def reset(self, task: Task) -> None:
        self._rules = task.rules
        self._path = np.zeros((0, 2))

    def decide(self, view: View) -> NDArray[np.float64]:
        way = view.waypoint - view.position
        length_m = float(np.linalg.norm(way))
        speed_mps = min(self._rules.speed_mps, length_m / self._rules.tick_s)
        self._path = np.stack([view.position, view.waypoint])
        return way / max(length_m, 1e-9) * speed_mps

    def thoughts(self) -> Thoughts:
        return Thoughts(path=self._path)
