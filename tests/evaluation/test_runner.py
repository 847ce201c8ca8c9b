"""The results of many episodes do not depend on processes, order or interrupts."""

from dataclasses import replace
from pathlib import Path

import pytest

from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.score_cache import ScoreCache
from esplanade.evaluation.scores import Score
from esplanade.evaluation.trials import Source, Trial, plan_trials
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


def planned(folder: Path, *policies: str, rules: Rules = RULES) -> list[Trial]:
    source = Source(write_csv(folder, busy_plaza()))
    return plan_trials([source], policies, rules, 100, 0, {})


def timeless(scores: tuple[Score, ...]) -> list[Score]:
    """Scores without the times measured on this machine."""
    return [replace(score, decision_ms=0.0, decision_max_ms=0.0) for score in scores]


def test_processes_change_nothing_but_the_time(tmp_path: Path) -> None:
    trials = planned(tmp_path, "straight", "human")
    trials += planned(tmp_path, "straight", rules=replace(RULES, people="reacting"))
    done: list[int] = []
    alone = run_trials(trials, 1, done.append)
    together = run_trials(trials, 2, done.append)
    for one, two in zip(alone, together, strict=True):
        assert one.trial == two.trial
        assert timeless(one.scores) == timeless(two.scores)
        assert [s.number for s in one.scores] == [e.number for e in one.trial.episodes]
    assert sum(score.displacement_m for score in alone[-1].scores) > 0.0
    assert sum(done) == 2 * sum(len(trial.episodes) for trial in trials)


@pytest.mark.parametrize("processes", [1, 2])
def test_an_interrupted_run_goes_on_where_it_was(tmp_path: Path, processes: int) -> None:
    trials = planned(tmp_path, "straight")
    total = len(trials[0].episodes)
    path = tmp_path / "done.jsonl"

    def interrupt(done: int) -> None:
        if done:
            raise KeyboardInterrupt

    with ScoreCache(path) as score_cache, pytest.raises(KeyboardInterrupt):
        run_trials(trials, processes, interrupt, score_cache)
    kept = len(path.read_text().splitlines())
    assert 0 < kept <= total
    reports: list[int] = []
    with ScoreCache(path) as score_cache:
        (result,) = run_trials(trials, processes, reports.append, score_cache)
    assert reports[0] == kept
    assert sum(reports) == len(path.read_text().splitlines()) == total
    (whole,) = run_trials(trials, 1, reports.append)
    assert timeless(result.scores) == timeless(whole.scores)
