"""The study walks our actor and its peers, and says what holds and what does not."""

from pathlib import Path

import pytest
from benchmarks import study
from benchmarks._detour_policy import detour
from benchmarks._node_process import recast_missing

from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.trials import Source, plan_trials
from tests.evaluation.worlds import RULES, busy_plaza, write_csv


def test_it_compares_on_all_recordings_and_without_each_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    crowds = tmp_path / "crowds"
    crowds.mkdir()
    for name in ("park1", "park2", "yard"):
        write_csv(crowds, busy_plaza(), name)
    report = tmp_path / "study.html"
    words = [*map(str, sorted(crowds.glob("*.csv"))), "--policy", "straight", "--episodes", "3"]
    assert study.main([*words, "--processes", "1", "--report", str(report)]) == 0
    told = capsys.readouterr().out
    assert "all together, recorded people" in told
    assert "Differences from esplanade in the same episodes" in told
    assert "displacement imposed on people" in told
    for where in ("with all places", "without park", "without yard"):
        assert f"displacement imposed by esplanade, {where}: " in told
    assert "so that esplanade imposes least" in told
    assert "all together, reacting people" in report.read_text()


@pytest.mark.skipif(recast_missing() is not None, reason=str(recast_missing()))
def test_the_crowd_of_detour_is_a_policy(tmp_path: Path) -> None:
    source = Source(write_csv(tmp_path, busy_plaza()))
    with detour() as name:
        assert name.endswith("/detour")
        trials = plan_trials([source], [name], RULES, 4, 0, {})
        (result,) = run_trials(trials, 1, lambda _: None)
    assert [score.fault for score in result.scores] == [""] * 4
    assert all(score.reached for score in result.scores)


def test_without_recordings_it_says_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ESPLANADE_RECORDINGS", str(tmp_path))
    with pytest.raises(SystemExit, match="set ESPLANADE_RECORDINGS to the folder of crowds"):
        study.main([])
