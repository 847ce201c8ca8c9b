"""The recorded pedestrian's own way. People in groups walk closer than two discs."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Policy, Task, View


class Human(Policy):
    """Does what the one did whom the robot stands in for; a reference that knows the recording."""

    follows_recording = True

    def reset(self, task: Task) -> None:
        self._way = task.replay.way(task.episode.pedestrian)
        self._tick_s = task.rules.tick_s
        self._next = 1

    def decide(self, view: View) -> NDArray[np.float64]:
        there = self._way[self._next]
        self._next += 1
        return np.asarray((there - view.position) / self._tick_s)
