"""A small policy: straight on, pushed away from people who are near.

esplanade evaluate crowd.csv --policy examples/policies/make_way.py:MakeWay
"""

import numpy as np


class MakeWay:
    """Goes toward the goal; every person within `reach_m` metres pushes it away."""

    def __init__(self, reach_m: float = 2.0, push: float = 0.6) -> None:
        self.reach_m = reach_m
        self.push = push

    def reset(self, task):
        """Take note of how fast this body is to walk."""
        self.speed = task.preferred_speed

    def velocity(self, observation):
        """The wanted velocity, x and y in m/s."""
        ahead = observation.waypoint - observation.position
        self.wanted = self.speed * ahead / max(1e-9, np.hypot(*ahead))
        for person in observation.people:
            away = observation.position - person.position
            distance = max(0.1, np.hypot(*away))
            if distance < self.reach_m:
                self.wanted = self.wanted + self.push * away / distance * (self.reach_m - distance)
        self.path = np.stack([observation.position, observation.position + self.wanted])
        return self.wanted

    def explain(self):
        """Where it would be in a second, for pictures."""
        return {"path": self.path}
