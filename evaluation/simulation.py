"""The simulation of one episode: a robot among recorded people, who may react to it."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.conduct import Conduct
from esplanade.evaluation.contacts import ContactMonitor
from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.people import NOTHING_IMPOSED, People, ReactingPeople
from esplanade.evaluation.policies.policy import Observation, Person, Policy, Prescient, Task
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.scores import Score, score
from esplanade.evaluation.waypoints import WallMap, Waypoints
from esplanade.policies.errors import PolicyFaultError

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Environment:
    """A recording prepared for episodes: the replay of its people, and the map of its walls."""

    replay: Replay
    wall_map: WallMap

    @classmethod
    def of(cls, replay: Replay) -> "Environment":
        """Prepare a replay; this takes a moment where there are walls."""
        return cls(replay, WallMap(replay))


@dataclass(frozen=True)
class EpisodeResult:
    """The score of an episode of T ticks, and the robot's positions (T + 1, 2), metres."""

    score: Score
    trajectory: Floats
    people: People
    """The people around it, up to the last tick: as they were recorded, or as they reacted."""


DecisionCallback = Callable[[Observation, Policy], None]


def run_episode(
    environment: Environment,
    episode: Episode,
    policy: Policy,
    rules: Rules,
    on_decision: DecisionCallback | None = None,
) -> EpisodeResult:
    """Run a policy on an episode; `on_decision` is called after each of its decisions.

    The episode ends where the policy fails by a `PolicyFaultError`; its score tells of it.
    """
    replay = environment.replay
    goal = np.array(episode.goal)
    waypoints = Waypoints(environment.wall_map, goal)
    reacting = ReactingPeople(replay, rules, episode) if rules.people == "reacting" else None
    everyone: People = reacting or replay
    sensor = Sensor(everyone, rules, episode)
    contacts, conduct = ContactMonitor(everyone, rules), Conduct(rules)
    trajectory = [np.array(episode.start)]
    velocities = [np.zeros(2)]
    decide_s: list[float] = []
    wall_m = np.inf
    reached = False
    fault = _begun(policy, replay, rules, episode)
    for n in range(0 if fault else round(rules.time_limit_s / rules.tick_s)):
        tick, position = episode.first_tick + n, trajectory[-1]
        people = sensor.people(n, position)
        observation = Observation(
            n * rules.tick_s, position, velocities[-1], waypoints.next_from(position), people
        )
        began_s = time.perf_counter()
        try:
            wanted = np.asarray(policy.decide(observation), dtype=np.float64)
        except PolicyFaultError as error:
            fault = f"at {observation.t:.1f} s: {error}"
            break
        finally:
            decide_s.append(time.perf_counter() - began_s)
        if on_decision is not None:
            on_decision(observation, policy)
        if not np.isfinite(wanted).all():
            wanted = np.zeros(2)
        velocity = (
            wanted if policy.follows_recording else limit_velocity(rules, velocities[-1], wanted)
        )
        if reacting is not None:
            for pedestrian in sensor.popped_in:
                reacting.leave_out(pedestrian)
            reacting.step(position, velocity, rules.robot_radius_m)
        velocities.append(velocity)
        trajectory.append(position + velocity * rules.tick_s)
        contacts.step(tick, people, position, velocity, trajectory[-1])
        conduct.step(people, position, velocity)
        wall_m = min(wall_m, replay.obstacles.distance(trajectory[-1]))
        at_end = policy.follows_recording and tick + 1 >= replay.last[episode.pedestrian]
        reached = at_end or bool(np.hypot(*(goal - trajectory[-1])) <= rules.goal_tolerance_m)
        if reached:
            break
    walked = np.array(trajectory)
    result = score(
        replay, rules, episode, contacts, sensor.pop_ins, walked,
        np.array(velocities[1:]).reshape(-1, 2), wall_m, reached, decide_s,
    )  # fmt: skip
    imposed = NOTHING_IMPOSED if reacting is None else reacting.imposed
    result = replace(result, fault=fault, **imposed._asdict(), **asdict(conduct.figures()))
    return EpisodeResult(result, walked, everyone)


def _begun(policy: Policy, replay: Replay, rules: Rules, episode: Episode) -> str:
    """Reset a policy for an episode; returns how it failed, or nothing."""
    if isinstance(policy, Prescient):
        policy.foresee(replay, episode)
    task = Task(rules, replay.name, replay.obstacles, replay.bounds, episode.start, episode.goal)
    try:
        policy.reset(task)
    except PolicyFaultError as error:
        return f"at the start: {error}"
    return ""


def limit_velocity(rules: Rules, before: Floats, wanted: Floats) -> Floats:
    """The wanted velocity cut to the greatest speed and acceleration, (2,) m/s.

    `before` is the velocity of the previous tick, (2,) m/s.
    """
    speed = float(np.hypot(*wanted))
    if speed > rules.max_speed_mps:
        wanted = wanted * (rules.max_speed_mps / speed)
    if rules.max_acceleration_mps2 is None:
        return wanted
    change = wanted - before
    acceleration = float(np.hypot(*change)) / rules.tick_s
    if acceleration > rules.max_acceleration_mps2:
        return before + change * (rules.max_acceleration_mps2 / acceleration)
    return wanted


class Sensor:
    """The robot's perfect sensor for people within its range.

    A person whose recording begins right beside the robot is left out of the whole episode.
    """

    def __init__(self, everyone: People, rules: Rules, episode: Episode) -> None:
        self._everyone = everyone
        self._rules = rules
        self._first_tick = episode.first_tick
        self._pedestrian = episode.pedestrian
        self.popped_in: set[int] = set()
        """The people who are left out because they appeared beside the robot."""

    @property
    def pop_ins(self) -> int:
        """The number of people who are left out."""
        return len(self.popped_in)

    def people(self, n: int, position: Floats) -> list[Person]:
        """The people within range at the n-th tick of the episode."""
        tick = self._first_tick + n
        present = self._everyone.present(tick)
        away = np.linalg.norm(self._everyone.positions(present, tick) - position, axis=1)
        seen = []
        for pedestrian, distance in zip(present.tolist(), away.tolist(), strict=True):
            if pedestrian == self._pedestrian or pedestrian in self.popped_in:
                continue
            appears = n > 0 and self._everyone.first[pedestrian] == tick
            if appears and distance < self._rules.pop_in_m:
                self.popped_in.add(pedestrian)
            elif distance < self._rules.sensor_range_m:
                past = self._everyone.past(pedestrian, tick, self._rules.past_ticks)
                seen.append(Person(pedestrian, past.copy()))
        return seen
