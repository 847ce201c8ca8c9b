"""Small recordings for the tests of the evaluation."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.fits import Growth
from esplanade.evaluation.forecasts import STEPS, Forecasts
from esplanade.evaluation.policies.policy import Observation, Policy, Task
from esplanade.evaluation.replay import Floats, Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Environment
from esplanade.planning import GAUSSIAN, Spread
from esplanade.recordings import Crowd, Obstacles, Track

Point = tuple[float, float]
RULES = Rules()


def walk(name: str, begins_s: float, *corners: Point, speed_mps: float = 1.2) -> Track:
    """A track from corner to corner at constant speed, with a sample every 0.4 s."""
    points = np.array(corners, dtype=np.float64)
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    seconds = np.arange(0.0, max(lengths[-1] / speed_mps, 0.4) + 1e-9, 0.4)
    along = speed_mps * seconds
    places = [np.interp(along, lengths, points[:, axis]) for axis in (0, 1)]
    return Track(name, begins_s + seconds, np.column_stack(places))


def crowd(*tracks: Track) -> Crowd:
    return Crowd("plaza", tracks)


def replay(*tracks: Track, obstacles: Obstacles | None = None) -> Replay:
    return Replay(crowd(*tracks), obstacles)


def environment(*tracks: Track, obstacles: Obstacles | None = None) -> Environment:
    return Environment.of(replay(*tracks, obstacles=obstacles))


def trip(replay: Replay, pedestrian: int = 0, *, reverse: bool = False) -> Episode:
    """The episode in place of one pedestrian."""
    begin, end = replay.trajectory(pedestrian)[[0, -1]].tolist()
    start, goal = (end, begin) if reverse else (begin, end)
    return Episode(0, pedestrian, int(replay.first[pedestrian]), tuple(start), tuple(goal), reverse)


def busy_plaza() -> Crowd:
    """Twelve people whose paths cross, and one who stands."""
    east = [walk(f"{k}", 1.5 * k, (0.0, 1.3 * k), (12.0, 1.3 * k)) for k in range(6)]
    north = [
        walk(f"{10 + k}", 1.0 + 2.0 * k, (1.5 + 2 * k, 9.0), (1.5 + 2 * k, -2.0)) for k in range(6)
    ]
    return crowd(*east, *north, walk("99", 0.0, (14.0, 14.0), (14.0, 14.5), speed_mps=0.02))


def write_csv(folder: Path, crowd: Crowd, name: str = "plaza") -> Path:
    path = folder / f"{name}.csv"
    rows = [
        f"{t!r},{track.id},{x!r},{y!r}\n"
        for track in crowd.tracks
        for t, (x, y) in zip(track.times.tolist(), track.positions.tolist(), strict=True)
    ]
    path.write_text("t,id,x,y\n" + "".join(rows))
    return path


class Scripted(Policy):
    """A policy that wants given velocities in turn, repeats the last, and keeps observations."""

    def __init__(self, *velocities: Point) -> None:
        self._velocities = velocities
        self.observations: list[Observation] = []

    def reset(self, task: Task) -> None:
        self.observations = []

    def decide(self, observation: Observation) -> Floats:
        self.observations.append(observation)
        return np.array(self._velocities[min(len(self.observations), len(self._velocities)) - 1])

    def seen(self) -> Sequence[list[int]]:
        return [[person.id for person in observation.people] for observation in self.observations]


def drawn(
    sigma_0_m: float,
    growth_mps: float,
    spread: Spread = GAUSSIAN,
    count: int = 4000,
    seed: int = 3,
) -> Forecasts:
    """Predictions whose errors are drawn from the predicted distribution."""
    rng = np.random.default_rng(seed)
    sigmas = np.broadcast_to(Growth(sigma_0_m, growth_mps).sigmas(), (count, STEPS))
    scales = rng.choice(spread.scales, (count, STEPS, 1), p=spread.weights)
    noise = rng.standard_normal((count, STEPS, 2))
    return Forecasts(noise * scales * sigmas[:, :, None], sigmas)
