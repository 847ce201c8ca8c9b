"""Contacts between the robot and people, found continuously between ticks."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.obstacles import point_segment_distances
from esplanade.evaluation.people import People
from esplanade.evaluation.policies.policy import Person
from esplanade.evaluation.rules import Rules

Floats = NDArray[np.float64]

TOWARD_MPS = 0.1
"""A contact is active if the robot moves faster than this toward the person."""


def closest_approach(offset: Floats, change: Floats) -> float:
    """Smallest distance, metres, of two bodies that move straight during one tick.

    `offset` (2,) is the difference of their positions at the start of the tick, and `change` (2,)
    is how much that difference changes until its end, both in metres.
    """
    passed = np.stack([offset, offset + change])[None]
    return float(point_segment_distances(np.zeros(2), passed)[0])


class ContactMonitor:
    """Counts contacts and measures clearances over one episode."""

    def __init__(self, everyone: People, rules: Rules) -> None:
        self._everyone = everyone
        self._rules = rules
        self.touched: set[int] = set()
        """The people that the robot has touched."""
        self.active = 0
        """The number of contacts in which the robot moved toward the person."""
        self.clearance_m = rules.clearance_cap_m
        """The smallest distance between the surfaces of the bodies."""
        self.near_s = 0.0
        """The time during which somebody was nearer than `Rules.near_m`."""

    def step(
        self, tick: int, people: Sequence[Person], old: Floats, velocity: Floats, new: Floats
    ) -> None:
        """Take account of the robot's step from `old` to `new` in the tick that begins at `tick`.

        `people` are those in view at the start of the tick; `old`, `velocity` and `new` are (2,),
        in metres and m/s.
        """
        nearest = np.inf
        for person in people:
            if tick + 1 > self._everyone.last[person.id]:
                continue
            offset = old - person.position
            change = (new - self._everyone.at(person.id, tick + 1)) - offset
            distance = closest_approach(offset, change)
            nearest = min(nearest, distance)
            if distance < self._rules.contact_m and person.id not in self.touched:
                self.touched.add(person.id)
                toward = -offset / max(1e-9, float(np.hypot(*offset)))
                self.active += float(velocity @ toward) > TOWARD_MPS
        clearance = nearest - self._rules.contact_m
        self.clearance_m = min(self.clearance_m, clearance)
        self.near_s += self._rules.tick_s * (clearance < self._rules.near_m)
