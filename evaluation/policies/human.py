"""The recorded pedestrian's own trajectory; people in groups walk closer than two discs."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.policies.policy import Observation, Prescient, Task
from esplanade.evaluation.replay import Replay


class Human(Prescient):
    """Repeats the trajectory of the pedestrian whose place the robot takes.

    It is a reference that knows the recording.
    """

    follows_recording = True

    def foresee(self, replay: Replay, episode: Episode) -> None:
        self._trajectory = replay.trajectory(episode.pedestrian)

    def reset(self, task: Task) -> None:
        self._tick_s = task.rules.tick_s
        self._next = 1

    def decide(self, observation: Observation) -> NDArray[np.float64]:
        target = self._trajectory[self._next]
        self._next += 1
        return np.asarray((target - observation.position) / self._tick_s)
