"""`esplanade gait`: writes what it says, and says what it cannot do."""

import json
import sys
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.commandline import exit_codes


def run(arguments: list[str]) -> object:
    """The exit code, whether the parser refuses or the command."""
    try:
        return main(["gait", *arguments])
    except SystemExit as end:
        return end.code


def test_help_teaches_every_command_and_option(capsys: pytest.CaptureFixture[str]):
    assert run(["--help"]) == exit_codes.OK
    shown = capsys.readouterr().out
    for word in ("render", "cycle", "plots", "--walk", "--seed", "--fps", "--no-film", "strip.png"):
        assert word in shown


def test_render_writes_strip_and_trail(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    folder = tmp_path / "new" / "pictures"
    assert run(["render", "--walk", "flat", "--no-film", "--out", str(folder)]) == exit_codes.OK
    assert sorted(path.name for path in folder.iterdir()) == ["flat-strip.png", "flat-trail.png"]
    assert capsys.readouterr().out.split() == [
        str(folder / "flat-strip.png"),
        str(folder / "flat-trail.png"),
    ]


def test_cycle_writes_json(tmp_path: Path):
    assert run(["cycle", "--out", str(tmp_path / "cycle.json")]) == exit_codes.OK
    assert len(json.loads((tmp_path / "cycle.json").read_text())["keys"]) == 8


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["dance"],
        ["render", "--walk", "moon"],
        ["render", "--fps", "33"],
        ["render", "--seed", "-1"],
        ["cycle"],
    ],
)
def test_wrong_usage_is_refused(arguments: list[str], capsys: pytest.CaptureFixture[str]):
    assert run(arguments) == exit_codes.USAGE
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("esplanade gait")
    assert "--help`" in line


@pytest.mark.parametrize("command", [["render", "--walk", "flat"], ["plots"]])
def test_folders_that_cannot_be_made_are_named(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    (tmp_path / "file").touch()
    assert run([*command, "--out", str(tmp_path / "file" / "in")]) == exit_codes.USAGE
    assert "--out" in capsys.readouterr().err


def test_cycles_that_cannot_be_written_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    assert run(["cycle", "--out", str(tmp_path)]) == exit_codes.USAGE
    assert "gait cycle: --out" in capsys.readouterr().err


def test_missing_libraries_are_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert run(["render", "--walk", "flat"]) == exit_codes.USAGE
    assert "pip install" in capsys.readouterr().err
