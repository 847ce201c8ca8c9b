"""The options `--sensitivity` and `--tune`: tables, JSON, a picture, and usage errors."""

import json
from importlib.util import find_spec
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.commandline import exit_codes
from esplanade.evaluation import measures
from tests.evaluation.worlds import busy_plaza, write_csv


@pytest.fixture
def crowds(tmp_path: Path) -> list[Path]:
    return [write_csv(tmp_path, busy_plaza(), name) for name in ("plaza", "market")]


def run(*arguments: object) -> int:
    return main(["evaluate", "--processes=1", "--episodes=2", *map(str, arguments)])


def ended(*arguments: object) -> object:
    """The exit code, also where the parser of options ends the command."""
    try:
        return run(*arguments)
    except SystemExit as end:
        return end.code


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
def test_one_setting_after_the_other_is_varied(
    tmp_path: Path, crowds: list[Path], capsys: pytest.CaptureFixture[str]
) -> None:
    target, folder = tmp_path / "all.json", tmp_path / "pictures"
    score_cache = tmp_path / "done.jsonl"
    study = [*crowds, "--sensitivity", "--vary=risk_weight=2,20", "--vary=risk.comfort=0.2"]
    study += ["--score-cache", score_cache, "--json", target, "--plots", folder]
    assert run(*study) == exit_codes.OK
    shown = capsys.readouterr().out
    assert "risk_weight" in shown
    assert shown.count("baseline") == 3
    found = json.loads(target.read_text())
    assert found["settings"]["recordings"] == ["plaza", "market"]
    assert [row["setting"] for row in found["points"]] == ["risk_weight"] * 3 + ["risk.comfort"] * 2
    assert [path.name for path in folder.iterdir()] == ["sensitivity.svg"]
    walked = len(score_cache.read_text().splitlines())
    assert walked == 2 * 4 * 2  # recordings, variants, episodes
    assert run(*study) == exit_codes.OK
    assert len(score_cache.read_text().splitlines()) == walked
    assert capsys.readouterr().out == shown


def test_candidates_are_compared(
    tmp_path: Path, crowds: list[Path], capsys: pytest.CaptureFixture[str]
) -> None:
    listed, target = tmp_path / "candidates.jsonl", tmp_path / "all.json"
    listed.write_text('{"catch_up": 0.3}\n')
    study = [*crowds, "--tune", "--vary", "risk_weight=2,20", "--candidates", listed]
    study += ["--set", "catch_up=0"]  # so slow a baseline that another one is better
    assert run(*study, "--score-cache", tmp_path / "done.jsonl", "--json", target) == exit_codes.OK
    shown = capsys.readouterr().out
    assert "Leave-one-out cross-validation" in shown
    assert "Chosen on all places: " in shown
    found = json.loads(target.read_text())
    assert len(found["candidates"]) == 4
    assert [fold["left_out"] for fold in found["folds"]] == ["plaza", "market"]


def test_recordings_of_one_place_count_as_one(
    tmp_path: Path,
    crowds: list[Path],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(measures, "PIECE_S", 4.0)  # these recordings are short
    target = tmp_path / "all.json"
    study = [*crowds, "--tune", "--vary=risk_weight=20", "--score-cache", tmp_path / "done.jsonl"]
    assert run(*study, "--place=town=plaza,market") == exit_codes.USAGE
    assert "--tune needs two places" in capsys.readouterr().err
    assert run(*study, "--place=town=plaza", "--place=city=plaza") == exit_codes.USAGE
    assert "--place: plaza was recorded at town or at city" in capsys.readouterr().err
    other = write_csv(tmp_path, busy_plaza(), "station")
    study += ["--place=town=plaza,market", "--episodes=6", "--json", target]
    assert run(other, *study) == exit_codes.OK
    found = json.loads(target.read_text())
    assert [fold["left_out"] for fold in found["folds"]] == ["station", "town"]
    for rows in (found["candidates"], found["folds"]):
        for row in rows:
            low, high = row["intervals"]["time_ratio"]
            assert low <= row["time_ratio"] <= high


PACED = """
import numpy as np

class Paced:
    def __init__(self, pace=1.3, side="left", bends=()):
        if pace < 0:
            raise ValueError("it would walk backwards")
        self.pace, self.side = pace, side

    def velocity(self, observation):
        if self.side == "lost":
            raise LookupError("no map")
        ahead = observation.waypoint - observation.position
        return self.pace * ahead / np.hypot(*ahead)
"""


@pytest.fixture
def paced(tmp_path: Path) -> str:
    """A policy of one's own, the faster the better, which fails where its side is `lost`."""
    (tmp_path / "paced.py").write_text(PACED)
    return f"{tmp_path / 'paced.py'}:Paced"


def test_a_policy_of_ones_own_is_tuned(
    tmp_path: Path, crowds: list[Path], paced: str, capsys: pytest.CaptureFixture[str]
) -> None:
    listed, target = tmp_path / "candidates.jsonl", tmp_path / "all.json"
    listed.write_text('{"side": "lost", "bends": [1, 2]}\n')
    study = [*crowds, "--tune", "--policy", paced, "--policy-option=pace=0.9", "--vary=pace=1.3"]
    study += ["--candidates", listed, "--score-cache", tmp_path / "done.jsonl", "--json", target]
    assert run(*study) == exit_codes.OK
    shown = capsys.readouterr().out
    assert "side=lost) failed in 2 of 2 episodes of plaza; in episode 0 at 0.0 s: no map" in shown
    found = json.loads(target.read_text())
    assert found["settings"]["policy"] == paced
    assert found["settings"]["pace"] == 0.9
    rows = {json.dumps(row["settings"]): row for row in found["candidates"]}
    slow, fast, lost = '{"pace": 0.9}', '{"pace": 1.3}', '{"bends": [1, 2], "pace": 0.9, "side": '
    assert rows[fast]["time_ratio"] < rows[slow]["time_ratio"]
    (missed,) = (row["missed_percent"] for text, row in rows.items() if text.startswith(lost))
    assert missed == 100.0


def test_options_of_a_policy_of_ones_own_are_varied(
    tmp_path: Path, crowds: list[Path], paced: str
) -> None:
    target = tmp_path / "all.json"
    study = [*crowds, "--sensitivity", "--policy", paced, "--score-cache", tmp_path / "done.jsonl"]
    study += ["--policy-option=pace=1.2", "--policy-option=side=left"]
    study += ["--vary=pace=0.8,1.6", "--vary=side=left,right", "--json", target]
    assert run(*study) == exit_codes.OK
    points = json.loads(target.read_text())["points"]
    assert [(row["setting"], row["value"]) for row in points] == [
        ("pace", 0.8), ("pace", 1.2), ("pace", 1.6), ("side", "left"), ("side", "right"),
    ]  # fmt: skip
    times = [row["time_ratio"]["mean"] for row in points]
    assert times[0] > times[1] > times[2]
    assert times[1] == times[3] == times[4]


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (["--sensitivity"], "--sensitivity of Paced needs --vary"),
        (["--sensitivity", "--vary=pace=1"], "pace: say its value in the baseline by --policy-opt"),
        (
            ["--sensitivity", "--vary=pace=slow", "--policy-option=pace=1"],
            "pace is 1: its values are of several types",
        ),
        (
            ["--sensitivity", "--vary=side", "--policy-option=side=left"],
            "side is left: give its values as side=V1,V2,..",
        ),
        (["--tune", "--vary=pa-ce=1"], "--vary 'pa-ce' cannot be a keyword of a policy"),
        (["--tune", "--vary=pace=-1"], "it would walk backwards"),
        (["--tune", "--vary=tempo=1"], "unexpected keyword argument 'tempo'"),
        (["--tune", "--vary=pace=1", "--set=catch_up=0"], "--set is for our own actor"),
    ],
)
def test_wrong_studies_of_a_policy_of_ones_own(
    arguments: list[str],
    fault: str,
    crowds: list[Path],
    paced: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    study = [*crowds, "--policy", paced, "--score-cache", tmp_path / "done"]
    assert ended(*study, *arguments) == exit_codes.USAGE
    assert fault in capsys.readouterr().err
    assert not (tmp_path / "done").exists()


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (
            ["--tune", "--score-cache=done", "--vary=catch_up=1", "--policy", "straight", "discs"],
            "--policy: a study is of one policy",
        ),
        (
            ["--tune", "--score-cache=done", "--vary=catch_up=1", "--policy", "straight"],
            "--policy: straight has no settings that a study could vary",
        ),
        (["--sensitivity"], "keep its scores with --score-cache FILE"),
        (["--sensitivity", "--tune"], "not allowed with argument --sensitivity"),
        (
            ["--sensitivity", "--score-cache=done", "--vary=tempo"],
            "--vary: tempo: there is no such setting",
        ),
        (
            ["--sensitivity", "--score-cache", "/nowhere/done"],
            "--score-cache: there is no folder /nowhere",
        ),
        (["--tune", "--score-cache=done"], "--tune needs candidates"),
        (["--tune", "--score-cache=done", "--vary=foresight_s"], "--tune needs values"),
        (["--tune", "--score-cache=done", "--vary=foresight_s=2"], "--tune needs two places"),
        (["--tune", "--score-cache=done", "--candidates=none"], "none: cannot be read"),
        (
            ["--tune", "--score-cache=done", "--vary=foresight_s=2", "--place=town=plaza,station"],
            "--place: there is no recording station, but plaza",
        ),
        (["--place=town=plaza"], "--place is for --sensitivity and --tune"),
        (["--tune", "--place=plaza"], "'plaza' is not PLACE=NAME,NAME"),
        (["--vary=foresight_s=2"], "--vary is for --sensitivity and --tune"),
        (["--candidates=some.jsonl"], "--candidates is for --tune"),
    ],
)
def test_wrong_usage(
    arguments: list[str],
    fault: str,
    crowds: list[Path],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "some.jsonl").write_text("{}\n")
    assert ended(crowds[0], *arguments) == exit_codes.USAGE
    shown = capsys.readouterr()
    assert fault in shown.err
    assert shown.out == ""
    assert not (tmp_path / "done").exists()
