"""A policy from outside, as whoever asks it sees it."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from esplanade.policies.errors import PolicyError, PolicyFaultError
from esplanade.policies.interface import Floats, Observation, Task
from esplanade.policies.lines import PolicyLine, PolicyProcess, PolicySocket
from esplanade.policies.messages import (
    DECISIONS,
    MessageError,
    numbers_of,
    told_observation,
    told_task,
)
from esplanade.policies.names import address_of, place_of

STARTS_WITHIN_S: Final = 120.0
"""A policy may load what it needs, such as weights, for so long."""
DECIDES_WITHIN_S: Final = 5.0
"""A policy that takes longer for a decision has failed, as a rule."""
_DRAWN: Final = range(10_000)
_ONE: Final = range(1, 2)


class AskedPolicy:
    """Asks a policy in a process of its own, or over a socket; after each fault it is begun anew.

    `options` are keywords of its constructor. Every call waits for the answer.
    """

    def __init__(
        self,
        name: str,
        options: Mapping[str, Any] | None = None,
        decides_within_s: float | None = None,
    ) -> None:
        self._name = name
        self._options = dict(options or {})
        self._decides_within_s = DECIDES_WITHIN_S if decides_within_s is None else decides_within_s
        self._line: PolicyLine | None = None
        self.decides: frozenset[str] = frozenset()
        """Those of `DECISIONS` that it takes; known once it was started."""

    def start(self) -> None:
        """Begin its process, or call where it listens, if that is not done.

        Raises
        ------
        PolicyError
            It cannot be made, or nobody listens there.
        """
        if self._line is not None:
            return
        self._line = self._opened()
        load = {"ask": "load", "policy": place_of(self._name), "options": self._options}
        try:
            told = self._ask(load, STARTS_WITHIN_S).get("decides", DECISIONS[:1])
        except PolicyFaultError as fault:
            raise PolicyError(f"--policy {self._name}: {fault}") from None
        named = told if isinstance(told, list | tuple) else ()
        self.decides = frozenset(name for name in DECISIONS if name in named)
        if not self.decides:
            self.close()
            raise PolicyError(f"--policy {self._name}: it decides none of {', '.join(DECISIONS)}")

    def _opened(self) -> PolicyLine:
        address = address_of(self._name)
        if address is None:
            return PolicyProcess()
        try:
            return PolicySocket(*address, DECIDES_WITHIN_S)
        except OSError as error:
            reason = error.strerror or str(error)
            raise PolicyError(f"--policy {self._name}: {reason}; is it started?") from None

    def reset(self, task: Task) -> None:
        """Begin a trip, and the policy if need be.

        Raises
        ------
        PolicyError
            As of `start`.
        PolicyFaultError
            It failed.
        """
        self.start()
        self._ask({"ask": "reset", "task": told_task(task)}, STARTS_WITHIN_S)

    def velocity(self, observation: Observation) -> Floats:
        """Its decision, the wanted velocity, float64 (2,), m/s.

        Raises
        ------
        PolicyFaultError
            It failed, or took too long.
        """
        question = {"ask": "velocity", "observation": told_observation(observation)}
        answer = self._ask(question, self._decides_within_s)
        wanted: Floats = self._numbers_in(answer, "velocity", 2, _ONE)[0]
        return wanted

    def goal(self, observation: Observation) -> tuple[float, ...] | None:
        """The goal that it decides on, x and y, metres, or with the height of the floor.

        Raises
        ------
        PolicyFaultError
            As of `velocity`.
        """
        answer = self._ask(
            {"ask": "goal", "observation": told_observation(observation)}, self._decides_within_s
        )
        given = answer.get("goal")
        if given is None:
            return None
        width = 3 if isinstance(given, list) and len(given) == 3 else 2
        return tuple(self._numbers_in(answer, "goal", width, _ONE)[0].tolist())

    def explain(self) -> tuple[Floats, Floats]:
        """Its plan, float64 (K, 2), and the circles of its predictions, float64 (n, 3), metres.

        Raises
        ------
        PolicyFaultError
            As of `velocity`.
        """
        answer = {"path": [], "circles": []} | self._ask({"ask": "explain"}, self._decides_within_s)
        return (
            self._numbers_in(answer, "path", 2, _DRAWN),
            self._numbers_in(answer, "circles", 3, _DRAWN),
        )

    def end(self) -> None:
        """End the policy, while another thread may wait for its answer; `close` comes later."""
        if self._line is not None:
            self._line.end()

    def close(self) -> None:
        """End what was begun. The next reset begins anew."""
        if self._line is not None:
            self._line.close()
            self._line = None

    def _ask(self, question: Mapping[str, Any], within_s: float) -> dict[str, Any]:
        if self._line is None:
            raise RuntimeError("call reset before the first decision")
        try:
            return self._line.ask(question, within_s)
        except PolicyFaultError:
            self.close()
            raise

    def _numbers_in(self, answer: Mapping[str, Any], name: str, width: int, rows: range) -> Floats:
        """Rows of numbers in an answer; it is a fault if they are not there."""
        try:
            return np.asarray(numbers_of(answer.get(name), name, width, rows))
        except MessageError as error:
            self.close()
            raise PolicyFaultError(str(error)) from None
