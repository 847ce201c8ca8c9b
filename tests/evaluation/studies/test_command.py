"""`--sensitivity` and `--tune`: tables, JSON, a picture, and what wrong usage is told."""

import json
from importlib.util import find_spec
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.commandline import exit_codes
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
    ledger = tmp_path / "done.jsonl"
    study = [*crowds, "--sensitivity", "--vary=risk_weight=2,20", "--vary=risk.comfort=0.2"]
    study += ["--ledger", ledger, "--json", target, "--plots", folder]
    assert run(*study) == exit_codes.OK
    shown = capsys.readouterr().out
    assert "risk_weight" in shown
    assert shown.count("as is") == 3
    found = json.loads(target.read_text())
    assert found["settings"]["recordings"] == ["plaza", "market"]
    assert [row["setting"] for row in found["points"]] == ["risk_weight"] * 3 + ["risk.comfort"] * 2
    assert [path.name for path in folder.iterdir()] == ["sensitivity.svg"]
    walked = len(ledger.read_text().splitlines())
    assert walked == 2 * 4 * 2  # recordings, variants, episodes
    assert run(*study) == exit_codes.OK
    assert len(ledger.read_text().splitlines()) == walked
    assert capsys.readouterr().out == shown


def test_candidates_are_compared(
    tmp_path: Path, crowds: list[Path], capsys: pytest.CaptureFixture[str]
) -> None:
    listed, target = tmp_path / "candidates.jsonl", tmp_path / "all.json"
    listed.write_text('{"foresight_s": 2}\n')
    study = [*crowds, "--tune", "--vary", "risk_weight=2,20", "--candidates", listed]
    assert run(*study, "--ledger", tmp_path / "done.jsonl", "--json", target) == exit_codes.OK
    shown = capsys.readouterr().out
    assert "Chosen without one recording" in shown
    assert "Chosen on all recordings: " in shown
    found = json.loads(target.read_text())
    assert len(found["candidates"]) == 4
    assert [fold["left_out"] for fold in found["folds"]] == ["plaza", "market"]


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (["--sensitivity"], "say with --ledger FILE where to keep what is done"),
        (["--sensitivity", "--tune"], "not allowed with argument --sensitivity"),
        (
            ["--sensitivity", "--ledger=done", "--vary=tempo"],
            "--vary tempo: there is no such setting",
        ),
        (["--sensitivity", "--ledger", "/nowhere/done"], "--ledger: there is no folder /nowhere"),
        (["--tune", "--ledger=done"], "--tune needs candidates"),
        (["--tune", "--ledger=done", "--vary=foresight_s"], "--tune needs values"),
        (["--tune", "--ledger=done", "--vary=foresight_s=2"], "--tune needs two recordings"),
        (["--tune", "--ledger=done", "--candidates=none"], "none: cannot be read"),
        (["--vary=foresight_s=2"], "--vary is for --sensitivity and --tune"),
        (["--candidates=none"], "--candidates is for --tune"),
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
    try:
        code: object = run(crowds[0], *arguments)
    except SystemExit as end:  # how the parser of options refuses
        code = end.code
    assert code == exit_codes.USAGE
    shown = capsys.readouterr()
    assert fault in shown.err
    assert shown.out == ""
    assert not (tmp_path / "done").exists()
