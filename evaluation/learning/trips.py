"""Gymnasium's environment: one robot on trips among recorded or reacting people.

`gymnasium.make("esplanade.evaluation.learning.trips:esplanade/Trips-v0", recording="zara1.csv")`
"""

from pathlib import Path
from typing import Any, Final, Literal

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from esplanade.evaluation.episodes import choose_episodes
from esplanade.evaluation.learning.features import size_of, velocity_of
from esplanade.evaluation.learning.rewards import Rewards
from esplanade.evaluation.learning.robots import Outcome, Robots
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.trials import Source

ID: Final = "esplanade/Trips-v0"
MOST_TRIPS: Final = 100_000

Seen = NDArray[np.float32]


class TripEnv(gymnasium.Env[Seen, NDArray[np.float32]]):
    """A robot that takes the place of a recorded person, another one in each episode.

    Observations are those of `features`; an action is the wanted velocity in the same frame, in
    parts of the greatest speed. `info` has `outcome` where a trip has ended.

    Parameters
    ----------
    recording :
        A file of a recorded crowd; `NAME.walls.json` beside it has its walls.
    people :
        Whether they walk as they did, or `reacting` to the robot.
    nearest :
        How many people are seen.

    Raises
    ------
    ValueError
        The recording has no trip that can be made, or cannot be read.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - Gymnasium has it so

    def __init__(
        self,
        recording: str | Path,
        people: Literal["recorded", "reacting"] = "recorded",
        reaction: float = 1.0,
        nearest: int = 8,
        rewards: Rewards | None = None,
    ) -> None:
        self._rules = Rules(people=people, reaction=reaction)
        self._environment = Source(Path(recording)).environment(self._rules.tick_s)
        self._trips = choose_episodes(self._environment.replay, self._rules, MOST_TRIPS, 0)
        if not self._trips:
            raise ValueError(f"{recording}: nobody in it makes a trip that a robot could make")
        self._nearest = nearest
        self._rewards = rewards or Rewards()
        self._robots: Robots | None = None
        self.observation_space = spaces.Box(-1.0, 1.0, (size_of(nearest),), np.float32)
        self.action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Begin a trip, drawn by the generator; `options` may have the number of one as `trip`."""
        super().reset(seed=seed)
        number = int(self.np_random.integers(len(self._trips)))
        number = (options or {}).get("trip", number)
        if not 0 <= number < len(self._trips):
            raise ValueError(f"trip: {number} is not from 0 to {len(self._trips) - 1}")
        self._robots = Robots(self._environment, self._rules, [self._trips[number]])
        return self._robots.features(self._robots.all[0], self._nearest), {"trip": number}

    def step(self, action: NDArray[np.float32]) -> tuple[Seen, float, bool, bool, dict[str, Any]]:
        """Walk for one tick of 0.1 s."""
        if self._robots is None:
            raise RuntimeError("call reset before the first step")
        (robot,) = self._robots.all
        wanted = velocity_of(action, robot.position, robot.waypoint, self._rules.max_speed_mps)
        self._robots.step([wanted])
        late = robot.outcome is Outcome.LATE
        return (
            self._robots.features(robot, self._nearest),
            self._rewards.of(robot, self._rules),
            robot.outcome is not None and not late,
            late,
            {} if robot.outcome is None else {"outcome": robot.outcome.value},
        )


gymnasium.register(ID, entry_point=f"{__name__}:TripEnv")
