"""PettingZoo's parallel environment: several robots among recorded or reacting people."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from esplanade.evaluation.episodes import FREE_START_M, MIN_DISTANCE_M, Episode
from esplanade.evaluation.learning.features import size_of, velocity_of
from esplanade.evaluation.learning.rewards import Rewards
from esplanade.evaluation.learning.robots import Outcome, Robots
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.trials import Source

MOMENTS_EVERY: Final = 10
"""Ticks from one moment at which all may begin to the next."""

Seen = NDArray[np.float32]


class CrowdEnv(ParallelEnv[str, Seen, NDArray[np.float32]]):
    """Robots that take the places of people who walk at one moment, another one in each episode.

    Each goes where its person went, sees the others as people, and is gone once its own trip has
    ended. Observations, actions and rewards are those of `trips.TripEnv`.

    Parameters
    ----------
    robots :
        How many there are, `robot_0` and so on.

    Raises
    ------
    ValueError
        There is no moment at which so many people are on trips, or the recording cannot be read.
    """

    metadata: dict[str, Any] = {"name": "esplanade_crowd_v0", "render_modes": []}  # noqa: RUF012 - PettingZoo's way

    def __init__(
        self,
        recording: str | Path,
        robots: int,
        people: Literal["recorded", "reacting"] = "recorded",
        reaction: float = 1.0,
        nearest: int = 8,
        rewards: Rewards | None = None,
    ) -> None:
        self._rules = Rules(people=people, reaction=reaction)
        self._environment = Source(Path(recording)).environment(self._rules.tick_s)
        self._moments = list(_moments(self._environment.replay, self._rules, robots))
        if not self._moments:
            raise ValueError(f"{recording}: there is no moment at which {robots} people make trips")
        self._nearest = nearest
        self._rewards = rewards or Rewards()
        self._robots: Robots | None = None
        self._random = np.random.default_rng()
        self.render_mode = None
        self.possible_agents = [f"robot_{k}" for k in range(robots)]
        self.agents: list[str] = []
        box = (-1.0, 1.0)
        self.observation_spaces = {
            agent: spaces.Box(*box, (size_of(nearest),), np.float32)
            for agent in self.possible_agents
        }
        self.action_spaces = {
            agent: spaces.Box(*box, (2,), np.float32) for agent in self.possible_agents
        }

    def observation_space(self, agent: str) -> spaces.Box:
        """The space of what an agent sees."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Box:
        """The space of an agent's actions."""
        return self.action_spaces[agent]

    def reset(
        self,
        seed: int | None = None,
        options: dict[str, Any] | None = None,  # noqa: ARG002 - PettingZoo's interface
    ) -> tuple[dict[str, Seen], dict[str, dict[str, Any]]]:
        """Begin at a moment, drawn by the generator, in the places of people drawn by it."""
        if seed is not None:
            self._random = np.random.default_rng(seed)
        trips = self._moments[self._random.integers(len(self._moments))]
        drawn = self._random.choice(len(trips), len(self.possible_agents), replace=False)
        self._robots = Robots(self._environment, self._rules, [trips[k] for k in drawn])
        self.agents = list(self.possible_agents)
        seen = {a: self._seen(self._robots, k) for k, a in enumerate(self.agents)}
        return seen, {agent: {} for agent in self.agents}

    def step(
        self, actions: dict[str, NDArray[np.float32]]
    ) -> tuple[
        dict[str, Seen],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Walk for one tick of 0.1 s."""
        if self._robots is None:
            raise RuntimeError("call reset before the first step")
        going = {agent: self.possible_agents.index(agent) for agent in self.agents}
        wanted: list[NDArray[np.float64] | None] = [None] * len(self.possible_agents)
        for agent, k in going.items():
            robot = self._robots.all[k]
            wanted[k] = velocity_of(
                actions[agent], robot.position, robot.waypoint, self._rules.max_speed_mps
            )
        if going:
            self._robots.step(wanted)
        ended = {agent: self._robots.all[k].outcome for agent, k in going.items()}
        self.agents = [agent for agent in self.agents if ended[agent] is None]
        return (
            {agent: self._seen(self._robots, k) for agent, k in going.items()},
            {a: self._rewards.of(self._robots.all[k], self._rules) for a, k in going.items()},
            {agent: how not in (None, Outcome.LATE) for agent, how in ended.items()},
            {agent: how is Outcome.LATE for agent, how in ended.items()},
            {agent: {"outcome": how.value} if how else {} for agent, how in ended.items()},
        )

    def _seen(self, robots: Robots, k: int) -> Seen:
        return robots.features(robots.all[k], self._nearest)


def _moments(replay: Replay, rules: Rules, robots: int) -> Iterator[list[Episode]]:
    """Trips of people from where they are, for each moment with enough of them."""
    for tick in range(0, replay.end_tick, MOMENTS_EVERY):
        present = replay.present(tick)
        places = replay.positions(present, tick)
        trips: list[Episode] = []
        for person, place in zip(present.tolist(), places, strict=True):
            goal = replay.trajectory(person)[-1]
            gaps = np.linalg.norm(places - place, axis=1)
            walls_m = min(replay.obstacles.distance(place), replay.obstacles.distance(goal))
            if (
                np.hypot(*(goal - place)) >= MIN_DISTANCE_M
                and (gaps < FREE_START_M).sum() == 1  # the person alone
                and walls_m >= rules.robot_radius_m
            ):
                start, end = tuple(place.tolist()), tuple(goal.tolist())
                trips.append(Episode(len(trips), person, tick, start, end, reverse=False))
        if len(trips) >= robots:
            yield trips
