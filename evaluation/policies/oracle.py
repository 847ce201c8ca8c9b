"""The oracle: the search of `discs`, given the true future, as a bound of what is possible."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.policies.policy import Observation, Prescient
from esplanade.evaluation.policies.space_time import STEP_S, STEPS, SpaceTimeSearch
from esplanade.evaluation.replay import Replay


class Oracle(SpaceTimeSearch, Prescient):
    """Space-time A* among people whose true future is given; a reference, not a method."""

    margins_m = (0.2, 0.1, 0.0)
    margin_lost_mps = 0.0

    def foresee(self, replay: Replay, episode: Episode) -> None:
        self._replay, self._episode = replay, episode

    def futures(self, observation: Observation) -> NDArray[np.float64]:
        replay, tick_s = self._replay, self._task.rules.tick_s
        now = self._episode.first_tick + round(observation.t / tick_s)
        ticks = now + np.round(np.arange(STEPS + 1) * STEP_S / tick_s).astype(int)
        people = replay.present_between(int(ticks[0]), int(ticks[-1]))
        people = people[people != self._episode.pedestrian]
        out = np.full((len(people), len(ticks), 2), np.nan)
        for row, pedestrian in enumerate(people.tolist()):
            first, last = replay.first[pedestrian], replay.last[pedestrian]
            present = (first <= ticks) & (ticks <= last)
            out[row, present] = replay.trajectory(pedestrian)[ticks[present] - first]
        return out
