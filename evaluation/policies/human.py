"""The recorded pedestrian's own trajectory; people in groups walk closer than two discs."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Observation, Policy, Task


class Human(Policy):
    """Repeats the trajectory of the pedestrian whose place the robot takes.

    It is a reference that knows the recording.
    """

    follows_recording = True

    def reset(self, task: Task) -> None:
        self._trajectory = task.replay.trajectory(task.episode.pedestrian)
        self._tick_s = task.rules.tick_s
        self._next = 1

    def decide(self, observation: Observation) -> NDArray[np.float64]:
        target = self._trajectory[self._next]
        self._next += 1
        return np.asarray((target - observation.position) / self._tick_s)
