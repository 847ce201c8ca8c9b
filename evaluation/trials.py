"""The plan of an evaluation: policies with their settings on the episodes of recordings.

A trial is what Optuna and Ray Tune call so: one evaluation of one configuration.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

from esplanade.commandline.provenance import digest_of
from esplanade.evaluation.episodes import Episode, choose_episodes
from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.policy_options import has_options
from esplanade.evaluation.replay import Interpolation, Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Environment
from esplanade.policies.names import label_of, own_options
from esplanade.recordings import Crowd, Given, Obstacles, read_crowd, read_obstacles, walls_beside

READ_AS_IT_SAYS: Final = Given()


@dataclass(frozen=True)
class Source:
    """A recording on disk; every process reads it for itself."""

    path: Path
    walls: Path | None = None
    given: Given = READ_AS_IT_SAYS
    interpolation: Interpolation = "linear"

    def read(self) -> tuple[Crowd, Obstacles]:
        """The crowd and the obstacles of the files.

        Raises
        ------
        RecordingError
            A file cannot be read or is broken.
        """
        return _read(self)

    def digest(self) -> str:
        """SHA-256 of the recording, a file or a folder; it is read for that once in each process.

        Raises
        ------
        OSError
            It cannot be read.
        """
        return _digest(self.path)

    def episodes(self, rules: Rules, count: int, seed: int) -> tuple[Episode, ...]:
        """The episodes of the recording, as `choose_episodes` chooses them."""
        return _episodes(self, rules, count, seed)

    def environment(self, tick_s: float) -> Environment:
        """The recording prepared for episodes; it is read once in each process."""
        return _environment(self, tick_s)


@cache
def _read(source: Source) -> tuple[Crowd, Obstacles]:
    walls = source.walls or walls_beside(source.path)
    crowd = read_crowd(
        source.path,
        source.given.fps,
        unit=source.given.unit,
        scale=source.given.scale,
        strict=source.given.strict,
        columns=source.given.columns,
    )
    return crowd, Obstacles() if walls is None else read_obstacles(walls)


@cache
def _digest(path: Path) -> str:
    return digest_of(path)


@cache
def _environment(source: Source, tick_s: float) -> Environment:
    replay = Replay(*source.read(), tick_s=tick_s, interpolation=source.interpolation)
    return Environment.of(replay)


@cache
def _episodes(source: Source, rules: Rules, count: int, seed: int) -> tuple[Episode, ...]:
    return tuple(choose_episodes(source.environment(rules.tick_s).replay, rules, count, seed))


@dataclass(frozen=True)
class Trial:
    """One policy on the episodes of one recording."""

    source: Source
    policy: str
    rules: Rules
    episodes: tuple[Episode, ...]
    settings: tuple[tuple[str, Any], ...] = ()
    """Changed settings, for our own policy, or the options of one from outside."""

    @property
    def label(self) -> str:
        """The short name of the policy, for tables, pictures and files."""
        return label_of(self.policy)


def plan_trials(
    sources: Sequence[Source],
    policies: Sequence[str],
    rules: Rules,
    count: int,
    seed: int,
    settings: Mapping[str, Any],
    options: Sequence[tuple[str, Any]] = (),
) -> list[Trial]:
    """Plan every policy on the same episodes of every recording.

    `settings` are those of our actor, `options` those of the policies that have some, by their
    names or, for one of several, as `MyPolicy.gain`.

    Raises
    ------
    RecordingError
        A file is broken.
    PolicyError
        The package that a policy needs is not installed, or a policy cannot be made.
    """
    given = {n: own_options(n, options) if has_options(n) else dict(settings) for n in policies}
    follows = {name: _follows_recording(name, given[name]) for name in policies}
    trials = []
    for source in sources:
        episodes = source.episodes(rules, count, seed)
        for name in policies:
            taken = tuple(e for e in episodes if not (follows[name] and e.reverse))
            trials.append(Trial(source, name, rules, taken, tuple(given[name].items())))
    return trials


def _follows_recording(name: str, settings: Mapping[str, Any]) -> bool:
    """Whether a policy, which is made and started for that, repeats the recorded trajectory."""
    policy = make_policy(name, settings)
    try:
        policy.start()
    finally:
        policy.close()
    return policy.follows_recording
