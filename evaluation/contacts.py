"""Who comes how near to the robot, continuously between ticks."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Person
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules

Floats = NDArray[np.float64]

TOWARD_MPS = 0.1
"""A robot that moves faster than this toward whom it touches did it itself."""


def closest_approach(offset: Floats, change: Floats) -> float:
    """Least length of `offset` + u · `change` for u from 0 to 1, metres."""
    square = float(change @ change)
    share = 0.0 if square < 1e-12 else min(1.0, max(0.0, -float(offset @ change) / square))
    return float(np.hypot(*(offset + share * change)))


class Encounters:
    """Adds up contacts and clearances over an episode."""

    def __init__(self, replay: Replay, rules: Rules) -> None:
        self._replay = replay
        self._rules = rules
        self.met: set[int] = set()
        """Whom the robot has touched."""
        self.caused = 0
        """Contacts in which the robot moved toward the person."""
        self.clearance_m = rules.clearance_cap_m
        """Least distance, skin to skin."""
        self.near_s = 0.0

    def step(
        self, tick: int, people: Sequence[Person], old: Floats, velocity: Floats, new: Floats
    ) -> None:
        """The robot went from `old` to `new` in the tick that begins at `tick`."""
        nearest = np.inf
        for person in people:
            if tick + 1 > self._replay.last[person.id]:
                continue
            offset = old - person.position
            change = (new - self._replay.at(person.id, tick + 1)) - offset
            distance = closest_approach(offset, change)
            nearest = min(nearest, distance)
            if distance < self._rules.contact_m and person.id not in self.met:
                self.met.add(person.id)
                toward = -offset / max(1e-9, float(np.hypot(*offset)))
                self.caused += float(velocity @ toward) > TOWARD_MPS
        clearance = nearest - self._rules.contact_m
        self.clearance_m = min(self.clearance_m, clearance)
        self.near_s += self._rules.tick_s * (clearance < self._rules.near_m)
