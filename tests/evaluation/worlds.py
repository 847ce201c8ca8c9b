"""Small recordings that the tests of the evaluation are set in."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.fits import Growth
from esplanade.evaluation.forecasts import STEPS, Forecasts
from esplanade.evaluation.policies.policy import Policy, Task, View
from esplanade.evaluation.replay import Floats, Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Ground
from esplanade.planning import GAUSSIAN, Spread
from esplanade.recordings import Crowd, Obstacles, Track

Point = tuple[float, float]
RULES = Rules()


def walk(name: str, begins_s: float, *corners: Point, speed_mps: float = 1.2) -> Track:
    """From corner to corner at an even speed, a sample every 0.4 s."""
    points = np.array(corners, dtype=np.float64)
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    seconds = np.arange(0.0, max(lengths[-1] / speed_mps, 0.4) + 1e-9, 0.4)
    way = speed_mps * seconds
    places = [np.interp(way, lengths, points[:, axis]) for axis in (0, 1)]
    return Track(name, begins_s + seconds, np.column_stack(places))


def crowd(*tracks: Track) -> Crowd:
    return Crowd("plaza", tracks)


def replay(*tracks: Track, obstacles: Obstacles | None = None) -> Replay:
    return Replay(crowd(*tracks), obstacles)


def ground(*tracks: Track, obstacles: Obstacles | None = None) -> Ground:
    return Ground.of(replay(*tracks, obstacles=obstacles))


def trip(replay: Replay, pedestrian: int = 0, *, reverse: bool = False) -> Episode:
    """The trip of one pedestrian."""
    way = replay.way(pedestrian).tolist()
    start, goal = (way[-1], way[0]) if reverse else (way[0], way[-1])
    return Episode(0, pedestrian, int(replay.first[pedestrian]), tuple(start), tuple(goal), reverse)


def busy_plaza() -> Crowd:
    """Twelve people who cross each other's ways, and one who stands."""
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
    """Wants one velocity after the other, the last for ever; remembers what it saw."""

    def __init__(self, *velocities: Point) -> None:
        self._velocities = velocities
        self.views: list[View] = []

    def reset(self, task: Task) -> None:
        self.views = []

    def decide(self, view: View) -> Floats:
        self.views.append(view)
        return np.array(self._velocities[min(len(self.views), len(self._velocities)) - 1])

    def seen(self) -> Sequence[list[int]]:
        return [[person.id for person in view.people] for view in self.views]


def drawn(
    sigma_0_m: float,
    growth_mps: float,
    spread: Spread = GAUSSIAN,
    count: int = 4000,
    seed: int = 3,
) -> Forecasts:
    """Predictions whose errors are as uncertain as said."""
    rng = np.random.default_rng(seed)
    sigmas = np.broadcast_to(Growth(sigma_0_m, growth_mps).sigmas(), (count, STEPS))
    scales = rng.choice(spread.scales, (count, STEPS, 1), p=spread.weights)
    noise = rng.standard_normal((count, STEPS, 2))
    return Forecasts(noise * scales * sigmas[:, :, None], sigmas)
