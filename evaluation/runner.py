"""Episodes run on several processes; the results do not depend on the number of processes."""

import multiprocessing
import signal
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from typing import Any, Final, Protocol

from esplanade.evaluation.policies import Policy, make_policy
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.score_cache import ScoreCache
from esplanade.evaluation.scores import Score
from esplanade.evaluation.simulation import run_episode
from esplanade.evaluation.trajectory_files import EpisodeFiles
from esplanade.evaluation.trials import Source, Trial

EPISODES_AT_ONCE: Final = 5
Keep = Callable[[int, Trial, Sequence[Score], str], None]
"""Keeps the scores of a chunk of the trial of that number, and the name of its worker."""
WARM_UP_S: Final = 1.0


class Cluster(Protocol):
    """Other machines that walk episodes."""

    def run(self, parts: Sequence[tuple[int, Trial]], keep: Keep) -> None:
        """Walk all chunks, each of the trial of that number, and keep what has been walked."""


@dataclass(frozen=True)
class TrialResult:
    """The scores of a trial in the order of its episodes."""

    trial: Trial
    scores: tuple[Score, ...]


def run_trials(
    trials: Sequence[Trial],
    processes: int,
    report: Callable[[int], None],
    score_cache: ScoreCache | None = None,
    files: EpisodeFiles | None = None,
    cluster: Cluster | None = None,
) -> list[TrialResult]:
    """Run all trials; `report` is called with the number of episodes that have been added.

    They are run by the workers of `cluster`, or else by so many processes of this machine.

    With `files`, all episodes are run and written. Without, those whose score is in the cache are
    not run again. Every new score is in the cache, even after an interrupt: this then ends as soon
    as the episodes that are running have ended.
    """
    score_cache = score_cache or ScoreCache()
    found = [score_cache.find(trial) if files is None else {} for trial in trials]
    known = sum(map(len, found))
    if known:
        report(known)

    def keep(index: int, part: Trial, scores: Sequence[Score], worker: str) -> None:
        score_cache.add(part, scores, worker)
        found[index] |= {score.number: score for score in scores}
        report(len(scores))

    parts = [
        (index, part)
        for index, trial in enumerate(trials)
        for part in _parts(trial, found[index].keys())
    ]
    if cluster is None:
        _run_parts(parts, processes, keep, files)
    elif parts:
        cluster.run(parts, keep)
    return [
        TrialResult(trial, tuple(scores[episode.number] for episode in trial.episodes))
        for trial, scores in zip(trials, found, strict=True)
    ]


def ready_policy(trial: Trial) -> Policy:
    """The policy of a trial with its kernels compiled.

    The first second of the first episode is run for that.
    """
    policy = make_policy(trial.policy, dict(trial.settings))
    short = replace(trial.rules, time_limit_s=WARM_UP_S)
    run_episode(trial.source.environment(short.tick_s), trial.episodes[0], policy, short)
    return policy


def _parts(trial: Trial, done: Collection[int]) -> Iterator[Trial]:
    """The remaining episodes of a trial, divided into chunks."""
    left = [episode for episode in trial.episodes if episode.number not in done]
    for first in range(0, len(left), EPISODES_AT_ONCE):
        yield replace(trial, episodes=tuple(left[first : first + EPISODES_AT_ONCE]))


def _run_parts(
    parts: Sequence[tuple[int, Trial]],
    processes: int,
    keep: Keep,
    files: EpisodeFiles | None,
) -> None:
    if processes == 1:
        for index, part in parts:
            keep(index, part, run_part(part, files), "")
        forget()
        return
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, spawn, _leave_interrupts_to_the_parent) as pool:
        waiting = {pool.submit(run_part, part, files): (index, part) for index, part in parts}
        try:
            for future in as_completed(waiting):
                keep(*waiting.pop(future), future.result(), "")
        finally:
            pool.shutdown(cancel_futures=True)
            for future, (index, part) in waiting.items():
                if not future.cancelled() and future.exception() is None:
                    keep(index, part, future.result(), "")


def _leave_interrupts_to_the_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def forget() -> None:
    """End the policy of the previous chunk."""
    for policy in _last.values():
        policy.close()
    _last.clear()


_last: dict[tuple[Source, str, Rules, tuple[tuple[str, Any], ...]], Policy] = {}


def run_part(part: Trial, files: EpisodeFiles | None = None) -> list[Score]:
    """Run one chunk of episodes; the policy of the previous chunk is reused if it is the same."""
    key = (part.source, part.policy, part.rules, part.settings)
    if key not in _last:
        forget()
        _last[key] = ready_policy(part)
    environment = part.source.environment(part.rules.tick_s)
    scores = []
    for episode in part.episodes:
        result = run_episode(environment, episode, _last[key], part.rules)
        if files is not None:
            files.write(part, episode, result.trajectory, result.people)
        scores.append(result.score)
    return scores
