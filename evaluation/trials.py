"""What is to be run: policies, with their settings, on the episodes of recordings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from esplanade.evaluation.episodes import Episode, choose_episodes
from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.replay import Interpolation, Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Ground
from esplanade.recordings import Crowd, Obstacles, read_crowd, read_obstacles, walls_beside


@dataclass(frozen=True)
class Source:
    """A recording on disk: every process reads it for itself."""

    path: Path
    walls: Path | None = None
    fps: float | None = None
    interpolation: Interpolation = "linear"

    def read(self) -> tuple[Crowd, Obstacles]:
        """What the files hold; RecordingError says what is wrong with one."""
        return _read(self)

    def episodes(self, rules: Rules, count: int, seed: int) -> tuple[Episode, ...]:
        """Its trips to be judged."""
        return _episodes(self, rules, count, seed)

    def ground(self, tick_s: float) -> Ground:
        """The recording, ready for episodes; read once in a process."""
        return _ground(self, tick_s)


@cache
def _read(source: Source) -> tuple[Crowd, Obstacles]:
    walls = source.walls or walls_beside(source.path)
    crowd = read_crowd(source.path, source.fps)
    return crowd, Obstacles() if walls is None else read_obstacles(walls)


@cache
def _ground(source: Source, tick_s: float) -> Ground:
    replay = Replay(*source.read(), tick_s=tick_s, interpolation=source.interpolation)
    return Ground.of(replay)


@cache
def _episodes(source: Source, rules: Rules, count: int, seed: int) -> tuple[Episode, ...]:
    return tuple(choose_episodes(source.ground(rules.tick_s).replay, rules, count, seed))


@dataclass(frozen=True)
class Trial:
    """One policy on the episodes of one recording."""

    source: Source
    policy: str
    rules: Rules
    episodes: tuple[Episode, ...]
    settings: tuple[tuple[str, Any], ...] = ()
    """Changes of settings, for our own policy."""


def plan_trials(
    sources: Sequence[Source],
    policies: Sequence[str],
    rules: Rules,
    count: int,
    seed: int,
    settings: Mapping[str, Any],
) -> list[Trial]:
    """Every policy on the same episodes of every recording.

    Raises
    ------
    RecordingError, PolicyError
        A file is broken, or a policy cannot be had: before anything has run.
    """
    follows = {name: make_policy(name, settings).follows_recording for name in policies}
    trials = []
    for source in sources:
        episodes = source.episodes(rules, count, seed)
        for name in policies:
            taken = tuple(e for e in episodes if not (follows[name] and e.reverse))
            trials.append(Trial(source, name, rules, taken, tuple(settings.items())))
    return trials
