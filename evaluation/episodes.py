"""The choice of episodes: recorded people's own starts, goals and times of departure."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules

MIN_TICKS: Final = 5
MIN_DISTANCE_M: Final = 5.0
MAX_TIME_RATIO: Final = 3.0
"""Recorded trips that took longer than this many times the straight line's time are left out,
because such people were not heading for a destination."""
MIN_TIME_LEFT_RATIO: Final = 1.5
"""The recording must go on for at least this many times the straight line's time."""
FREE_START_M: Final = 0.8
"""Trips are left out if somebody else is nearer than this to the start."""


@dataclass(frozen=True)
class Episode:
    """One trip on which the robot takes the place of a recorded pedestrian.

    The pedestrian is removed from the replay. `start` and `goal` are (x, y) in metres.
    """

    number: int
    """The position among the episodes of the recording, from 0."""
    pedestrian: int
    first_tick: int
    start: tuple[float, float]
    goal: tuple[float, float]
    reverse: bool
    """Whether the trip goes from the pedestrian's last position to the first one."""

    @property
    def distance_m(self) -> float:
        """Length of the straight line from start to goal."""
        return float(np.hypot(self.goal[0] - self.start[0], self.goal[1] - self.start[1]))


def choose_episodes(replay: Replay, rules: Rules, count: int, seed: int) -> list[Episode]:
    """Choose at most `count` episodes of a recording in random order.

    The same seed gives the same episodes. Reversed trips are added if there are fewer forward
    trips than `count`.
    """
    forward: list[Episode] = []
    backward: list[Episode] = []
    for pedestrian in range(len(replay.ids)):
        if not _has_destination(replay, rules, pedestrian):
            continue
        begin, end = replay.trajectory(pedestrian)[[0, -1]]
        for chosen, start, goal in ((forward, begin, end), (backward, end, begin)):
            first = int(replay.first[pedestrian])
            if _is_free(replay, rules, pedestrian, start, goal):
                ends = (float(start[0]), float(start[1])), (float(goal[0]), float(goal[1]))
                chosen.append(Episode(0, pedestrian, first, *ends, chosen is backward))
    rng = np.random.default_rng(seed)
    order = [forward[k] for k in rng.permutation(len(forward))]
    if len(order) < count:
        order += [backward[k] for k in rng.permutation(len(backward))]
    return [
        Episode(number, e.pedestrian, e.first_tick, e.start, e.goal, e.reverse)
        for number, e in enumerate(order[:count])
    ]


def _has_destination(replay: Replay, rules: Rules, pedestrian: int) -> bool:
    first, last = int(replay.first[pedestrian]), int(replay.last[pedestrian])
    if last - first < MIN_TICKS:
        return False
    begin, end = replay.trajectory(pedestrian)[[0, -1]]
    distance_m = float(np.linalg.norm(end - begin))
    straight_s = distance_m / rules.speed_mps
    left_s = (replay.end_tick - first) * replay.tick_s
    return not (
        distance_m < MIN_DISTANCE_M
        or (last - first) * replay.tick_s > MAX_TIME_RATIO * straight_s
        or MIN_TIME_LEFT_RATIO * straight_s > left_s
    )


def _is_free(
    replay: Replay,
    rules: Rules,
    pedestrian: int,
    start: np.ndarray[tuple[int], np.dtype[np.float64]],
    goal: np.ndarray[tuple[int], np.dtype[np.float64]],
) -> bool:
    first = int(replay.first[pedestrian])
    others = replay.present(first)
    others = others[others != pedestrian]
    distances = np.linalg.norm(replay.positions(others, first) - start, axis=1)
    if distances.min(initial=np.inf) < FREE_START_M:
        return False
    walls_m = min(replay.obstacles.distance(start), replay.obstacles.distance(goal))
    return walls_m >= rules.robot_radius_m
