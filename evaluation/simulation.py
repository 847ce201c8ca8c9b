"""One episode: a robot among replayed people who do not react."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.contacts import Encounters
from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.policies.policy import Person, Policy, Task, View
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.scores import Score, score
from esplanade.evaluation.waypoints import WallMap, Waypoints

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Ground:
    """A recording made ready for episodes: who is where, and the ways among its walls."""

    replay: Replay
    walls: WallMap

    @classmethod
    def of(cls, replay: Replay) -> "Ground":
        return cls(replay, WallMap(replay))


@dataclass(frozen=True)
class Run:
    """What came of an episode: its score, and the way walked, a place a tick, (T + 1, 2)."""

    score: Score
    way: Floats


Watcher = Callable[[View, Policy], None]


def run_episode(
    ground: Ground,
    episode: Episode,
    policy: Policy,
    rules: Rules,
    watch: Watcher | None = None,
) -> Run:
    """Send a policy on a trip; `watch` is called after each of its decisions."""
    replay = ground.replay
    policy.reset(Task(rules, replay, episode))
    goal = np.array(episode.goal)
    waypoints = Waypoints(ground.walls, goal)
    sight = Sight(replay, rules, episode)
    encounters = Encounters(replay, rules)
    way = [np.array(episode.start)]
    velocities = [np.zeros(2)]
    decide_s: list[float] = []
    wall_m = np.inf
    reached = False
    for n in range(round(rules.time_limit_s / rules.tick_s)):
        tick, position = episode.first_tick + n, way[-1]
        people = sight.people(n, position)
        view = View(
            n * rules.tick_s, position, velocities[-1], waypoints.next_from(position), people
        )
        began_s = time.perf_counter()
        wanted = np.asarray(policy.decide(view), dtype=np.float64)
        decide_s.append(time.perf_counter() - began_s)
        if watch is not None:
            watch(view, policy)
        if not np.isfinite(wanted).all():
            wanted = np.zeros(2)
        velocity = wanted if policy.follows_recording else limited(rules, velocities[-1], wanted)
        velocities.append(velocity)
        way.append(position + velocity * rules.tick_s)
        encounters.step(tick, people, position, velocity, way[-1])
        wall_m = min(wall_m, replay.obstacles.distance(way[-1]))
        at_end = policy.follows_recording and tick + 1 >= replay.last[episode.pedestrian]
        reached = at_end or bool(np.hypot(*(goal - way[-1])) <= rules.goal_tolerance_m)
        if reached:
            break
    walked = np.array(way)
    result = score(
        replay, rules, episode, encounters, sight.pop_ins, walked, np.array(velocities[1:]),
        wall_m, reached, decide_s,
    )  # fmt: skip
    return Run(result, walked)


def limited(rules: Rules, before: Floats, wanted: Floats) -> Floats:
    """The velocity that the limits of speed and acceleration leave of a wanted one."""
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


class Sight:
    """Whom the robot sees. Who appears right beside it counts as not there, for all its time."""

    def __init__(self, replay: Replay, rules: Rules, episode: Episode) -> None:
        self._replay = replay
        self._rules = rules
        self._first_tick = episode.first_tick
        self._ignored = {episode.pedestrian}
        self.pop_ins = 0

    def people(self, n: int, position: Floats) -> list[Person]:
        """Everyone in sight at the n-th tick of the episode."""
        tick = self._first_tick + n
        present = self._replay.present(tick)
        away = np.linalg.norm(self._replay.positions(present, tick) - position, axis=1)
        seen = []
        for pedestrian, distance in zip(present.tolist(), away.tolist(), strict=True):
            if pedestrian in self._ignored:
                continue
            appears = n > 0 and self._replay.first[pedestrian] == tick
            if appears and distance < self._rules.pop_in_m:
                self._ignored.add(pedestrian)
                self.pop_ins += 1
            elif distance < self._rules.sight_m:
                past = self._replay.past(pedestrian, tick, self._rules.past_ticks)
                seen.append(Person(pedestrian, past.copy()))
        return seen
