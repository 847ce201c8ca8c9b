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


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
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
    try:
        code: object = run(crowds[0], *arguments)
    except SystemExit as end:  # the parser of options raises this
        code = end.code
    assert code == exit_codes.USAGE
    shown = capsys.readouterr()
    assert fault in shown.err
    assert shown.out == ""
    assert not (tmp_path / "done").exists()
