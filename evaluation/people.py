"""The people of an episode: as they were recorded, or reacting to the robot."""

from functools import lru_cache
from typing import Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules
from esplanade.pedestrians import ReactingCrowd

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

GAVE_WAY_M: Final = 0.1


class People(Protocol):
    """The places of people up to the newest tick, numbered as in the replay.

    Each is there from the first to the last tick of the recording.
    """

    @property
    def first(self) -> Ints: ...

    @property
    def last(self) -> Ints: ...

    def present(self, tick: int) -> Ints: ...

    def at(self, pedestrian: int, tick: int) -> Floats: ...

    def positions(self, pedestrians: Ints, tick: int) -> Floats: ...

    def past(self, pedestrian: int, tick: int, ticks: int) -> Floats: ...


class Imposed(NamedTuple):
    """The burden of a robot on people until now, against their recording without it."""

    displacement_m: float
    """The sum over people of the greatest distance of each from the recorded place."""
    imposed_delay_s: float
    """The sum over people of how late each was at most against the recorded timing."""
    imposed_peak_mps2: float
    """The greatest acceleration of anybody beyond the recorded one."""
    gave_way: int
    """The number of people who were displaced by more than `GAVE_WAY_M`."""


NOTHING_IMPOSED: Final = Imposed(0.0, 0.0, 0.0, 0)


class ReactingPeople:
    """People who were recorded, and react to the robot from the beginning of an episode on.

    On a forward trip the robot stands in for the pedestrian whose place it takes.
    """

    def __init__(self, replay: Replay, rules: Rules, episode: Episode) -> None:
        crowd = crowd_of(replay, rules.reaction, rules.people_seed)
        self._replay = replay
        self._walk = crowd.begin(episode.first_tick, {episode.pedestrian})
        self._stand_in = -1 if episode.reverse else episode.pedestrian
        self._walked: dict[int, Floats] = {}
        """The trajectories of those who have left their recorded places."""
        people = len(replay.ids)
        self._late_s = np.zeros(people)
        self._peak_mps2 = np.zeros(people)
        self._offsets: tuple[Floats, Floats] = np.zeros((people, 2)), np.zeros((people, 2))
        """Everybody's places from the recorded ones, a tick ago and two ticks ago."""

    @property
    def first(self) -> Ints:
        return self._replay.first

    @property
    def last(self) -> Ints:
        return self._replay.last

    @property
    def imposed(self) -> Imposed:
        """The burden of the robot on the people who were not left out."""
        displacement_m = self._walk.displacement_m
        return Imposed(
            float(displacement_m.sum()),
            float(self._late_s.sum()),
            float(self._peak_mps2.max(initial=0.0)),
            int((displacement_m > GAVE_WAY_M).sum()),
        )

    def present(self, tick: int) -> Ints:
        """The pedestrians who are present at a tick, in ascending order."""
        return self._replay.present(tick)

    def at(self, pedestrian: int, tick: int) -> Floats:
        """Position (2,), metres, at a tick at which the pedestrian is present."""
        trajectory = self._walked.get(pedestrian)
        if trajectory is None:
            return self._replay.at(pedestrian, tick)
        return np.asarray(trajectory[tick - self.first[pedestrian]])

    def positions(self, pedestrians: Ints, tick: int) -> Floats:
        """Positions (len(pedestrians), 2), metres, of people who are present at the tick."""
        rows = [self.at(int(j), tick) for j in pedestrians]
        return np.array(rows, dtype=np.float64).reshape(-1, 2)

    def past(self, pedestrian: int, tick: int, ticks: int) -> Floats:
        """Positions up to a tick, newest last; they go back by at most `ticks` ticks."""
        trajectory = self._walked.get(pedestrian)
        if trajectory is None:
            return self._replay.past(pedestrian, tick, ticks)
        here = tick - int(self.first[pedestrian])
        return trajectory[max(0, here - ticks) : here + 1]

    def leave_out(self, pedestrian: int) -> None:
        """Take somebody out of the episode: nobody reacts to that person any more."""
        self._walk.leave_out(pedestrian)
        self._late_s[pedestrian] = self._peak_mps2[pedestrian] = 0.0

    def step(self, position: Floats, velocity: Floats, radius_m: float) -> None:
        """Walk for one tick beside the robot at `position`, which goes at `velocity`, both (2,)."""
        self._walk.step([[*position, *velocity, radius_m]], [self._stand_in])
        walk = self._walk
        self._keep_imposed()
        differs = (walk.positions != walk.recorded).any(axis=1)
        for pedestrian, place, moved in zip(
            walk.present.tolist(), walk.positions, differs.tolist(), strict=True
        ):
            if moved and pedestrian not in self._walked:
                self._walked[pedestrian] = self._replay.trajectory(pedestrian).copy()
            if pedestrian in self._walked:
                here = walk.tick - int(self.first[pedestrian])
                self._walked[pedestrian][here] = place

    def _keep_imposed(self) -> None:
        """Keep how late people are, and what they accelerate beyond the recording."""
        walk, here = self._walk, self._walk.present
        self._late_s[here] = np.maximum(self._late_s[here], walk.late_s)
        latest, before = self._offsets
        now = np.zeros_like(latest)
        now[here] = walk.positions - walk.recorded
        beyond = (now - 2.0 * latest + before)[here] / self._replay.tick_s**2
        self._peak_mps2[here] = np.maximum(self._peak_mps2[here], np.hypot(*beyond.T))
        self._offsets = now, latest


@lru_cache(maxsize=8)
def crowd_of(replay: Replay, reaction: float, seed: int) -> ReactingCrowd:
    """The people of a replay, ready to react; made once for all episodes."""
    return ReactingCrowd(
        [replay.trajectory(k) for k in range(len(replay.ids))],
        replay.first.tolist(),
        replay.tick_s,
        walls=np.array(replay.obstacles.obstacles.as_walls()).reshape(-1, 4),
        reaction=reaction,
        seed=seed,
    )
