"""The oracle: the search of `discs`, given the true future, as a bound of what is possible."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Observation
from esplanade.evaluation.policies.space_time import STEP_S, STEPS, SpaceTimeSearch


class Oracle(SpaceTimeSearch):
    """Space-time A* among people whose true future is given; a reference, not a method."""

    margins_m = (0.2, 0.1, 0.0)
    margin_lost_mps = 0.0

    def futures(self, observation: Observation) -> NDArray[np.float64]:
        task = self._task
        now = task.episode.first_tick + round(observation.t / task.rules.tick_s)
        ticks = now + np.round(np.arange(STEPS + 1) * STEP_S / task.rules.tick_s).astype(int)
        people = task.replay.present_between(int(ticks[0]), int(ticks[-1]))
        people = people[people != task.episode.pedestrian]
        out = np.full((len(people), len(ticks), 2), np.nan)
        for row, pedestrian in enumerate(people.tolist()):
            first, last = task.replay.first[pedestrian], task.replay.last[pedestrian]
            present = (first <= ticks) & (ticks <= last)
            out[row, present] = task.replay.trajectory(pedestrian)[ticks[present] - first]
        return out
