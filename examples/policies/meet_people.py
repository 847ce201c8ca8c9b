"""A small behaviour: go to whoever is near and alone, else look about at random.

esplanade serve --policy examples/policies/meet_people.py:MeetPeople --policy-actors 2
"""

import numpy as np


class MeetPeople:
    """Chooses where its actor goes; how it gets there is planned by the server."""

    def __init__(self, seed: int = 0, apart_m: float = 1.5) -> None:
        self.chance = np.random.default_rng(seed)
        self.apart_m = apart_m

    def reset(self, task):
        """Take note of where the scene ends."""
        x0, y0, x1, y1 = task.bounds
        self.least, self.most = np.array([x0, y0]), np.array([x1, y1])

    def goal(self, observation):
        """The next place to go to, x and y in metres."""
        places = np.array([person.position for person in observation.people]).reshape(-1, 2)
        for place in places:
            company = np.hypot(*(places - place).T) < 2.0 * self.apart_m
            if company.sum() == 1:
                offset = observation.position - place
                beside = place + self.apart_m * offset / max(1e-9, np.hypot(*offset))
                return np.clip(beside, self.least, self.most)
        place = observation.position + self.chance.normal(0.0, 4.0, 2)
        return np.clip(place, self.least, self.most)
