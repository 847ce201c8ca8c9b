"""Which trips are judged: people's own starts and goals, at the times they set out."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules

MIN_TICKS: Final = 5
MIN_WAY_M: Final = 5.0
SLOWEST: Final = 3.0
"""Who took longer than this many times the straight way's time was not going somewhere."""
TIME_LEFT: Final = 1.5
"""The recording must go on for this many times the straight way's time."""
FREE_START_M: Final = 0.8
"""Nobody else may stand nearer than this to the start."""
OUT_OF_SIGHT_M: Final = 9.0


@dataclass(frozen=True)
class Episode:
    """One trip: that pedestrian is taken out, and the robot goes instead, from `first_tick` on."""

    number: int
    """Position among the episodes of its recording, from 0."""
    pedestrian: int
    first_tick: int
    start: tuple[float, float]
    goal: tuple[float, float]
    reverse: bool
    """Whether the trip goes from the pedestrian's end to the start."""

    @property
    def way_m(self) -> float:
        """Length of the straight way."""
        return float(np.hypot(self.goal[0] - self.start[0], self.goal[1] - self.start[1]))


def choose_episodes(replay: Replay, rules: Rules, count: int, seed: int) -> list[Episode]:
    """At most so many trips, the same for the same seed; reversed ones where there are too few."""
    forward: list[Episode] = []
    backward: list[Episode] = []
    for pedestrian in range(len(replay.ids)):
        if not _goes_somewhere(replay, rules, pedestrian):
            continue
        way = replay.way(pedestrian)
        for chosen, start, goal in ((forward, way[0], way[-1]), (backward, way[-1], way[0])):
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


def _goes_somewhere(replay: Replay, rules: Rules, pedestrian: int) -> bool:
    first, last = int(replay.first[pedestrian]), int(replay.last[pedestrian])
    if last - first < MIN_TICKS:
        return False
    way = replay.way(pedestrian)
    way_m = float(np.linalg.norm(way[-1] - way[0]))
    straight_s = way_m / rules.speed_mps
    return not (
        way_m < MIN_WAY_M
        or (last - first) * replay.tick_s > SLOWEST * straight_s
        or first * replay.tick_s + TIME_LEFT * straight_s > replay.end_tick * replay.tick_s
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
    away = np.linalg.norm(replay.positions(others, first) - start, axis=1)
    if min([*away, OUT_OF_SIGHT_M]) < FREE_START_M:
        return False
    walls_m = min(replay.obstacles.distance(start), replay.obstacles.distance(goal))
    return walls_m >= rules.robot_radius_m
