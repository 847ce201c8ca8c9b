"""The policy of the evaluation that asks a policy from outside."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies import policy as inside
from esplanade.policies.asked import AskedPolicy
from esplanade.policies.errors import PolicyError
from esplanade.policies.interface import Observation, Person, Task


class Outside(inside.Policy):
    """Asks a policy in a process of its own, or over a socket; after each fault it is begun anew.

    `options` are keywords of its constructor.
    """

    def __init__(self, name: str, options: Mapping[str, Any] | None = None) -> None:
        self._name = name
        self._asked = AskedPolicy(name, options)
        self._numbers: dict[int, int] = {}

    def start(self) -> None:
        self._asked.start()
        if "velocity" not in self._asked.decides:
            raise PolicyError(f"--policy {self._name}: it has no method velocity(observation)")

    def reset(self, task: inside.Task) -> None:
        self._rules, self._goal, self._numbers = task.rules, np.array(task.goal), {}
        rules = task.rules
        self.start()
        self._asked.reset(
            Task(
                tick_s=rules.tick_s,
                start=np.array(task.start),
                goal=self._goal,
                goal_tolerance=rules.goal_tolerance_m,
                radius=rules.robot_radius_m,
                preferred_speed=rules.speed_mps,
                greatest_speed=rules.max_speed_mps,
                greatest_acceleration=rules.max_acceleration_mps2,
                walls=task.obstacles.outline,
                bounds=task.bounds,
            )
        )

    def decide(self, observation: inside.Observation) -> NDArray[np.float64]:
        return self._asked.velocity(
            Observation(
                observation.t,
                observation.position,
                observation.velocity,
                self._goal,
                observation.waypoint,
                [self._seen(person) for person in observation.people],
            )
        )

    def debug_info(self) -> inside.DebugInfo:
        return inside.DebugInfo(*self._asked.explain())

    def close(self) -> None:
        self._asked.close()

    def _seen(self, person: inside.Person) -> Person:
        """A person, by a number that tells nothing of when the recording has them."""
        number = self._numbers.setdefault(person.id, len(self._numbers) + 1)
        velocity, radius_m = person.velocity(self._rules.tick_s), self._rules.person_radius_m
        return Person(number, person.position, velocity, radius_m, person.track)
