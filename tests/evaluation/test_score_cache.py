"""Scores on disk are found again only if all that they depend on is the same."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from esplanade.evaluation import score_cache as score_caches
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.score_cache import ScoreCache, ScoreCacheError
from esplanade.evaluation.trials import Source, Trial, plan_trials
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


@pytest.fixture
def trial(tmp_path: Path) -> Trial:
    source = Source(write_csv(tmp_path, busy_plaza()))
    return plan_trials([source], ["straight"], RULES, 6, 0, {})[0]


@pytest.fixture
def path(tmp_path: Path, trial: Trial) -> Path:
    """A cache file with the scores of the trial."""
    path = tmp_path / "done.jsonl"
    with ScoreCache(path) as score_cache:
        run_trials([trial], 1, lambda _: None, score_cache)
    return path


def found(path: Path, trial: Trial) -> int:
    with ScoreCache(path) as score_cache:
        return len(score_cache.find(trial))


def test_scores_are_found_again_as_they_were(path: Path, trial: Trial) -> None:
    with ScoreCache(path) as score_cache:
        (result,) = run_trials([trial], 1, lambda _: None, score_cache)
        assert tuple(score_cache.find(trial).values()) == result.scores
    assert len(path.read_text().splitlines()) == 6


def test_an_episode_is_found_under_its_number_in_any_selection(path: Path, trial: Trial) -> None:
    backward = tuple(replace(e, number=5 - e.number) for e in reversed(trial.episodes))
    with ScoreCache(path) as score_cache:
        scores = score_cache.find(replace(trial, episodes=backward))
        before = score_cache.find(trial)
    assert list(scores) == list(range(6))
    assert [scores[k].pedestrian for k in range(6)] == [before[5 - k].pedestrian for k in range(6)]


def test_scores_measured_otherwise_are_not_found(
    path: Path, trial: Trial, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert found(path, trial) == 6
    assert found(path, replace(trial, policy="discs")) == 0
    assert found(path, replace(trial, rules=replace(RULES, near_m=0.3))) == 0
    assert found(path, replace(trial, rules=replace(RULES, people="reacting"))) == 0
    assert found(path, replace(trial, settings=(("risk_weight", 9.0),))) == 0
    assert found(path, replace(trial, source=replace(trial.source, interpolation="cubic"))) == 0
    monkeypatch.setattr(score_caches, "_code_digest", lambda: "changed")
    assert found(path, trial) == 0


def test_another_recording_of_the_same_name_is_not_found(
    path: Path, trial: Trial, tmp_path: Path
) -> None:
    folder = tmp_path / "other"
    folder.mkdir()
    same = write_csv(folder, busy_plaza())
    assert found(path, replace(trial, source=Source(same))) == 6
    changed = tmp_path / "plaza-with-walls.csv"
    changed.write_text(same.read_text())
    changed.with_suffix(".walls.json").write_text('{"segments": [[50, 0, 50, 9]]}')
    assert found(path, replace(trial, source=Source(changed))) == 0


def test_a_folder_is_a_recording_that_is_known_by_all_its_files(
    trial: Trial, tmp_path: Path
) -> None:
    folder, other = tmp_path / "folder", tmp_path / "other"
    for each in (folder, other):
        each.mkdir()
        write_csv(each, busy_plaza())
    (other / "second.csv").write_text((other / "plaza.csv").read_text())
    path = tmp_path / "scores.jsonl"
    of_folder = replace(trial, source=Source(folder))
    with ScoreCache(path) as score_cache:
        run_trials([of_folder], 1, lambda _: None, score_cache)
    assert found(path, of_folder) == 6
    assert found(path, replace(trial, source=Source(other))) == 0


def test_a_recording_is_read_once_for_its_digest(
    trial: Trial, monkeypatch: pytest.MonkeyPatch
) -> None:
    digest = trial.source.digest()
    monkeypatch.setattr(Path, "open", None)
    assert trial.source.digest() == digest


def test_scores_without_arrival_have_no_time_and_are_found_again(path: Path, trial: Trial) -> None:
    lines = path.read_text().splitlines()
    entry = json.loads(lines[0])
    entry["score"] |= {"reached": False, "time_ratio": None}
    path.write_text("\n".join([json.dumps(entry), *lines[1:]]) + "\n")
    with ScoreCache(path) as score_cache:
        (lost,) = (score for score in score_cache.find(trial).values() if not score.reached)
    assert lost.time_ratio != lost.time_ratio  # nan


def test_half_a_line_at_the_end_is_left_out_and_written_anew(path: Path, trial: Trial) -> None:
    path.write_text(path.read_text()[:-40])
    with ScoreCache(path) as score_cache:
        assert len(score_cache.find(trial)) == 5
        run_trials([trial], 1, lambda _: None, score_cache)
    assert found(path, trial) == 6


@pytest.mark.parametrize("line", ["no json", "[]", "{}", '{"trial": "x", "score": {}}'])
def test_a_file_that_is_no_score_cache_is_refused_with_its_line(path: Path, line: str) -> None:
    before = path.read_text() + line + "\n"
    path.write_text(before)
    with pytest.raises(ScoreCacheError, match=r"done.jsonl:7: this is no line of a score cache"):
        ScoreCache(path)
    assert path.read_text() == before


def test_a_place_where_nothing_can_be_written_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ScoreCacheError, match="directory"):
        ScoreCache(tmp_path)


def test_no_score_depends_on_what_is_left_out_of_the_codes_digest() -> None:
    program = (
        "import sys\n"
        "from esplanade.evaluation import simulation, trials\n"
        "from esplanade.evaluation.policies import ours\n"
        "print(*(name for name in sys.modules if name.startswith('esplanade.evaluation.')))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    used = {name.split(".")[2] for name in done.stdout.split()}
    assert "simulation" in used
    assert used & score_caches._SHOW_ONLY == set()
