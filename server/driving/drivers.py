"""Asks policies for the velocities of the actors that they drive, beside the ticks of a zone."""

from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, Final

import structlog

from esplanade.policies.asked import AskedPolicy
from esplanade.policies.errors import PolicyError, PolicyFaultError
from esplanade.policies.interface import Observation, Task
from esplanade.policies.names import label_of
from esplanade.server.driving.settings import DRIVEN_TAG, MOST_DRIVEN
from esplanade.server.driving.sights import Sights
from esplanade.server.metrics import Metrics
from esplanade.server.world.inputs import Input, SendActors, SteerActors
from esplanade.server.world.routes import Point
from esplanade.server.world.zone import Zone

ASKS_EVERY_S: Final = 0.1
"""As in episodes of `esplanade evaluate`."""
DECIDES_WITHIN_S: Final = 1.0
"""A policy that takes longer for a decision has failed."""
HOLDS_S: Final = 0.5
"""A velocity holds for so long without another; then the actor stands."""
REST_S: Final = 5.0
"""So long after a fault a policy is begun anew."""
ASKED_AGAIN_S: Final = 1.0
"""So long after a policy has decided on no goal it is asked again."""
NO_COMMAND: Final = 0
"""The number of commands that nobody waits for."""
_STAND: Final = (0.0, 0.0)

log = structlog.get_logger(__name__)


@dataclass
class _Decision:
    """The answer of a policy: a velocity, or a place to go to, or neither."""

    velocity: tuple[float, float] | None = None
    goal: Point | None = None


@dataclass
class _Driven:
    """An actor that is driven, and what is known of its policy."""

    policy: AskedPolicy
    answer: Future[_Decision] | None = None
    velocity: tuple[float, float] = _STAND
    decided_tick: int = 0
    goal: Point | None = None
    begun_tick: int = 0
    ready_tick: int = 0
    """The policy is not asked before this tick."""
    came: bool = False
    """Whether it has been told where to go since it came."""


class Drivers:
    """One policy for each actor with the tag `policy`, each in a thread of its own.

    Call `observe` after each tick and `drain` before the next. No tick waits for a policy: what it
    decides is an input of the tick that begins next, and a recording has it. While a policy is
    silent, failed or without a trip its actor stands; each fault is logged and counted. Policies
    are asked ten times a second. Cost in every tenth of a second: O(slots), and O(people near) for
    each driven actor.
    """

    def __init__(self, zone: Zone, name: str, options: Mapping[str, Any], metrics: Metrics) -> None:
        self._zone = zone
        self._name = name
        self._make: Callable[[], AskedPolicy] = lambda: AskedPolicy(name, options, DECIDES_WITHIN_S)
        self._every = max(1, round(ASKS_EVERY_S / zone.tick_s))
        self._sights = Sights(zone, self._every * zone.tick_s)
        self._threads = ThreadPoolExecutor(MOST_DRIVEN, thread_name_prefix="policy")
        self._driven: dict[str, _Driven] = {}
        self._decides: frozenset[str] = frozenset()
        self._decisions = 0
        self._faults = 0
        metrics.total(
            "policy_decisions", "Decisions of policies from outside", lambda: self._decisions
        )
        metrics.total("policy_faults", "Faults of policies from outside", lambda: self._faults)
        metrics.gauge("policy_actors", "Actors that policies drive", lambda: len(self._driven))

    def start(self) -> None:
        """Begin the policy once, so that what is wrong with its name or file is known at once.

        Raises
        ------
        PolicyError
            It cannot be made.
        """
        policy = self._make()
        try:
            policy.start()
            self._decides = policy.decides
        finally:
            policy.close()

    def observe(self) -> None:
        """Ask each policy that is idle what its actor is to do, if it is time to."""
        if self._zone.tick % self._every:
            return
        self._sights.tracks.keep()
        self._match_actors()
        for actor_id, driven in self._driven.items():
            if driven.answer is not None or self._zone.tick < driven.ready_tick:
                continue
            if not self._sights.is_there(actor_id):
                continue
            goal = self._sights.goal(actor_id)
            chooses = "goal" in self._decides
            if goal is None or (chooses and not driven.came):
                driven.goal, driven.velocity = None, _STAND
                if chooses:
                    self._ask_where(actor_id, driven)
                continue
            if "velocity" not in self._decides:
                continue
            task = None
            if goal != driven.goal:
                driven.goal, driven.begun_tick = goal, self._zone.tick
                task = self._sights.task(actor_id, goal)
            seen = self._sights.observation(actor_id, goal, driven.begun_tick)
            driven.answer = self._threads.submit(_velocity, driven.policy, task, seen)

    def _ask_where(self, actor_id: str, driven: _Driven) -> None:
        place = self._sights.place(actor_id)
        task = None if driven.came else self._sights.task(actor_id, place)
        seen = self._sights.observation(actor_id, place, self._zone.tick)
        driven.came = True
        driven.answer = self._threads.submit(_goal, driven.policy, task, seen, place[2])

    def drain(self) -> list[Input]:
        """The velocities of all driven actors in the next tick, and their new goals."""
        inputs: list[Input] = []
        for actor_id, driven in self._driven.items():
            if driven.answer is not None and driven.answer.done():
                inputs += self._take(actor_id, driven)
            held_s = (self._zone.tick - driven.decided_tick) * self._zone.tick_s
            if held_s > HOLDS_S:
                driven.velocity = _STAND
        if self._driven and "velocity" in self._decides:
            velocities = tuple(driven.velocity for driven in self._driven.values())
            inputs.append(SteerActors(tuple(self._driven), velocities))
        return inputs

    def close(self) -> None:
        """End all policies."""
        for driven in self._driven.values():
            driven.policy.end()
        self._threads.shutdown(cancel_futures=True)
        for driven in self._driven.values():
            driven.policy.close()

    def _take(self, actor_id: str, driven: _Driven) -> list[Input]:
        """Take in what a policy has decided, or that it has failed; the input that follows."""
        answer, driven.answer = driven.answer, None
        try:
            decided = _Decision() if answer is None else answer.result()
            self._decisions += 1
            if decided.velocity is not None:
                driven.velocity, driven.decided_tick = decided.velocity, self._zone.tick
            elif decided.goal is None:
                driven.ready_tick = self._zone.tick + round(ASKED_AGAIN_S / self._zone.tick_s)
            else:
                self._sights.check_goal(decided.goal)
                return [SendActors(NO_COMMAND, (actor_id,), decided.goal)]
        except (PolicyError, PolicyFaultError) as fault:
            self._failed(actor_id, driven, str(fault))
        except Exception as error:
            # The world goes on, as when a process cannot be begun because there are too many.
            log.exception("a policy cannot be asked", actor=actor_id)
            self._failed(actor_id, driven, f"{type(error).__name__}: {error}")
        return []

    def _failed(self, actor_id: str, driven: _Driven, fault: str) -> None:
        """Count and tell a fault, and let the actor stand until the policy is begun anew."""
        self._faults += 1
        driven.velocity, driven.goal, driven.came = _STAND, None, False
        driven.ready_tick = self._zone.tick + round(REST_S / self._zone.tick_s)
        log.warning(
            "a policy failed",
            policy=label_of(self._name),
            actor=actor_id,
            fault=fault,
            again_in_s=REST_S,
        )

    def _match_actors(self) -> None:
        """Have a policy for each actor with the tag, as long as there are not too many."""
        wanted = [
            str(actor_id) for actor_id, spec in self._zone.actors.items() if DRIVEN_TAG in spec.tags
        ][:MOST_DRIVEN]
        for actor_id in self._driven.keys() - set(wanted):
            driven = self._driven.pop(actor_id)
            driven.policy.end()
            self._threads.submit(_closed, driven)
        for actor_id in wanted:
            if actor_id not in self._driven:
                self._driven[actor_id] = _Driven(self._make())


def _velocity(policy: AskedPolicy, task: Task | None, seen: Observation) -> _Decision:
    """Ask a policy how to go on, in a thread; a trip that begins is told first."""
    if task is not None:
        policy.reset(task)
    x, y = policy.velocity(seen).tolist()
    return _Decision(velocity=(x, y))


def _goal(policy: AskedPolicy, task: Task | None, seen: Observation, z_m: float) -> _Decision:
    """Ask a policy where to go, in a thread; without a height on the floor of that height.

    One that has just begun is told of a trip to where it stands, so that it knows its surroundings.
    """
    if task is not None:
        policy.reset(task)
    found = policy.goal(seen)
    if found is None:
        return _Decision()
    x, y, z = (*found, z_m)[:3]
    return _Decision(goal=(x, y, z))


def _closed(driven: _Driven) -> None:
    """Close the policy of an actor that has gone, once nobody waits for its answer."""
    if driven.answer is not None:
        driven.answer.exception()
    driven.policy.close()
