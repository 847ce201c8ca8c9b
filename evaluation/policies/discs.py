"""The usual baseline, done carefully: people are hard discs that keep their velocity."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Observation, Person
from esplanade.evaluation.policies.space_time import STEP_S, STEPS, SpaceTimeSearch

PAST_TICKS: Final = 8
"""Velocities are means over this time: over less they are noisy, over more out of date."""


class Discs(SpaceTimeSearch):
    """Space-time A* among people who are predicted to keep their velocity."""

    margins_m = (0.3, 0.15, 0.0)
    margin_lost_mps = 0.05

    def futures(self, observation: Observation) -> NDArray[np.float64]:
        ahead_s = (np.arange(STEPS + 1) * STEP_S)[:, None]
        tick_s = self._task.rules.tick_s
        rows = [p.position + ahead_s * _velocity(p, tick_s) for p in observation.people]
        return np.array(rows).reshape(-1, STEPS + 1, 2)


def _velocity(person: Person, tick_s: float) -> NDArray[np.float64]:
    recent = person.track[-(PAST_TICKS + 1) :]
    return np.asarray((recent[-1] - recent[0]) / (tick_s * max(1, len(recent) - 1)))
