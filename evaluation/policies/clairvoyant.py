"""The same search, shown what people will really do: how well anyone could do."""

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import View
from esplanade.evaluation.policies.space_time import STEP_S, STEPS, SpaceTimeSearch


class Clairvoyant(SpaceTimeSearch):
    """Space-time A* among people whose future is known; a reference, not a method."""

    margins_m = (0.2, 0.1, 0.0)
    margin_lost_mps = 0.0

    def futures(self, view: View) -> NDArray[np.float64]:
        task = self._task
        now = task.episode.first_tick + round(view.t / task.rules.tick_s)
        ticks = now + np.round(np.arange(STEPS + 1) * STEP_S / task.rules.tick_s).astype(int)
        people = task.replay.present_between(int(ticks[0]), int(ticks[-1]))
        people = people[people != task.episode.pedestrian]
        out = np.full((len(people), len(ticks), 2), np.nan)
        for row, pedestrian in enumerate(people.tolist()):
            first, last = task.replay.first[pedestrian], task.replay.last[pedestrian]
            there = (first <= ticks) & (ticks <= last)
            out[row, there] = task.replay.way(pedestrian)[ticks[there] - first]
        return out
