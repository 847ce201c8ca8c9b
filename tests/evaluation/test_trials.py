"""Trials share the same episodes, and files are checked before anything runs."""

from pathlib import Path

import pytest

from esplanade.evaluation.trials import Source, plan_trials
from esplanade.recordings import RecordingError
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


def test_policies_get_the_same_episodes_and_humans_only_those_forward(tmp_path: Path) -> None:
    source = Source(write_csv(tmp_path, busy_plaza()))
    straight, human = plan_trials([source], ["straight", "human"], RULES, 100, 0, {})
    assert any(episode.reverse for episode in straight.episodes)
    assert human.episodes == tuple(e for e in straight.episodes if not e.reverse)


def test_walls_beside_a_recording_are_found(tmp_path: Path) -> None:
    path = write_csv(tmp_path, busy_plaza())
    path.with_suffix(".walls.json").write_text('{"segments": [[50, 0, 50, 9]]}')
    assert len(Source(path).environment(0.1).replay.obstacles.segments) == 1


def test_broken_recordings_are_found_before_anything_runs(tmp_path: Path) -> None:
    path = tmp_path / "plaza.csv"
    path.write_text("t,id,x,y\n0,1,a,0\n")
    with pytest.raises(RecordingError, match=":2: x is 'a'"):
        plan_trials([Source(path)], ["straight"], RULES, 5, 0, {})
