"""`--trajectories`: a file for each episode, in which the robot walks among the recorded people."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from esplanade.cli import main
from esplanade.commandline.provenance import digest_of
from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.simulation import run_episode
from esplanade.evaluation.trajectory_files import EpisodeFiles
from esplanade.evaluation.trials import Source, plan_trials
from esplanade.recordings import read_crowd
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


def test_each_episode_has_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plaza = write_csv(tmp_path, busy_plaza())
    words = [*("evaluate", str(plaza), "--processes", "1", "--policy", "human", "straight")]
    words += ["--episodes", "2", "--seed", "3", "--score-cache", str(tmp_path / "scores")]
    words += ["--trajectories", str(tmp_path / "walks.csv")]
    assert main(words) == 0
    names = sorted(path.name for path in tmp_path.glob("walks-*"))
    assert names == [
        *("walks-plaza-human-000.csv", "walks-plaza-human-001.csv"),
        *("walks-plaza-straight-000.csv", "walks-plaza-straight-001.csv"),
    ]
    path = tmp_path / "walks-plaza-human-000.csv"
    text = path.read_text()
    assert f"# command: esplanade {' '.join(words)}\n" in text
    assert "# policy: human\n" in text
    (place_of,) = re.findall(r"# episode: 0, in place of (\w+)", text)
    notes = [json.loads(each) for each in re.findall(r"avatar: (\{.*\})", text)]
    (robot,) = [note["id"] for note in notes if note["kind"] == "actor"]
    recorded = {str(note["id"]): note["recorded"] for note in notes if note["kind"] == "person"}
    assert place_of not in recorded.values()
    originals = {track.id: track for track in read_crowd(plaza).tracks}
    for track in read_crowd(path).tracks:
        # A robot of the policy `human` walks as the pedestrian did whose place it takes.
        original = originals[place_of if track.id == str(robot) else recorded[track.id]]
        for t in track.times.tolist():
            np.testing.assert_allclose(track.at(t), original.at(t), atol=0.03)
    capsys.readouterr()
    # Scores that are known do not keep episodes from being written.
    path.unlink()
    assert main(words) == 0
    assert path.read_text() == text


def test_people_who_react_are_written_where_they_were(tmp_path: Path) -> None:
    source = Source(write_csv(tmp_path, busy_plaza()))
    rules = replace(RULES, people="reacting")
    (trial,) = plan_trials([source], ["straight"], rules, 3, 0, {})
    files = EpisodeFiles(tmp_path / "walks.csv", {source.path: "plaza"}, "evaluate")
    run_trials([trial], 1, lambda _: None, files=files)
    replay = source.environment(rules.tick_s).replay
    moved_m = 0.0
    for episode in trial.episodes:
        policy = make_policy("straight", {})
        people = run_episode(source.environment(rules.tick_s), episode, policy, rules).people
        for track in read_crowd(files.path(trial, episode)).tracks:
            number = int(track.id) - 1
            for t in track.times.tolist() if number < len(replay.ids) else ():
                tick = round(t / rules.tick_s)
                place = people.at(number, tick)
                np.testing.assert_allclose(track.at(t), place, atol=0.002)
                moved_m = max(moved_m, float(np.abs(place - replay.at(number, tick)).max()))
    assert moved_m > 0.05


def test_a_folder_is_evaluated(tmp_path: Path) -> None:
    folder = tmp_path / "plaza"
    folder.mkdir()
    write_csv(folder, busy_plaza())
    words = ["evaluate", str(folder), "--processes", "1", "--policy", "straight"]
    words += ["--episodes", "1", "--trajectories", str(tmp_path / "walks.csv")]
    assert main(words) == 0
    text = (tmp_path / "walks-plaza-straight-000.csv").read_text()
    assert f"# recording sha256: {digest_of(folder)}\n" in text


def test_where_no_file_can_come_of_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plaza = str(write_csv(tmp_path, busy_plaza()))
    for words, fault in (
        (["--trajectories", "a.doc"], "a.doc ends in none of .csv, .txt, .sqlite, .parquet"),
        (["--trajectories", "a.csv", "--prediction"], "episodes that are walked once"),
    ):
        with pytest.raises(SystemExit):
            main(["evaluate", plaza, *words])
        assert fault in capsys.readouterr().err
