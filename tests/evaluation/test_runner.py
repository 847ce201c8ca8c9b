"""Many episodes: what comes out does not depend on processes or on their order."""

from dataclasses import replace
from pathlib import Path

import pytest

from evaluation.runner import run_trials
from evaluation.scores import Score
from evaluation.trials import Source, Trial, plan_trials
from recordings import RecordingError
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


def planned(folder: Path, *policies: str, count: int = 100) -> list[Trial]:
    source = Source(write_csv(folder, busy_plaza()))
    return plan_trials([source], policies, RULES, count, 0, {})


def timeless(scores: tuple[Score, ...]) -> list[Score]:
    """Scores without what the clock of this machine said."""
    return [replace(score, decision_ms=0.0, decision_max_ms=0.0) for score in scores]


def test_policies_get_the_same_episodes_and_humans_only_those_forward(tmp_path: Path) -> None:
    straight, human = planned(tmp_path, "straight", "human")
    assert any(episode.reverse for episode in straight.episodes)
    assert human.episodes == tuple(e for e in straight.episodes if not e.reverse)


def test_processes_change_nothing_but_the_time(tmp_path: Path) -> None:
    trials = planned(tmp_path, "straight", "human")
    done: list[int] = []
    alone = run_trials(trials, 1, done.append)
    together = run_trials(trials, 2, done.append)
    for one, two in zip(alone, together, strict=True):
        assert one.trial == two.trial
        assert timeless(one.scores) == timeless(two.scores)
        assert [s.number for s in one.scores] == [e.number for e in one.trial.episodes]
    assert sum(done) == 2 * sum(len(trial.episodes) for trial in trials)


def test_walls_beside_a_recording_are_found(tmp_path: Path) -> None:
    path = write_csv(tmp_path, busy_plaza())
    path.with_suffix(".walls.json").write_text('{"segments": [[50, 0, 50, 9]]}')
    assert len(Source(path).ground(0.1).replay.obstacles.segments) == 1


def test_broken_recordings_are_found_before_anything_runs(tmp_path: Path) -> None:
    path = tmp_path / "plaza.csv"
    path.write_text("t,id,x,y\n0,1,a,0\n")
    with pytest.raises(RecordingError, match=":2: x is 'a'"):
        plan_trials([Source(path)], ["straight"], RULES, 5, 0, {})
