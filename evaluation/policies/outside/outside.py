"""The policy of the evaluation that asks a policy from outside."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies import policy as inside
from esplanade.evaluation.policies.outside.interface import Observation, Person, Task
from esplanade.evaluation.policies.outside.lines import PolicyLine, PolicyProcess, PolicySocket
from esplanade.evaluation.policies.outside.messages import (
    MessageError,
    numbers_of,
    told_observation,
    told_task,
)
from esplanade.evaluation.policy_names import address_of, place_of

STARTS_WITHIN_S: Final = 120.0
"""A policy may load what it needs, such as weights, for so long."""
DECIDES_WITHIN_S: Final = 5.0
"""A policy that takes longer for a decision has failed."""
_DRAWN: Final = range(10_000)
_ONE: Final = range(1, 2)


class Outside(inside.Policy):
    """Asks a policy in a process of its own, or over a socket; after each fault it is begun anew.

    `options` are keywords of its constructor.
    """

    def __init__(self, name: str, options: Mapping[str, Any] | None = None) -> None:
        self._name = name
        self._options = dict(options or {})
        self._line: PolicyLine | None = None
        self._numbers: dict[int, int] = {}

    def start(self) -> None:
        if self._line is not None:
            return
        self._line = self._opened()
        load = {"ask": "load", "policy": place_of(self._name), "options": self._options}
        try:
            self._ask(load, STARTS_WITHIN_S)
        except inside.PolicyFaultError as fault:
            raise inside.PolicyError(f"--policy {self._name}: {fault}") from None

    def _opened(self) -> PolicyLine:
        address = address_of(self._name)
        if address is None:
            return PolicyProcess()
        try:
            return PolicySocket(*address, DECIDES_WITHIN_S)
        except OSError as error:
            reason = error.strerror or str(error)
            raise inside.PolicyError(f"--policy {self._name}: {reason}; is it started?") from None

    def reset(self, task: inside.Task) -> None:
        self.start()
        self._rules, self._goal, self._numbers = task.rules, np.array(task.goal), {}
        rules = task.rules
        told = Task(
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
        self._ask({"ask": "reset", "task": told_task(told)}, STARTS_WITHIN_S)

    def decide(self, observation: inside.Observation) -> NDArray[np.float64]:
        seen = Observation(
            observation.t,
            observation.position,
            observation.velocity,
            self._goal,
            observation.waypoint,
            [self._seen(person) for person in observation.people],
        )
        question = {"ask": "velocity", "observation": told_observation(seen)}
        answer = self._ask(question, DECIDES_WITHIN_S)
        wanted: NDArray[np.float64] = self._numbers_in(answer, "velocity", 2, _ONE)[0]
        return wanted

    def debug_info(self) -> inside.DebugInfo:
        answer = {"path": [], "circles": []} | self._ask({"ask": "explain"}, DECIDES_WITHIN_S)
        return inside.DebugInfo(
            self._numbers_in(answer, "path", 2, _DRAWN),
            self._numbers_in(answer, "circles", 3, _DRAWN),
        )

    def close(self) -> None:
        if self._line is not None:
            self._line.close()
            self._line = None

    def _seen(self, person: inside.Person) -> Person:
        """A person, by a number that tells nothing of when the recording has them."""
        number = self._numbers.setdefault(person.id, len(self._numbers) + 1)
        track, tick_s = person.track, self._rules.tick_s
        moved = track[-1] - track[-2] if len(track) > 1 else np.zeros(2)
        return Person(number, track[-1], moved / tick_s, self._rules.person_radius_m, track)

    def _ask(self, question: Mapping[str, Any], within_s: float) -> dict[str, Any]:
        if self._line is None:
            raise RuntimeError("call reset before the first decision")
        try:
            return self._line.ask(question, within_s)
        except inside.PolicyFaultError:
            self.close()
            raise

    def _numbers_in(
        self, answer: Mapping[str, Any], name: str, width: int, rows: range
    ) -> NDArray[np.float64]:
        """Rows of numbers in an answer; it is a fault if they are not there."""
        try:
            return numbers_of(answer.get(name), name, width, rows)
        except MessageError as error:
            self.close()
            raise inside.PolicyFaultError(str(error)) from None
