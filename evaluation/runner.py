"""Many episodes on several processes. What comes out does not depend on how many."""

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, Final

from evaluation.episodes import Episode, choose_episodes
from evaluation.policies import Policy, make_policy
from evaluation.replay import Interpolation, Replay
from evaluation.rules import Rules
from evaluation.scores import Score
from evaluation.simulation import Ground, run_episode
from recordings import Crowd, Obstacles, read_crowd, read_obstacles, walls_beside

EPISODES_AT_ONCE: Final = 5
WARM_UP_S: Final = 1.0


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


@dataclass(frozen=True)
class Trial:
    """One policy on the episodes of one recording."""

    source: Source
    policy: str
    rules: Rules
    episodes: tuple[Episode, ...]
    parameters: tuple[tuple[str, Any], ...] = field(default=())
    """Changes of the actor's parameters, for our own policy."""


@dataclass(frozen=True)
class Result:
    """The scores of a trial, in the order of its episodes."""

    trial: Trial
    scores: tuple[Score, ...]


def plan_trials(
    sources: Sequence[Source],
    policies: Sequence[str],
    rules: Rules,
    count: int,
    seed: int,
    parameters: Mapping[str, Any],
) -> list[Trial]:
    """Every policy on the same episodes of every recording.

    Raises
    ------
    RecordingError, PolicyError
        A file is broken, or a policy cannot be had: before anything has run.
    """
    follows = {name: make_policy(name, parameters).follows_recording for name in policies}
    trials = []
    for source in sources:
        episodes = choose_episodes(source.ground(rules.tick_s).replay, rules, count, seed)
        for name in policies:
            taken = tuple(e for e in episodes if not (follows[name] and e.reverse))
            trials.append(Trial(source, name, rules, taken, tuple(parameters.items())))
    return trials


def run_trials(
    trials: Sequence[Trial], processes: int, report: Callable[[int], None]
) -> list[Result]:
    """Run all trials; `report` is told each time how many more episodes are done."""
    chunks = [(index, part) for index, trial in enumerate(trials) for part in _parts(trial)]
    found: dict[int, list[Score]] = {index: [] for index in range(len(trials))}
    for index, scores in _carry_out(chunks, processes):
        found[index] += scores
        report(len(scores))
    return [
        Result(trial, tuple(sorted(found[index], key=lambda score: score.number)))
        for index, trial in enumerate(trials)
    ]


def ready_policy(trial: Trial) -> Policy:
    """The policy of a trial, compiled: the first episode's first second has been walked."""
    policy = make_policy(trial.policy, dict(trial.parameters))
    short = replace(trial.rules, time_limit_s=WARM_UP_S)
    run_episode(trial.source.ground(short.tick_s), trial.episodes[0], policy, short)
    return policy


def _parts(trial: Trial) -> Iterator[Trial]:
    for first in range(0, len(trial.episodes), EPISODES_AT_ONCE):
        yield replace(trial, episodes=trial.episodes[first : first + EPISODES_AT_ONCE])


def _carry_out(
    chunks: Sequence[tuple[int, Trial]], processes: int
) -> Iterator[tuple[int, list[Score]]]:
    if processes == 1:
        for index, part in chunks:
            yield index, _run(part)
        return
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, spawn, _leave_interrupts_to_the_parent) as pool:
        futures = {pool.submit(_run, part): index for index, part in chunks}
        try:
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


_last: dict[tuple[Source, str, Rules, tuple[tuple[str, Any], ...]], Policy] = {}


def _run(part: Trial) -> list[Score]:
    """Run some episodes; the policy of the chunk before is used again where it is the same."""
    key = (part.source, part.policy, part.rules, part.parameters)
    if key not in _last:
        _last.clear()
        _last[key] = ready_policy(part)
    ground = part.source.ground(part.rules.tick_s)
    return [run_episode(ground, e, _last[key], part.rules).score for e in part.episodes]
